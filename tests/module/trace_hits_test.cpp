// SPDX-License-Identifier: GPL-2.0-or-later
// The same rays by every trace backend, through the real module and its shaders: in our own map and in those of
// $VKPT_TEST_MAPS. Whatever differs must be a close call: an edge within 1e-4 (in barycentric weights), or a tie.
#include "client/host/client_map.hpp"
#include "formats/bsp.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

namespace vkpt::tests {
namespace {

namespace fs = std::filesystem;

constexpr float far_away = 1e6f;

size_t ray_count()
{
    const char* wanted = std::getenv("VKPT_TRACE_RAYS");
    return wanted ? size_t(std::atoll(wanted)) : 100'000;
}

// Between random places of the map, a tenth of them parallel to an axis; half of them end at the other place.
std::vector<TracedRay> random_rays(const formats::Bsp& bsp, size_t count)
{
    glm::vec3 mins(far_away), maxs(-far_away);
    for (size_t face = 0; face < size_t(bsp.models[0].face_count); face++)
        for (const glm::vec3& p : bsp.face_polygon(size_t(bsp.models[0].first_face) + face)) {
            mins = glm::min(mins, p);
            maxs = glm::max(maxs, p);
        }
    std::mt19937 random(7);
    const auto place = [&] {
        glm::vec3 p;
        for (int axis = 0; axis < 3; axis++)
            p[axis] = std::uniform_real_distribution<float>(mins[axis], maxs[axis])(random);
        return p;
    };
    std::vector<TracedRay> rays;
    for (size_t i = 0; i < count; i++) {
        const glm::vec3 from = place(), to = place();
        const float length = glm::length(to - from);
        glm::vec3 direction = (to - from) / length;
        if (i % 10 == 0) {
            direction = glm::vec3(0);
            direction[int(i / 10 % 3)] = i / 30 % 2 ? 1.0f : -1.0f;
        }
        rays.push_back(
            { { from.x, from.y, from.z }, 0, { direction.x, direction.y, direction.z }, i % 2 ? length : far_away });
    }
    return rays;
}

std::vector<TracedHit> trace(Session& session, const std::vector<TracedRay>& rays, const char* backend, bool visibility)
{
    session.set("pt_trace", backend);
    session.host().draw_frame(session.view); // reads the cvar
    TraceRequest request;
    request.visibility = visibility;
    std::vector<TracedHit> hits(rays.size());
    EXPECT_STREQ(session.extension().info().trace_backend, backend);
    EXPECT_GE(session.extension().trace_rays(rays.data(), rays.size(), &request, hits.data()), 0);
    return hits;
}

// A distance's rounding: some units in the last place of the coordinates, which grows where the ray is nearly parallel
// to the plane; that angle is not known here, so this is for rays that meet a plane at more than about a degree.
float rounding(const TracedRay& ray, float t)
{
    const float size = std::max({ 1.0f, std::abs(ray.origin[0]), std::abs(ray.origin[1]), std::abs(ray.origin[2]), t });
    return 2e-5f * size;
}

bool is_at_an_edge(const TracedHit& hit)
{
    const float least
        = std::min({ hit.barycentrics[0], hit.barycentrics[1], 1 - hit.barycentrics[0] - hit.barycentrics[1] });
    return hit.triangle != shared::TRACE_MISS && std::abs(least) < 1e-4f;
}

bool is_at_a_limit(const TracedRay& ray, const TracedHit& hit)
{
    return hit.triangle != shared::TRACE_MISS
        && (hit.t < rounding(ray, hit.t) || ray.t_max - hit.t < rounding(ray, hit.t));
}

bool is_tie(const TracedRay& ray, const TracedHit& a, const TracedHit& b)
{
    return a.triangle != shared::TRACE_MISS && b.triangle != shared::TRACE_MISS
        && std::abs(a.t - b.t) < rounding(ray, a.t);
}

bool is_explained(const TracedRay& ray, const TracedHit& a, const TracedHit& b)
{
    return is_tie(ray, a, b) || is_at_an_edge(a) || is_at_an_edge(b) || is_at_a_limit(ray, a) || is_at_a_limit(ray, b);
}

// `ours` by the software backend.
void expect_same_hits(
    const std::vector<TracedRay>& rays, const std::vector<TracedHit>& ours, const std::vector<TracedHit>& theirs)
{
    size_t same = 0, ties = 0, unexplained = 0, met = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        met += ours[i].triangle != shared::TRACE_MISS;
        if (ours[i].triangle == theirs[i].triangle) {
            same++;
            if (ours[i].triangle == shared::TRACE_MISS)
                continue;
            ASSERT_NEAR(ours[i].t, theirs[i].t, 10 * rounding(rays[i], ours[i].t)) << "ray " << i;
            ASSERT_EQ(ours[i].front, theirs[i].front) << "ray " << i;
            ASSERT_NEAR(ours[i].barycentrics[0], theirs[i].barycentrics[0], 0.02f) << "ray " << i;
            ASSERT_NEAR(ours[i].barycentrics[1], theirs[i].barycentrics[1], 0.02f) << "ray " << i;
            continue;
        }
        // Two triangles in one place: maps have faces twice.
        ties += is_tie(rays[i], ours[i], theirs[i]);
        if (!is_explained(rays[i], ours[i], theirs[i]) && ++unexplained < 10)
            ADD_FAILURE() << "ray " << i << ": software met " << int64_t(ours[i].triangle) << " at " << ours[i].t
                          << ", the device " << int64_t(theirs[i].triangle) << " at " << theirs[i].t;
    }
    EXPECT_EQ(unexplained, 0u);
    EXPECT_GE(double(same + ties), 0.9999 * double(rays.size()));
    EXPECT_GT(met, rays.size() / 10) << "too few rays meet anything for this to mean much";
    std::printf("    %zu rays, %zu meet something, %zu differ, %zu of these are ties\n", rays.size(), met,
        rays.size() - same, ties);
}

// What was met is known from the nearest hits by the same backends.
void expect_same_visibility(const std::vector<TracedRay>& rays, const std::vector<TracedHit>& ours,
    const std::vector<TracedHit>& theirs, const std::vector<TracedHit>& our_nearest,
    const std::vector<TracedHit>& their_nearest)
{
    size_t differ = 0, unexplained = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        EXPECT_EQ(ours[i].triangle == shared::TRACE_MISS, our_nearest[i].triangle == shared::TRACE_MISS)
            << "software, ray " << i;
        EXPECT_EQ(theirs[i].triangle == shared::TRACE_MISS, their_nearest[i].triangle == shared::TRACE_MISS)
            << "the device, ray " << i;
        if ((ours[i].triangle == shared::TRACE_MISS) == (theirs[i].triangle == shared::TRACE_MISS))
            continue;
        differ++;
        unexplained += !is_explained(rays[i], our_nearest[i], their_nearest[i]);
    }
    EXPECT_EQ(unexplained, 0u);
    EXPECT_LE(double(differ), 0.0001 * double(rays.size()));
}

void compare_backends(Session& session, const std::string& map)
{
    SCOPED_TRACE(map);
    client::ClientMap scene(session.files(), client::parse_scene_name(map));
    scene.register_with(session.host());
    session.view = scene.view(session.view.width, session.view.height, 0); // its brush models move
    const auto bytes = session.files().read(map);
    ASSERT_TRUE(bytes);
    const std::vector<TracedRay> rays = random_rays(formats::read_bsp(*bytes, map), ray_count());
    const std::vector<TracedHit> nearest = trace(session, rays, "software", false);
    const std::vector<TracedHit> visible = trace(session, rays, "software", true);
    const auto offered = session.extension().info().trace_backends;
    std::vector<std::string> others;
    for (auto name = offered; *name; name++)
        if (std::string(*name) != "software")
            others.emplace_back(*name);
    for (const std::string& backend : others) {
        SCOPED_TRACE(backend);
        const std::vector<TracedHit> their_nearest = trace(session, rays, backend.c_str(), false);
        expect_same_hits(rays, nearest, their_nearest);
        expect_same_visibility(rays, visible, trace(session, rays, backend.c_str(), true), nearest, their_nearest);
    }
}

TEST(TraceHits, OurLevel)
{
    if (!fs::exists(fs::path(VKPT_GAME_FOLDER) / "baseq2/maps/vkpt1.bsp"))
        FAIL() << "the build has made no game data: build the target game_data";
    Session session(fs::path(VKPT_GAME_FOLDER), {}, { 8, 8 });
    compare_backends(session, "maps/vkpt1.bsp");
}

TEST(TraceHits, RealMaps)
{
    const char* folder = std::getenv("VKPT_TEST_MAPS");
    if (!folder || !*folder)
        GTEST_SKIP() << "VKPT_TEST_MAPS names no folder with maps";
    std::vector<fs::path> maps;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".bsp")
            maps.push_back(entry.path());
    std::ranges::sort(maps);
    ASSERT_FALSE(maps.empty()) << "no .bsp in " << folder;
    const GameFolder game;
    Session session(game, {}, { 8, 8 });
    for (const fs::path& map : maps) {
        const std::string name = "maps/" + map.filename().string();
        session.files().add_file(name, map);
        compare_backends(session, name);
    }
}

} // namespace
} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// Each trace backend that the device offers: what its rays meet, the pictures it makes, and the change between them.
#include "shaders/shared/scene.h"
#include "shaders/shared/trace.h"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"
#include "tests/module/test_cache.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <iterator>

namespace vkpt::tests {
namespace {

using namespace shared;

constexpr float cube_half = 8;

std::vector<std::string> offered_backends(Session& session)
{
    std::vector<std::string> names;
    for (auto name = session.extension().info().trace_backends; *name; name++)
        names.emplace_back(*name);
    return names;
}

class TraceBackends : public testing::Test {
protected:
    TraceBackends()
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("glass", 100);
        folder_.add_wall("lamp", white_index);
        folder_.add_fence("fence", 120);
        cube_path_ = folder_.add_cube("cube", cube_half, red_index);
    }

    void start(MapBuilder& map, const CvarList& cvars = {})
    {
        folder_.add_map("room", map.finish());
        CvarList all { { "r_gunfov", "0" } };
        all.insert(all.end(), cvars.begin(), cvars.end());
        session_ = std::make_unique<Session>(folder_, all);
        session_->load_map("room");
        cube_ = session_->module().register_model(cube_path_.c_str());
        ASSERT_TRUE(cube_);
    }

    void show(const std::vector<engine::Entity>& entities)
    {
        entities_ = entities;
        session_->view.entities = entities_.data();
        session_->view.entity_count = int32_t(entities_.size());
    }

    void choose(const std::string& backend)
    {
        session_->set("pt_trace", backend);
        session_->draw();
        ASSERT_EQ(session_->extension().info().trace_backend, backend);
    }

    TracedHit trace(glm::vec3 from, glm::vec3 to, uint32_t mask, bool visibility = false)
    {
        const float length = glm::length(to - from);
        return trace_ray(from, (to - from) / length, 0, length, mask, visibility);
    }
    TracedHit trace_ray(glm::vec3 from, glm::vec3 way, float t_min, float t_max, uint32_t mask, bool visibility = false)
    {
        const TracedRay ray { { from.x, from.y, from.z }, t_min, { way.x, way.y, way.z }, t_max };
        TraceRequest request;
        request.ray_mask = mask;
        request.visibility = visibility;
        TracedHit hit {};
        EXPECT_GE(session_->extension().trace_rays(&ray, 1, &request, &hit), 0);
        return hit;
    }
    bool meets(glm::vec3 from, glm::vec3 to, uint32_t mask)
    {
        const bool nearest = trace(from, to, mask).triangle != shared::TRACE_MISS;
        EXPECT_EQ(trace(from, to, mask, true).triangle != shared::TRACE_MISS, nearest);
        return nearest;
    }

    // Runs with each backend in turn.
    template <class Check> void with_each(const Check& check)
    {
        const std::vector<std::string> backends = offered_backends(*session_);
        EXPECT_EQ(backends.front(), "software");
        for (const std::string& backend : backends) {
            SCOPED_TRACE(backend);
            choose(backend);
            check();
        }
    }

    GameFolder folder_;
    std::string cube_path_;
    std::unique_ptr<Session> session_;
    std::vector<engine::Entity> entities_;
    void* cube_ = nullptr;
};

TEST_F(TraceBackends, MeetOnlyWhatTheMaskAllows)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("wall"));
    map.add(rectangle({ 200, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("glass", formats::SURF_TRANS33));
    map.add(rectangle({ 400, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("wall", formats::SURF_SKY));
    start(map);
    show({ make_entity(cube_, { 600, 0, 0 }), make_entity(cube_, { 700, 0, 0 }, engine::RF_WEAPONMODEL),
        make_entity(cube_, { 800, 0, 0 }, engine::RF_VIEWERMODEL),
        make_entity(cube_, { 900, 0, 0 }, engine::RF_TRANSLUCENT) });
    const struct {
        float x;
        uint32_t mask;
    } things[] = { { 0, MASK_OPAQUE }, { 200, MASK_TRANSLUCENT | MASK_FILTER }, { 400, MASK_SKY }, { 600, MASK_OPAQUE },
        { 700, MASK_VIEW_WEAPON }, { 800, MASK_OWN_BODY }, { 900, MASK_TRANSLUCENT } };
    with_each([&] {
        for (const auto& thing : things)
            for (uint32_t bit = 0; bit < 8; bit++)
                EXPECT_EQ(
                    meets({ thing.x + 1, 2, 50 }, { thing.x + 1, 2, -50 }, 1u << bit), (thing.mask & (1u << bit)) != 0)
                    << "the thing at " << thing.x << ", mask " << (1u << bit);
        EXPECT_TRUE(meets({ 1, 2, 50 }, { 1, 2, -50 }, MASK_ALL));
        EXPECT_FALSE(meets({ 1, 2, 50 }, { 1, 2, -50 }, MASK_ALL & ~MASK_OPAQUE));
        EXPECT_FALSE(meets({ 1, 2, 50 }, { 1, 2, -50 }, 0));
    });
}

TEST_F(TraceBackends, MeetBothSidesAndTellThem)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("wall")); // faces up
    start(map);
    show({ make_entity(cube_, { 0, 200, 0 }) });
    with_each([&] {
        const TracedHit above = trace({ 10, 20, 50 }, { 10, 20, -50 }, MASK_ALL);
        const TracedHit below = trace({ 10, 20, -50 }, { 10, 20, 50 }, MASK_ALL);
        EXPECT_EQ(above.front, 1u);
        EXPECT_EQ(below.front, 0u);
        EXPECT_EQ(above.triangle, below.triangle);
        EXPECT_LT(above.triangle, 2u);
        EXPECT_FLOAT_EQ(above.t, 50);
        EXPECT_FLOAT_EQ(below.t, 50);
        EXPECT_EQ(trace({ 1, 202, 50 }, { 1, 202, -50 }, MASK_ALL).front, 1u);
        EXPECT_EQ(trace({ 1, 202, 0 }, { 1, 202, 50 }, MASK_ALL).front, 0u) << "from within the cube";
        EXPECT_GE(trace({ 1, 202, 50 }, { 1, 202, -50 }, MASK_ALL).triangle, 2u)
            << "ids of what moves follow the map's";
    });
}

// The triangles' weights, in the order of their corners.
TEST_F(TraceBackends, TellWhereTheTriangleWasMet)
{
    MapBuilder map;
    map.add({ { 0, 0, 0 }, { 100, 0, 0 }, { 0, 100, 0 } }, map.add_material("wall"));
    start(map);
    with_each([&] {
        for (const glm::vec2 p : { glm::vec2(10, 20), glm::vec2(70, 10), glm::vec2(5, 90) }) {
            const TracedHit hit = trace({ p.x, p.y, 30 }, { p.x, p.y, -30 }, MASK_ALL);
            ASSERT_EQ(hit.triangle, 0u);
            // Whatever corner the module's triangle starts with, its two weights are two of these three.
            const float weights[3] = { 1 - (p.x + p.y) / 100, p.x / 100, p.y / 100 };
            bool found = false;
            for (int first = 0; first < 3; first++)
                found |= std::abs(hit.barycentrics[0] - weights[(first + 1) % 3]) < 1e-5f
                    && std::abs(hit.barycentrics[1] - weights[(first + 2) % 3]) < 1e-5f;
            EXPECT_TRUE(found) << hit.barycentrics[0] << ", " << hit.barycentrics[1];
        }
    });
}

TEST_F(TraceBackends, KeepToTheDistances)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("wall"));
    start(map);
    const glm::vec3 down(0, 0, -1), from(3, 5, 8);
    const struct {
        float t_min, t_max;
        bool meets;
    } cases[] = { { 0, 7.999f, false }, { 0, 8.001f, true }, { 7.999f, 100, true }, { 8.001f, 100, false },
        { 0, 1e6f, true }, { 0, 1e30f, true }, { 9, 8, false }, { 5, 3, false } };
    with_each([&] {
        for (const auto& c : cases)
            for (const bool visibility : { false, true }) {
                const TracedHit hit = trace_ray(from, down, c.t_min, c.t_max, MASK_ALL, visibility);
                EXPECT_EQ(hit.triangle != shared::TRACE_MISS, c.meets) << c.t_min << " to " << c.t_max;
                if (hit.triangle == shared::TRACE_MISS) {
                    EXPECT_EQ(hit.t, c.t_max);
                }
            }
        // Away from what it starts on, as all our secondary rays do.
        EXPECT_EQ(trace_ray({ 3, 5, 0.02f }, -down, 0, 100, MASK_ALL).triangle, shared::TRACE_MISS);
        EXPECT_NE(trace_ray({ 3, 5, 0.02f }, down, 0, 100, MASK_ALL).triangle, shared::TRACE_MISS);
    });
}

// Columns of 8 units, by turns there and not, see GameFolder::add_fence.
TEST_F(TraceBackends, PassThroughHoles)
{
    MapBuilder map;
    const uint16_t fence = map.add_material("fence", formats::SURF_ALPHATEST);
    for (int layer = 0; layer < 20; layer++) // each holes in a row
        map.add(rectangle({ 0, 0, float(layer) * 0.01f }, { 64, 0, 0 }, { 0, 64, 0 }), fence);
    map.add(rectangle({ 0, 0, -20 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("wall"));
    map.add(rectangle({ 208, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }),
        map.add_material("fence", formats::SURF_ALPHATEST | formats::SURF_TRANS66));
    map.begin_brush_model();
    map.add(rectangle({ 400, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), fence);
    start(map);
    show({ make_entity(session_->module().register_model("*1"), { 0, 0, 0 }) });
    with_each([&] {
        for (const float base : { 0.0f, 208.0f, 400.0f }) // world, translucent world, brush model
            for (const float column : { -32.0f, 0.0f, 16.0f }) {
                const auto at = [&](float x, float z) { return glm::vec3(base + column + x, 1, z); };
                EXPECT_TRUE(meets(at(4, 30), at(4, -10), MASK_ALL)) << base << " " << column;
                EXPECT_FALSE(meets(at(12, 30), at(12, -10), MASK_ALL)) << base << " " << column;
                EXPECT_TRUE(meets(at(4, -10), at(4, 30), MASK_ALL)) << "from behind";
                EXPECT_FALSE(meets(at(12, -10), at(12, 30), MASK_ALL)) << "from behind";
            }
        // Behind the holes stands the wall.
        EXPECT_TRUE(meets({ 12, 1, 30 }, { 12, 1, -30 }, MASK_ALL));
        EXPECT_FLOAT_EQ(trace({ 12, 1, 30 }, { 12, 1, -30 }, MASK_ALL).t, 50);
        EXPECT_NEAR(trace({ 4, 1, 30 }, { 4, 1, -30 }, MASK_ALL).t, 29.81f, 1e-3f) << "the highest layer";
    });
}

// With one seed they draw the same rays: what differs is rounding, and pixels where an edge decides.
TEST_F(TraceBackends, MakeTheSamePictureWhenChangedLive)
{
    MapBuilder map;
    map.add_room({ -128, -128, 0 }, { 128, 128, 160 }, map.add_material("wall"));
    map.add(rectangle({ 0, 0, 159 }, { 0, 32, 0 }, { 32, 0, 0 }), map.add_material("lamp", 0, 2000));
    map.add(rectangle({ 40, 40, 40 }, { 0, 30, 0 }, { 0, 0, 30 }), map.add_material("fence", formats::SURF_ALPHATEST));
    start(map, { { "pt_bounces", "2" } });
    show({ make_entity(cube_, { 20, -20, 20 }), make_entity(cube_, { 60, 0, 60 }, engine::RF_TRANSLUCENT) });
    session_->look({ -100, -100, 80 }, { 0, 0, 50 });
    choose("software");
    const Radiance expected = session_->capture();
    ASSERT_GT(luminance(expected.mean()), 0.01f);
    for (int round = 0; round < 2; round++)
        with_each([&] {
            session_->draw(3); // both frames in flight, and one again
            const Radiance picture = session_->capture();
            EXPECT_EQ(count_broken(picture), 0u);
            size_t differ = 0;
            for (size_t i = 0; i < picture.pixels.size(); i++)
                differ += glm::length(picture.pixels[i] - expected.pixels[i])
                    > 1e-2f * glm::length(expected.pixels[i]) + 1e-4f;
            EXPECT_LT(differ, picture.pixels.size() / 50);
            EXPECT_NEAR(luminance(picture.mean()), luminance(expected.mean()), 0.02f * luminance(expected.mean()));
        });
}

TEST_F(TraceBackends, FollowWhatMovesAndTheNextMap)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("wall"));
    MapBuilder other;
    other.add(rectangle({ 0, 0, 300 }, { 64, 0, 0 }, { 0, 64, 0 }), other.add_material("wall"));
    folder_.add_map("other", other.finish());
    start(map);
    with_each([&] {
        for (int frame = 0; frame < 5; frame++) { // each time more cubes than before: the structures have to grow
            std::vector<engine::Entity> cubes;
            for (int i = 0; i < 1 << (2 * frame); i++)
                cubes.push_back(make_entity(cube_, { 100 + 20 * i, 0, 20 * frame }));
            show(cubes);
            session_->draw();
            EXPECT_TRUE(meets({ 101, 2, 20 * frame + 9 }, { 101, 2, 20 * frame - 9 }, MASK_OPAQUE)) << frame;
            EXPECT_FALSE(meets({ 101, 2, 20 * frame + 19 }, { 101, 2, 20 * frame + 9 }, MASK_OPAQUE)) << frame;
        }
        show({});
        session_->draw();
        EXPECT_FALSE(meets({ 101, 2, 200 }, { 101, 2, -200 }, MASK_ALL)) << "they are gone";
        session_->load_map("other");
        session_->draw();
        EXPECT_TRUE(meets({ 1, 2, 310 }, { 1, 2, 290 }, MASK_ALL));
        EXPECT_FALSE(meets({ 1, 2, 10 }, { 1, 2, -10 }, MASK_ALL));
        session_->load_map("room");
        cube_ = session_->module().register_model(cube_path_.c_str());
        session_->draw();
        EXPECT_TRUE(meets({ 1, 2, 10 }, { 1, 2, -10 }, MASK_ALL));
    });
}

// A lane's for eight pixels, for which the device's own ray tracing has no use.
TEST_F(TraceBackends, OnlyTheSoftwareHasStacks)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("wall"));
    Session::end_idle(); // a module that has traced by software has them
    start(map, { { "pt_trace", "query" } });
    if (offered_backends(*session_).size() == 1)
        GTEST_SKIP() << "the device traces no rays of its own";
    session_->draw();
    const uint64_t without = session_->extension().info().image_bytes;
    choose("software");
    const uint64_t with = session_->extension().info().image_bytes;
    EXPECT_GE(with, without + 64 * 48 / 8 * uint64_t(TRACE_STACK_BYTES_PER_LANE));
    EXPECT_TRUE(meets({ 1, 2, 10 }, { 1, 2, -10 }, MASK_ALL));
}

// A menu shows a model and no map; here not even a model.
TEST_F(TraceBackends, ShowNothingAtAll)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("wall"));
    start(map);
    with_each([&] {
        engine::RefDef preview = session_->view;
        preview.flags = engine::RDF_NOWORLDMODEL;
        preview.lightstyles = nullptr;
        preview.entities = nullptr;
        preview.entity_count = 0;
        session_->host().draw_frame(preview);
        session_->host().draw_frame(session_->view);
        EXPECT_EQ(count_broken(session_->capture()), 0u);
    });
}

TEST_F(TraceBackends, DeviceWithoutRayTracingRuns)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("wall"));
    start(map, { { "pt_device_rays", "0" }, { "pt_trace", "query" } });
    session_->draw(2);
    EXPECT_EQ(offered_backends(*session_), std::vector<std::string> { "software" });
    EXPECT_STREQ(session_->extension().info().trace_backend, "software");
    EXPECT_TRUE(meets({ 1, 2, 10 }, { 1, 2, -10 }, MASK_ALL));
    const auto said = [&] {
        return std::ranges::count_if(session_->lines(),
            [](const std::string& line) { return line.find("does not support pt_trace") != std::string::npos; });
    };
    EXPECT_EQ(said(), 1);
    session_->set("pt_trace", "pipeline");
    session_->draw(3);
    EXPECT_EQ(said(), 2);
}

TEST_F(TraceBackends, AreMeasuredOnceAndRemembered)
{
    const OwnCache cache("measured");
    const std::filesystem::path file = cache.path() / "trace_backends.txt";
    std::filesystem::remove(file);
    const auto read = [&] {
        std::ifstream stream(file);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    MapBuilder map;
    map.add_room({ -128, -128, 0 }, { 128, 128, 160 }, map.add_material("wall"));
    start(map);
    const size_t offered = offered_backends(*session_).size();
    session_->host().run_text("pt_trace_measure\n");
    EXPECT_TRUE(session_->has_line("start one first"));
    session_->draw();
    session_->host().run_text("pt_trace_measure\n");
    EXPECT_TRUE(session_->has_line("measured now"));
    session_->draw();
    const std::string chosen = session_->extension().info().trace_backend;
    EXPECT_NE(read().find("\t" + chosen + "\t"), std::string::npos);
    session_ = nullptr;
    Session::end_idle();
    start(map);
    session_->draw();
    EXPECT_EQ(session_->has_line("measured on this device"), offered > 1);
    EXPECT_EQ(session_->extension().info().trace_backend, chosen);
    session_ = nullptr;
    // A file that was damaged, or written by a later version, is done without.
    const std::string damaged = "nonsense\n\t\t\n" + read().substr(0, 20);
    std::ofstream(file) << damaged;
    Session::end_idle();
    start(map);
    session_->draw();
    EXPECT_FALSE(session_->has_line("measured on this device"));
}

} // namespace
} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// Light lists of maps that nobody of this project made: set VKPT_TEST_MAPS to a folder of BSP files. What samplers are
// worth is tested in our own map in any case.
#include "common/quantile.hpp"
#include "glsl_libraries.hpp"
#include "map_emitters.hpp"
#include "ref_vkpt/lights/emitters.hpp"
#include "ref_vkpt/lights/light_lists.hpp"
#include "ref_vkpt/lights/light_multisets.hpp"
#include "ref_vkpt/lights/light_trees.hpp"
#include "ref_vkpt/lights/spot_cone.hpp"
#include "sampler_case.hpp"
#include "synthetic_bsp.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <random>

namespace vkpt::test {
namespace {

using shared::Emitter;

std::vector<std::filesystem::path> find_maps()
{
    std::vector<std::filesystem::path> maps;
    if (const char* folder = std::getenv("VKPT_TEST_MAPS"))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ".bsp")
                maps.push_back(entry.path());
    std::sort(maps.begin(), maps.end());
    return maps;
}

formats::Bsp load_map(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes { std::istreambuf_iterator<char>(file), {} };
    return formats::read_bsp(std::as_bytes(std::span(bytes)), path.filename().string());
}

double measure_milliseconds(auto work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

struct SurfacePoints {
    std::vector<std::array<glm::vec3, 3>> triangles;
    std::vector<glm::vec3> normals;

    explicit SurfacePoints(const formats::Bsp& bsp)
    {
        for (int32_t i = 0; i < bsp.models[0].face_count; i++) {
            const size_t face = size_t(bsp.models[0].first_face + i);
            const std::vector<glm::vec3> outline = bsp.face_polygon(face);
            for (const auto& t : triangulate(outline, bsp.face_normal(face))) {
                triangles.push_back({ outline[t[0]], outline[t[1]], outline[t[2]] });
                normals.push_back(bsp.face_normal(face));
            }
        }
    }
};

glm::vec3 point_in_triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, std::mt19937& rng)
{
    std::uniform_real_distribution<float> unit(0, 1);
    const float root = std::sqrt(unit(rng)), v = unit(rng);
    return a * (1 - root) + b * (root * (1 - v)) + c * (root * v);
}

glm::vec3 point_on_emitter(const Emitter& e, std::mt19937& rng)
{
    if (e.type != shared::EMITTER_SPHERE) {
        const glm::vec3 normal = glm::normalize(glm::cross(e.p1 - e.p0, e.p2 - e.p0));
        return point_in_triangle(e.p0, e.p1, e.p2, rng) + 0.25f * normal;
    }
    std::normal_distribution<float> gauss;
    return e.p0 + 0.9f * e.p1.x * glm::normalize(glm::vec3(gauss(rng), gauss(rng), gauss(rng)));
}

struct SightCount {
    size_t seen = 0, missed = 0;
};

// Pairs (surface point, emitter point) with a clear line between them, and how many of those emitters are not listed.
SightCount count_missed(
    const formats::Bsp& bsp, const std::vector<Emitter>& emitters, const LightLists& lists, size_t pairs)
{
    const SurfacePoints surface(bsp);
    std::mt19937 rng(1);
    SightCount count;
    for (size_t i = 0; i < pairs; i++) {
        const size_t triangle = rng() % surface.triangles.size();
        const auto& t = surface.triangles[triangle];
        const glm::vec3 from = point_in_triangle(t[0], t[1], t[2], rng) + 0.25f * surface.normals[triangle];
        const int cluster = bsp.find_cluster(from);
        const size_t emitter = rng() % emitters.size();
        const Emitter& e = emitters[emitter];
        const bool is_behind
            = e.type != shared::EMITTER_SPHERE && !(glm::dot(glm::cross(e.p1 - e.p0, e.p2 - e.p0), from - e.p0) > 0);
        const bool is_beside
            = has_cone(e) && glm::dot(glm::normalize(from - e.p0), e.p2) <= outer_cosine(e); // of what a spot lights
        if (cluster < 0 || is_behind || is_beside || !is_line_clear(bsp, from, point_on_emitter(e, rng)))
            continue;
        count.seen++;
        const shared::LightList& list = lists.lists()[size_t(cluster)];
        const auto first = lists.static_indices().begin() + list.first_static;
        count.missed += !std::binary_search(first, first + list.static_count, uint32_t(emitter));
    }
    return count;
}

TEST(RealMaps, EmittersInSightAreListed)
{
    if (find_maps().empty())
        GTEST_SKIP() << "VKPT_TEST_MAPS names no folder with maps";
    for (const std::filesystem::path& path : find_maps()) {
        const formats::Bsp bsp = load_map(path);
        const StaticEmitters emitters = extract_emitters(bsp, {});
        LightLists lists;
        lists.build(bsp, emitters.emitters);
        const SightCount count = count_missed(bsp, emitters.emitters, lists, 1'000'000);
        fmt::print("{}: {} emitters, {} clusters, {} list entries, {} unlisted; {} pairs in sight, {} missed\n",
            bsp.name, emitters.emitters.size(), bsp.cluster_count, lists.static_indices().size(),
            lists.unlisted_static_count(), count.seen, count.missed);
        for (const std::string& message : emitters.messages)
            fmt::print("  {}\n", message);
        EXPECT_GT(count.seen, 1000u);
        EXPECT_EQ(count.missed, 0u) << bsp.name;
    }
}

TEST(RealMaps, ShadersFindTheSameCluster)
{
    if (find_maps().empty())
        GTEST_SKIP() << "VKPT_TEST_MAPS names no folder with maps";
    std::mt19937 rng(2);
    std::uniform_real_distribution<float> unit(0, 1);
    for (const std::filesystem::path& path : find_maps()) {
        const formats::Bsp bsp = load_map(path);
        LightLists lists;
        lists.build(bsp, {});
        const glm::vec3 mins = bsp.models[0].mins, size = bsp.models[0].maxs - mins;
        for (int i = 0; i < 100000; i++) {
            const glm::vec3 p = mins + size * glm::vec3(unit(rng), unit(rng), unit(rng));
            ASSERT_EQ(glsl::find_cluster({ lists.tree().data() }, p), bsp.find_cluster(p)) << bsp.name;
        }
    }
}

TEST(RealMaps, ListsAreMadeFast)
{
    if (find_maps().empty())
        GTEST_SKIP() << "VKPT_TEST_MAPS names no folder with maps";
    std::mt19937 rng(3);
    for (const std::filesystem::path& path : find_maps()) {
        const formats::Bsp bsp = load_map(path);
        MapFaces faces(bsp);
        const StaticEmitters emitters = extract_emitters(faces.source(), faces.triangles);
        LightLists lists;
        const double build = measure_milliseconds([&] { lists.build(bsp, emitters.emitters); });
        LightMultisets multisets;
        const double build_multisets = measure_milliseconds(
            [&] { multisets = make_light_multisets(bsp, faces.triangles, lists, emitters.emitters); });
        LightTrees trees;
        const double build_trees = measure_milliseconds(
            [&] { trees = make_light_trees(lists.lists(), lists.static_indices(), emitters.emitters); });
        const SurfacePoints surface(bsp);
        std::vector<Emitter> dynamic;
        for (int i = 0; i < 32; i++) {
            const size_t at = rng() % surface.triangles.size();
            dynamic.push_back(
                make_dynamic_light(surface.triangles[at][0] + 8.0f * surface.normals[at], glm::vec3(1), 300));
        }
        double update = 1e9;
        for (int i = 0; i < 20; i++)
            update = std::min(update, measure_milliseconds([&] { lists.update(dynamic); }));
        fmt::print("{}: build {:.1f} ms, multisets {:.1f} ms, {} tree nodes {:.1f} ms, update with 32 dynamic lights "
                   "{:.3f} ms, {} "
                   "entries of {}\n",
            bsp.name, build, build_multisets, trees.nodes.size(), build_trees, update, lists.dynamic_indices().size(),
            lists.static_indices().size());
        EXPECT_LT(build + build_multisets + build_trees, 2000); // four times the aim: the machine may be busy
        EXPECT_GE(multisets.entries.size(), 2 * lists.static_indices().size() - emitters.emitters.size());
        EXPECT_LT(update, 2);
    }
}

// A map's lists, multisets and trees as the shaders have them.
struct LitMap {
    explicit LitMap(const formats::Bsp& bsp_)
        : bsp(bsp_)
    {
        MapFaces cut(bsp);
        scene.emitters = extract_emitters(cut.source(), cut.triangles).emitters;
        const FaceTriangles& faces = cut.triangles;
        lists.build(bsp, scene.emitters);
        tables = make_sampler_tables(
            { lists.lists(), lists.static_indices(), scene.emitters, &bsp, &lists, &faces }, shared::SAMPLER_NEEDS);
        scene.static_indices = tables.indices;
        scene.tables = tables;
    }

    // Whether a surface at `p` can be lit at all.
    bool move_to(glm::vec3 p, glm::vec3 normal)
    {
        const int cluster = bsp.find_cluster(p);
        if (cluster < 0 || lists.lists()[size_t(cluster)].static_count == 0)
            return false;
        scene.range = lists.lists()[size_t(cluster)];
        scene.tables.multisets = { tables.multisets[size_t(cluster)] }; // the list's own
        scene.tables.tree_roots = { tables.tree_roots[size_t(cluster)] };
        scene.point.position = p;
        scene.point.normal = scene.point.view = normal;
        scene.point.roughness = 0.9f;
        return true;
    }

    const formats::Bsp& bsp;
    LightLists lists;
    SamplerTables tables; // of all lists
    ListCase scene;
};

// Relative mean square error of one unshadowed sample at points all over the map: the median of the points, as a few
// have lights right beside them.
TEST(RealMaps, TreesAreBetterThanSubsetsInMostMaps)
{
    std::vector<double> ratios;
    constexpr int points = 150, draws = 200;
    std::vector<std::filesystem::path> maps = find_maps();
    maps.emplace_back(VKPT_OUR_MAP);
    for (const std::filesystem::path& path : maps) {
        const formats::Bsp bsp = load_map(path);
        LitMap map(bsp);
        const SurfacePoints surface(bsp);
        std::mt19937 rng(5);
        std::map<std::string, std::vector<double>> errors;
        for (int tries = 0; tries < 10 * points && errors["full"].size() < points; tries++) {
            const size_t at = rng() % surface.triangles.size();
            const auto& t = surface.triangles[at];
            if (!map.move_to(
                    point_in_triangle(t[0], t[1], t[2], rng) + 0.1f * surface.normals[at], surface.normals[at]))
                continue;
            const double truth = all_samplers().front().integrate(map.scene, 1);
            if (!(truth > 0))
                continue;
            for (const Sampler& sampler : all_samplers()) {
                if (sampler.has(shared::SAMPLER_MIS) || sampler.has(shared::SAMPLER_BIASED))
                    continue;
                double sum = 0, squares = 0;
                for (int i = 0; i < draws; i++) {
                    const double light = sampler.sample_lights(map.scene, make_draw(rng), {});
                    sum += light / draws;
                    squares += light * light / draws;
                }
                errors[sampler.name].push_back(squares / (sum * sum) - 1);
            }
        }
        std::string line;
        std::map<std::string, double> median;
        for (const auto& [name, values] : errors) {
            median[name] = find_median(values);
            line += fmt::format(" {} {:.3f}", name, median[name]);
        }
        fmt::print("{}: {:.0f} lights a list,{}\n", bsp.name,
            double(map.lists.static_indices().size()) / double(map.lists.lists().size()), line);
        ratios.push_back(median["light_tree"] / median["subset"]);
        EXPECT_LT(median["light_tree"], 0.25 * median["uniform"]) << bsp.name;
    }
    // Not by much, as lists are short, and not in every map: a tree does not know how narrow the spots below a node
    // are.
    std::ranges::sort(ratios);
    EXPECT_LT(ratios[ratios.size() / 2], 1);
    EXPECT_LT(ratios[ratios.size() * 3 / 5], 1);
}

} // namespace
} // namespace vkpt::test

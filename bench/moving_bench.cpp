// SPDX-License-Identifier: GPL-2.0-or-later
// What a view's moving things cost on the CPU: posing, trees, and writing what the device reads. 128 entities of 1,000
// triangles unless a name says otherwise. Compare CPU time over all threads ("process_time") on a machine with other
// load.
#include "ref_vkpt/rays/bvh.hpp"
#include "ref_vkpt/scene/moving_geometry.hpp"

#include <algorithm>
#include <benchmark/benchmark.h>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace vkpt {
namespace {

constexpr int entities = 128;
constexpr float pi = 3.14159265f;

// A ball of 1,000 triangles whose surface waves; as many points as models of that size have.
formats::Md2Model make_waving_ball()
{
    constexpr int around = 25, rings = 21, frames = 40;
    formats::Md2Model model;
    for (int ring = 0; ring < rings; ring++)
        for (int i = 0; i < around; i++)
            model.texture_coordinates.emplace_back(float(i) / around, float(ring) / rings);
    for (int ring = 0; ring + 1 < rings; ring++)
        for (int i = 0; i < around; i++) {
            const uint32_t a = uint32_t(ring * around + i), b = uint32_t(ring * around + (i + 1) % around);
            for (const uint32_t corner : { a, b, b + around, a, b + around, a + around })
                model.indices.push_back(corner);
        }
    for (int frame = 0; frame < frames; frame++) {
        formats::Md2Model::Frame& out = model.frames.emplace_back();
        for (int ring = 0; ring < rings; ring++)
            for (int i = 0; i < around; i++) {
                const float latitude = pi * (float(ring) + 0.5f) / rings, longitude = 2 * pi * float(i) / around;
                const glm::vec3 out_of_it(std::sin(latitude) * std::cos(longitude),
                    std::sin(latitude) * std::sin(longitude), std::cos(latitude));
                const float wave = std::sin(latitude * 7 + 2 * pi * float(frame) / frames);
                out.positions.push_back(out_of_it * (24 + 4 * wave));
                out.normals.push_back(out_of_it);
            }
    }
    return model;
}

struct Crowd {
    std::vector<Md2Pose> poses;
    std::shared_ptr<const Md2Mesh> mesh = std::make_shared<Md2Mesh>(make_waving_ball());

    Crowd()
    {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> place(-2000, 2000), angle(0, 360);
        for (int i = 0; i < entities; i++) {
            Md2Pose pose;
            pose.transform
                = md2_transform({ place(random), place(random), place(random) / 8 }, { 0, angle(random), 0 });
            pose.frame = i % 40;
            pose.old_frame = (i + 1) % 40;
            pose.backlerp = 0.3f;
            poses.push_back(pose);
        }
    }

    MovingGeometry list() const
    {
        MovingGeometry geometry(20'000);
        for (const Md2Pose& pose : poses)
            geometry.add(mesh, pose, 7, shared::MASK_OPAQUE);
        return geometry;
    }
};

// As the device's mapped memory on a machine without one of its own: ordinary, and already in use.
struct Memory {
    std::vector<shared::Triangle> triangles;
    std::vector<uint32_t> nodes, records;
    explicit Memory(const MovingGeometry& geometry)
        : triangles(geometry.triangle_count())
        , nodes(geometry.node_count() * bvh_node_words)
        , records(geometry.triangle_count() * bvh_triangle_words)
    {
    }
    MovingTarget target() { return { triangles.data(), nullptr, nodes.data(), records.data() }; }
};

void add_particles(MovingGeometry& geometry, int count)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<float> place(-200, 200);
    const Axes camera = angle_vectors({ 10, 20, 0 });
    for (int i = 0; i < count; i++)
        append_particle({ place(random), place(random), place(random) }, glm::vec3(0), camera, 3, geometry.loose());
    geometry.mask_loose(shared::MASK_TRANSLUCENT);
}

void two_levels(benchmark::State& state)
{
    const Crowd crowd;
    Workers workers { unsigned(state.range(0)) };
    MovingWriter writer(workers);
    MovingGeometry first = crowd.list();
    add_particles(first, int(state.range(1)));
    Memory memory(first);
    for (auto _ : state) {
        MovingGeometry geometry = crowd.list();
        add_particles(geometry, int(state.range(1)));
        writer.write(geometry, memory.target());
        benchmark::ClobberMemory();
    }
}
BENCHMARK(two_levels)
    ->ArgNames({ "threads", "particles" })
    ->ArgsProduct({ { 1, 2 }, { 0, 2048 } })
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// One quick tree over all triangles, on one thread, and copies of the result: what the two levels replaced.
void one_quick_tree(benchmark::State& state)
{
    const Crowd crowd;
    Workers workers { 1 };
    MovingWriter writer(workers);
    Memory memory(crowd.list());
    std::vector<shared::Triangle> triangles(memory.triangles.size());
    for (auto _ : state) {
        const MovingGeometry geometry = crowd.list();
        writer.write(geometry, { triangles.data() });
        std::vector<BvhTriangle> sources(triangles.size());
        for (size_t i = 0; i < sources.size(); i++) {
            std::ranges::copy(triangles[i].positions, sources[i].positions);
            sources[i].id = uint32_t(i);
            sources[i].mask = shared::MASK_OPAQUE;
        }
        const Bvh bvh = build_bvh(sources, BvhQuality::fast);
        memory.nodes.resize(std::max(memory.nodes.size(), bvh.nodes.size()));
        std::ranges::copy(triangles, memory.triangles.data());
        std::ranges::copy(bvh.nodes, memory.nodes.data());
        std::ranges::copy(bvh.triangles, memory.records.data());
    }
}
BENCHMARK(one_quick_tree)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

} // namespace
} // namespace vkpt

BENCHMARK_MAIN();

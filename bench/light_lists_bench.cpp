// SPDX-License-Identifier: GPL-2.0-or-later
// Time to update the light lists of a map of about 2,000 clusters in a frame.
#include "ref_vkpt/lights/dynamic_lights.hpp"
#include "ref_vkpt/lights/light_lists.hpp"
#include "tests/lights/synthetic_bsp.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace vkpt;

constexpr int cells_across = 53;
constexpr double open_share = 0.72; // of 53 x 53 cells: 2,000 clusters
constexpr float move_per_frame = 10, reach = 300; // units

struct ListSetup {
    formats::Bsp bsp = test::make_cell_map(cells_across, test::make_random_cells(cells_across, open_share, 1));
    std::mt19937 rng { 1 };

    float unit() { return float(rng() >> 8) * 0x1p-24f; }
    glm::vec3 place()
    {
        for (;;) {
            const glm::vec3 p = test::cell_size * glm::vec3(cells_across * unit(), cells_across * unit(), unit());
            if (bsp.find_cluster(p) >= 0)
                return p;
        }
    }
    shared::Emitter make_light(float reach_of_light)
    {
        shared::Emitter e {};
        e.type = shared::EMITTER_SPHERE;
        e.p0 = place();
        e.p1.x = 4;
        e.radiance = glm::vec3(1);
        e.reach = reach_of_light;
        return e;
    }
};

// Arguments: static emitters, dynamic lights, how many of these move.
void update_light_lists(benchmark::State& state)
{
    ListSetup scene;
    std::vector<shared::Emitter> fixed, dynamic;
    for (int64_t i = 0; i < state.range(0); i++)
        fixed.push_back(scene.make_light(reach)); // static lights in reach of few clusters: the lists fit in memory
    for (int64_t i = 0; i < state.range(1); i++)
        dynamic.push_back(scene.make_light(reach));
    LightLists lists;
    lists.build(scene.bsp, fixed);
    DynamicLights slots;
    float step = move_per_frame;
    for (auto _ : state) {
        for (int64_t i = 0; i < state.range(2); i++)
            dynamic[size_t(i)].p0.x += step;
        step = -step;
        std::vector<shared::Emitter> emitters = dynamic;
        slots.arrange(emitters);
        lists.update(emitters);
        benchmark::DoNotOptimize(lists.dynamic_indices().data());
    }
    state.counters["clusters"] = double(lists.lists().size() - 1);
    state.counters["entries"] = double(lists.dynamic_indices().size());
}

BENCHMARK(update_light_lists)
    ->Args({ 1000, 32, 0 })
    ->Args({ 1000, 32, 4 })
    ->Args({ 1000, 32, 32 })
    ->Args({ 100000, 32, 32 })
    ->Args({ 1000, 500, 32 })
    ->Args({ 1000, 500, 500 })
    ->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();

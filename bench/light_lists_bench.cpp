// SPDX-License-Identifier: GPL-2.0-or-later
// Time to update the light lists of a frame: of a map of about 2,000 clusters with lights that go to and fro; and, with
// --trace FILE.rtrace --map FILE.bsp, of a recorded demo, frame by frame.
#include "common/trace/trace_reader.hpp"
#include "formats/light_code.hpp"
#include "ref_vkpt/lights/dynamic_lights.hpp"
#include "ref_vkpt/lights/light_lists.hpp"
#include "ref_vkpt/scene/placed_lights.hpp"
#include "tests/lights/map_emitters.hpp"
#include "tests/lights/synthetic_bsp.hpp"

#include <CLI/CLI.hpp>
#include <benchmark/benchmark.h>
#include <fstream>
#include <iostream>
#include <map>

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

using Emitters = std::vector<shared::Emitter>;

glm::vec3 to_vec3(const float v[3]) { return { v[0], v[1], v[2] }; }

// The game module's lights and the engine's own of each frame's last view.
std::vector<Emitters> read_moving_lights(const std::string& path)
{
    trace::TraceReader reader(path);
    std::map<uint32_t, formats::LightModel> models;
    const auto note = [&](const trace::Call& call) {
        if (call.kind == trace::CallKind::register_model)
            if (const auto model = formats::find_light_model(call.name))
                models[uint32_t(call.numbers[0])] = *model;
    };
    for (const trace::LastingCall& lasting : reader.lasting_calls())
        note(lasting.call);
    std::vector<Emitters> frames;
    for (size_t i = 0; i < reader.frame_count(); i++) {
        const trace::Frame& frame = reader.frame(i);
        if (frame.views.empty())
            continue;
        const trace::View& view = frame.views.back();
        Emitters& emitters = frames.emplace_back();
        for (const trace::View::Entity& entity : view.entities)
            if (const auto model = models.find(entity.model); model != models.end())
                append_placed_lights(model->second, formats::decode_light(entity.entity.skin_number),
                    md2_transform(to_vec3(entity.entity.origin), to_vec3(entity.entity.angles)), view.refdef.time,
                    EmissionScales().point, emitters);
        for (const engine::DynamicLight& light : view.dlights)
            emitters.push_back(make_dynamic_light(to_vec3(light.origin), to_vec3(light.color), light.intensity));
    }
    return frames;
}

struct Recording {
    formats::Bsp bsp;
    std::vector<Emitters> frames;
};

Recording read_recording(const std::string& trace, const std::string& map)
{
    std::ifstream file(map, std::ios::binary);
    const std::vector<char> bytes { std::istreambuf_iterator<char>(file), {} };
    Recording recording { formats::read_bsp(std::as_bytes(std::span(bytes)), map), read_moving_lights(trace) };
    if (recording.frames.empty())
        throw std::runtime_error(trace + ": it has no frame with a view; record one with vkpt record");
    return recording;
}

void follow_recording(benchmark::State& state, const Recording& recording)
{
    LightLists lists;
    lists.build(recording.bsp, test::extract_emitters(recording.bsp, test::make_texture(glm::vec3(1))).emitters);
    DynamicLights slots;
    size_t next = 0, lights = 0;
    for (auto _ : state) {
        Emitters emitters = recording.frames[next++ % recording.frames.size()];
        lights = std::max(lights, emitters.size());
        slots.arrange(emitters);
        lists.update(emitters);
        benchmark::DoNotOptimize(lists.dynamic_indices().data());
    }
    state.counters["clusters"] = double(lists.lists().size() - 1);
    state.counters["frames"] = double(recording.frames.size());
    state.counters["lights"] = double(lights);
}

} // namespace

int main(int count, char** arguments)
try {
    benchmark::Initialize(&count, arguments);
    CLI::App app("Time to update the light lists of a frame; the options of Google Benchmark, and:");
    std::string trace, map;
    app.add_option("--trace", trace, "a recorded demo (vkpt record)")->check(CLI::ExistingFile);
    app.add_option("--map", map, "the map that it was recorded in, a .bsp file")->check(CLI::ExistingFile);
    CLI11_PARSE(app, count, arguments);
    if (trace.empty() != map.empty())
        throw std::runtime_error("--trace and --map go together");
    Recording recording;
    if (!trace.empty()) {
        recording = read_recording(trace, map);
        benchmark::RegisterBenchmark("follow_recording", follow_recording, std::cref(recording))
            ->Unit(benchmark::kMillisecond);
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}

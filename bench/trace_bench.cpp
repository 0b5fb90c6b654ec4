// SPDX-License-Identifier: GPL-2.0-or-later
// How fast a map's rays are traced, per core: by the software backend's traversal in a shader of its own ("bare"), by
// each trace backend of the real module, and by Embree, one ray at a time. Time is the process's CPU time, so that a
// driver with several threads and Embree's one thread compare; rounds alternate between all of them, and ratios are
// medians over rounds, so that other load on the machine matters little.
#include "bench/embree_scene.hpp"
#include "bench/module_tracer.hpp"
#include "bench/ray_sets.hpp"
#include "shaders/shared/scene.h"
#include "tests/rays/gpu_tracer.hpp"
#include "tests/rays/scenes.hpp"

#include "shaders/shared/trace.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

namespace vkpt::tests {
namespace {

using namespace shared;

constexpr uint32_t all_rays = 0xff;

struct Options {
    std::string map;
    uint32_t width = 640, height = 360;
    int rounds = 15;
    bool bare = false; // without the module
};

// Row by row, as the module takes them; pixels without a ray have one that ends where it starts.
std::vector<TracedRay> make_picture(const RaySet& set, const Options& options)
{
    std::vector<TracedRay> picture(size_t(options.width) * options.height, { { 0, 0, 0 }, 0, { 0, 0, 1 }, 0 });
    for (size_t i = 0; i < set.rays.size(); i++) {
        const TestRay& ray = set.rays[i];
        const glm::uvec2 pixel = pixel_of(set.places[i], options.width);
        picture[size_t(pixel.y) * options.width + pixel.x] = { { ray.origin.x, ray.origin.y, ray.origin.z }, ray.t_min,
            { ray.direction.x, ray.direction.y, ray.direction.z }, ray.t_max };
    }
    return picture;
}

// Somebody who traces a set of rays; `run` does it once and returns the CPU seconds of that.
struct Contender {
    std::string name;
    std::function<double()> run;
    std::vector<double> seconds;
};

// CPU seconds of one round on the device: what several rounds take more than one, so that uploads do not count.
double module_seconds(
    const ModuleTracer& module, const std::vector<TracedRay>& picture, bool any_hit, const Options& options)
{
    constexpr uint32_t more_rounds = 4; // rounds + 1 that goes before, see TraceRequest
    TraceRequest request;
    request.ray_mask = MASK_OPAQUE | MASK_TRANSLUCENT | MASK_ALPHA_TEST;
    request.visibility = any_hit;
    request.row_length = options.width;
    request.rounds = 1;
    const double once = cpu_seconds_of([&] { module.trace(picture, request); });
    request.rounds = more_rounds;
    return (cpu_seconds_of([&] { module.trace(picture, request); }) - once) / more_rounds;
}

// Shows each contender's millions of rays per second, and how many times as fast as the last one it is.
void report_set(const RaySet& set, const std::vector<Contender>& contenders)
{
    const double millions = double(set.rays.size()) * 1e-6;
    for (const Contender& contender : contenders) {
        std::printf("%-10s %-18s %7.2f", set.name, contender.name.c_str(), millions / find_median(contender.seconds));
        for (const Contender& other : contenders) {
            std::vector<double> ratios;
            for (size_t round = 0; round < contender.seconds.size(); round++)
                ratios.push_back(other.seconds[round] / contender.seconds[round]);
            std::printf("  %6.2f", find_median(ratios));
        }
        std::printf("\n");
    }
}

void report_build(std::span<const BvhTriangle> triangles)
{
    for (auto [name, quality] : { std::pair("best", BvhQuality::best), std::pair("fast", BvhQuality::fast) }) {
        std::vector<double> times;
        Bvh bvh;
        for (int i = 0; i < 9; i++)
            times.push_back(cpu_seconds_of([&] { bvh = build_bvh(triangles, quality); }));
        std::printf("build %s: %.2f ms, %.2f M triangles/s, %u nodes, depth %u\n", name, find_median(times) * 1e3,
            double(triangles.size()) * 1e-6 / find_median(times), bvh.node_count, bvh.max_depth);
    }
}

void run(const Options& options)
{
    MapScene scene = load_map(options.map);
    std::printf(
        "%s: %zu triangles, %zu of them lights\n", options.map.c_str(), scene.triangles.size(), scene.lights.size());
    report_build(scene.triangles);
    HeadlessCompute device(HeadlessCompute::Validation::off);
    std::printf("device: %s\n", device.device_name().c_str());
    const TracePipelines by_texels = create_trace_pipelines(device), by_address = create_trace_pipelines(device, false);
    Bvh tree = build_bvh(scene.triangles, BvhQuality::best);
    std::vector<TestRay> primary = camera_rays(scene, { options.width, options.height });
    GpuTracer camera(device, std::span(&tree, 1), primary, all_rays);
    camera.run(by_texels[0]);
    std::optional<ModuleTracer> module;
    if (!options.bare)
        module.emplace(options.map);
#ifdef VKPT_HAVE_EMBREE
    EmbreeScene embree(scene.triangles);
#endif
    std::printf("M rays/s per core, then: times as fast as each in the order of the rows (median of %d rounds)\n",
        options.rounds);
    for (const RaySet& set : make_ray_sets(scene, std::move(primary), camera.hits())) {
        GpuTracer tracer(device, std::span(&tree, 1), set.rays, all_rays);
        std::vector<Contender> contenders;
        for (auto [name, pipelines] :
            { std::pair("bare, texels", &by_texels), std::pair("bare, by address", &by_address) }) {
            const auto* pipeline = &(*pipelines)[set.any_hit];
            tracer.run(*pipeline); // compiles
            contenders.push_back(
                { name, [&tracer, pipeline] { return cpu_seconds_of([&] { tracer.run(*pipeline); }); }, {} });
        }
        const std::vector<TracedRay> picture = make_picture(set, options);
        for (const std::string& backend : module ? module->backends() : std::vector<std::string>())
            contenders.push_back({ backend,
                [&, backend] {
                    module->choose(backend);
                    return module_seconds(*module, picture, set.any_hit, options);
                },
                {} });
#ifdef VKPT_HAVE_EMBREE
        contenders.push_back(
            { "Embree", [&] { return cpu_seconds_of([&] { embree.trace(set.rays, set.any_hit); }); }, {} });
#endif
        for (int round = 0; round < options.rounds; round++)
            for (Contender& contender : contenders)
                contender.seconds.push_back(contender.run());
        report_set(set, contenders);
    }
    for (const std::string& backend : module ? module->backends() : std::vector<std::string>()) {
        module->choose(backend);
        std::printf("%s: %.0f bytes per triangle\n", backend.c_str(), module->bytes_per_triangle());
    }
}

} // namespace
} // namespace vkpt::tests

int main(int argc, char** argv)
{
    vkpt::tests::Options options;
    CLI::App app { "Rays per second of the trace backends on a map" };
    app.add_option("map", options.map, "BSP file")->required()->check(CLI::ExistingFile);
    app.add_option("--width", options.width, "pixels, a multiple of 8")
        ->check(CLI::Range(8, 8192))
        ->capture_default_str();
    app.add_option("--height", options.height, "pixels, a multiple of 8")
        ->check(CLI::Range(8, 8192))
        ->capture_default_str();
    app.add_flag("--bare", options.bare, "without the module: the traversal in a shader of its own, and Embree");
    app.add_option("--rounds", options.rounds)->check(CLI::Range(1, 1000))->capture_default_str();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    options.width &= ~7u;
    options.height &= ~7u;
    try {
        vkpt::tests::run(options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "vkpt_trace_bench: %s\n", error.what());
        return 1;
    }
    return 0;
}

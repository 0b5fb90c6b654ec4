// SPDX-License-Identifier: GPL-2.0-or-later
// What a pass over the screen costs before it does anything: an empty one, and ones that copy a screen buffer of four
// floats by 32-bit words, by 64-bit words, and of four half floats. Through buffer references, as the module's passes.
#include "bench/ray_sets.hpp"
#include "tests/trace/headless_compute.hpp"

#include "floor_spirv.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>

namespace vkpt::tests {
namespace {

constexpr uint32_t pixels = 640 * 360, pixels_per_group = 64 * 8;

void run(int rounds)
{
    struct {
        uint64_t source, target;
    } push;
    HeadlessCompute device(HeadlessCompute::Validation::off);
    std::printf("device: %s\nms of CPU time for 640 x 360 pixels\n", device.device_name().c_str());
    push = { device.create_buffer(pixels * 16).address, device.create_buffer(pixels * 16).address };
    struct Pass {
        const char* name;
        HeadlessCompute::Pipeline pipeline;
        std::vector<double> seconds;
    };
    std::vector<Pass> passes;
    for (const char* name : { "empty", "four floats, 32-bit loads", "four floats, 64-bit loads", "four half floats" }) {
        const uint32_t mode = uint32_t(passes.size());
        passes.push_back({ name, device.create_pipeline(floor_spirv, sizeof push, std::span(&mode, 1)), {} });
        device.dispatch(passes.back().pipeline, &push, pixels / pixels_per_group); // compiles
    }
    for (int round = 0; round < rounds; round++)
        for (Pass& pass : passes)
            pass.seconds.push_back(
                cpu_seconds_of([&] { device.dispatch(pass.pipeline, &push, pixels / pixels_per_group); }));
    for (const Pass& pass : passes)
        std::printf("%-26s %.2f\n", pass.name, median(pass.seconds) * 1e3);
}

} // namespace
} // namespace vkpt::tests

int main(int argc, char** argv)
{
    int rounds = 101;
    CLI::App app { "The least that a pass over the screen costs" };
    app.add_option("--rounds", rounds)->check(CLI::Range(1, 100000))->capture_default_str();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        vkpt::tests::run(rounds);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "vkpt_floor_bench: %s\n", error.what());
        return 1;
    }
    return 0;
}

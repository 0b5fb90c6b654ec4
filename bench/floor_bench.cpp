// SPDX-License-Identifier: GPL-2.0-or-later
// What a pass over the screen costs before it does anything: an empty one, and ones that copy a screen buffer or an
// image of four floats or half floats. And what a table costs that every lane reads elsewhere: 16 times 16 bytes a
// pixel, out of one that the caches hold, by buffer references as the module's passes do and as a buffer of texels.
#include "bench/ray_sets.hpp"
#include "tests/rays/headless_compute.hpp"

#include "floor_spirv.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>

namespace vkpt::tests {
namespace {

constexpr uint32_t width = 640, height = 360, pixels = width * height, pixels_per_group = 64 * 8;
constexpr uint32_t table_entries = 1024, entry_bytes = 16;

void run(int rounds)
{
    struct {
        uint64_t source, target;
        uint32_t table_mask = table_entries - 1, padding = 0;
    } push;
    HeadlessCompute device(HeadlessCompute::Validation::off);
    std::printf("device: %s\nms of CPU time for %u x %u pixels\n", device.device_name().c_str(), width, height);
    const HeadlessCompute::Buffer source = device.create_buffer(pixels * entry_bytes);
    push.source = source.address;
    push.target = device.create_buffer(pixels * entry_bytes).address;
    std::vector<HeadlessCompute::Binding> bindings;
    for (const VkFormat format : { VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT,
             VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT })
        bindings.push_back({ .image = device.create_image(format, width, height).view });
    bindings.push_back({ .texels = source.buffer, .format = VK_FORMAT_R32G32B32A32_UINT });
    std::vector<VkDescriptorType> types(4, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    types.push_back(VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER);
    struct Pass {
        const char* name;
        HeadlessCompute::Pipeline pipeline;
        std::vector<double> seconds;
    };
    std::vector<Pass> passes;
    for (const char* name : { "empty", "four floats, 32-bit loads", "four floats, 64-bit loads", "four floats, image",
             "four half floats, 64-bit", "four half floats, image", "no table, its indices", "table, 32-bit loads",
             "table, 64-bit loads", "table, texels" }) {
        const uint32_t mode = uint32_t(passes.size());
        passes.push_back({ name, device.create_pipeline(floor_spirv, sizeof push, std::span(&mode, 1), types), {} });
        device.bind(passes.back().pipeline, bindings);
        device.dispatch(passes.back().pipeline, &push, pixels / pixels_per_group); // compiles
    }
    for (int round = 0; round < rounds; round++)
        for (Pass& pass : passes)
            pass.seconds.push_back(
                cpu_seconds_of([&] { device.dispatch(pass.pipeline, &push, pixels / pixels_per_group); }));
    for (const Pass& pass : passes)
        std::printf("%-26s %.2f\n", pass.name, find_median(pass.seconds) * 1e3);
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

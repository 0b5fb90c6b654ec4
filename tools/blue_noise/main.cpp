// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt_blue_noise -o FILE.cpp: the masks that the renderer looks its random numbers up in, as a C++ source file.
#include "shaders/shared/noise.h"
#include "tools/blue_noise/void_and_cluster.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>

namespace {

using namespace vkpt;

constexpr size_t mask_voxels = size_t(shared::BLUE_NOISE_SLICES) * shared::BLUE_NOISE_SIZE * shared::BLUE_NOISE_SIZE;
static_assert(mask_voxels == 1u << 16, "values fill 16 bits");

std::vector<uint32_t> make_words(uint32_t first_seed)
{
    blue_noise::MaskSettings settings;
    settings.shape = { int(shared::BLUE_NOISE_SIZE), int(shared::BLUE_NOISE_SLICES) };
    std::vector<uint32_t> words(shared::BLUE_NOISE_WORDS, 0);
    for (uint32_t mask = 0; mask < shared::BLUE_NOISE_MASKS; mask++) {
        settings.seed = first_seed + mask;
        const std::vector<uint32_t> values = blue_noise::make_mask(settings);
        for (size_t voxel = 0; voxel < values.size(); voxel++)
            words[mask / 2 * mask_voxels + voxel] |= values[voxel] << (mask % 2 * 16);
    }
    return words;
}

std::string to_source(const std::vector<uint32_t>& words)
{
    std::string text = "// Made by vkpt_blue_noise.\n#include \"ref_vkpt/noise/blue_noise.hpp\"\n\nnamespace vkpt {\n\n"
                       "const std::array<uint32_t, shared::BLUE_NOISE_WORDS> blue_noise_words = {\n";
    for (size_t i = 0; i < words.size(); i++)
        text += fmt::format("0x{:x},{}", words[i], i % 16 == 15 ? "\n" : "");
    return text + "};\n\n} // namespace vkpt\n";
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App app("Makes the blue-noise masks.");
    std::string file;
    uint32_t seed = 1;
    app.add_option("-o", file, "C++ source file to write")->required();
    app.add_option("--seed", seed, "Seed of the first mask; the others follow")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    std::ofstream out(file, std::ios::binary);
    out << to_source(make_words(seed));
    out.close();
    if (out)
        return 0;
    fmt::print(stderr, "vkpt_blue_noise: {} could not be written: is there such a folder, and space left?\n", file);
    return 1;
}

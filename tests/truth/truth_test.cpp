// SPDX-License-Identifier: GPL-2.0-or-later
// The module's converged pictures against the path tracer beside this file, which is given nothing but what `vkpt
// export` writes. One room in every run; our map, and glossy and metal rooms, under the label "long".
#include "common/colour.hpp"
#include "tests/client/run_program.hpp"
#include "tests/module/game_folder.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/truth/path_tracer.hpp"

#include "client/analysis/linear_image.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

namespace vkpt::tests {
namespace {

struct View {
    std::string scene; // of `vkpt`: maps/NAME.bsp@x,y,z,pitch,yaw
    std::string size;
    int samples; // of each pixel, by the module
    int own_samples; // by the path tracer
    int bounces = 1;
    std::vector<std::string> settings;
};

// The wall of maps made matte: its bytes mean the same to every driver, see SrgbOfDrivers.
constexpr uint8_t plain_grey = 188;

class Truth : public testing::Test {
protected:
    std::vector<std::string> arguments_of(const View& view) const
    {
        std::vector<std::string> arguments { view.scene, "--size", view.size, "--module", VKPT_TESTED_MODULE,
            "--basedir", folder_.path().string(), "--set", "pt_bounces=" + std::to_string(view.bounces) };
        for (const std::string& setting : view.settings)
            arguments.insert(arguments.end(), { "--set", setting });
        return arguments;
    }
    void run(const std::string& command, const View& view, std::vector<std::string> more) const
    {
        std::vector<std::string> arguments = arguments_of(view);
        arguments.insert(arguments.begin(), command);
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result
            = run_program(VKPT_PROGRAM, arguments, folder_.path(), { "XDG_CACHE_HOME=" VKPT_TEST_CACHE });
        ASSERT_EQ(result.status, 0) << command << ": " << result.errors;
    }

    // Mean and blocks of 16 x 16 pixels.
    void expect_agreement(const View& view, double mean_tolerance, double block_tolerance)
    {
        ASSERT_NO_FATAL_FAILURE(run("export", view, { "-o", "scene" }));
        ASSERT_NO_FATAL_FAILURE(run("render", view, { "--spp", std::to_string(view.samples), "-o", "module.pfm" }));
        const analysis::LinearImage module = analysis::read_image(folder_.path() / "module.pfm");
        const truth::ExportedScene scene = truth::read_exported_scene(folder_.path() / "scene");
        ASSERT_EQ(module.width, scene.camera.width);
        const std::vector<glm::dvec3> own = truth::render(scene, { view.bounces, view.own_samples, 1 });

        std::vector<double> errors;
        double module_sum = 0, own_sum = 0;
        constexpr int block = 16;
        for (int y = 0; y < module.height; y += block)
            for (int x = 0; x < module.width; x += block) {
                double ours = 0, theirs = 0;
                for (int v = y; v < std::min(y + block, module.height); v++)
                    for (int u = x; u < std::min(x + block, module.width); u++) {
                        const size_t pixel = size_t(v) * size_t(module.width) + size_t(u);
                        theirs += luminance(&module.rgb[3 * pixel]);
                        ours += luminance(own[pixel]);
                    }
                module_sum += theirs;
                own_sum += ours;
                errors.push_back(std::abs(theirs / ours - 1));
            }
        std::ranges::sort(errors);
        EXPECT_NEAR(module_sum / own_sum, 1, mean_tolerance);
        EXPECT_LT(errors[errors.size() / 2], block_tolerance) << "median of the blocks";
        RecordProperty("mean", std::to_string(module_sum / own_sum));
        RecordProperty("median_block", std::to_string(errors[errors.size() / 2]));
        std::printf("    mean %.5f, median block %.5f, worst %.5f\n", module_sum / own_sum, errors[errors.size() / 2],
            errors.back());
    }

    // A room with a lamp, walls of a picture whose name tells how it reflects.
    void add_room(const std::string& wall)
    {
        MapBuilder map;
        map.add_lit_room(wall);
        folder_.add_wall(wall, plain_grey);
        folder_.add_wall("lamp", white_index);
        folder_.add_map("room", map.finish());
    }

    GameFolder folder_;
};
using TruthLong = Truth;

const std::string in_the_room = "maps/room.bsp@-90,-60,10,5,30";

TEST_F(Truth, MatteRoom)
{
    add_room("wall");
    expect_agreement({ in_the_room, "32x32", 1024, 256, 2, { "pt_roughness_default=1" } }, 0.01, 0.03);
}

TEST_F(TruthLong, GlossyRoom)
{
    add_room("gloss");
    expect_agreement({ in_the_room, "64x48", 8192, 2048, 2, {} }, 0.01, 0.02);
}

TEST_F(TruthLong, MetalRoom)
{
    add_room("metal");
    expect_agreement({ in_the_room, "64x48", 8192, 2048, 2, {} }, 0.01, 0.02);
}

// Our own map with one grey picture everywhere, nothing translucent, and matte: what is left is light and geometry.
class OurMapMadeMatte : public Truth {
protected:
    OurMapMadeMatte()
    {
        const std::filesystem::path game = std::filesystem::path(VKPT_GAME_FOLDER) / "baseq2";
        formats::Bsp bsp = formats::read_bsp(read(game / "maps/vkpt1.bsp"), "maps/vkpt1.bsp");
        constexpr uint32_t see_through = formats::SURF_WARP | formats::SURF_TRANS33 | formats::SURF_TRANS66
            | formats::SURF_FLOWING | formats::SURF_ALPHATEST;
        for (formats::BspTexinfo& texinfo : bsp.texinfos) {
            texinfo.texture = "plain";
            texinfo.next = -1;
            texinfo.flags &= ~see_through;
        }
        folder_.add_map("matte", bsp);
        folder_.add_wall("plain", plain_grey);
        for (const auto& file : std::filesystem::directory_iterator(game / "env"))
            folder_.add("env/" + file.path().filename().string(), read(file.path()));
    }
    static std::vector<std::byte> read(const std::filesystem::path& path)
    {
        std::ifstream file(path, std::ios::binary);
        EXPECT_TRUE(file) << path;
        std::vector<char> bytes { std::istreambuf_iterator<char>(file), {} };
        const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
        return { first, first + bytes.size() };
    }
    void expect_agreement_with(int bounces, int own_samples)
    {
        expect_agreement(
            { "maps/matte.bsp@0,-384,54,0,90", "96x64", 8192, own_samples, bounces, { "pt_roughness_default=1" } },
            0.003, 0.01);
    }
};
using OurMapMadeMatteLong = OurMapMadeMatte;

// With 1,024 samples the path tracer's own mean varies by 0.07 % (one standard deviation over 12 seeds, no bounce).
TEST_F(OurMapMadeMatteLong, DirectLight) { expect_agreement_with(0, 4096); }
TEST_F(OurMapMadeMatteLong, OneBounce) { expect_agreement_with(1, 4096); }
TEST_F(OurMapMadeMatteLong, FourBounces) { expect_agreement_with(4, 2048); }

} // namespace
} // namespace vkpt::tests

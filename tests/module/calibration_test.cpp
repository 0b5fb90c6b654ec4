// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt_calibrate_light from the outside: our map, path-traced, against the lightmaps that it carries.
#include "tests/client/run_program.hpp"

#include <cstdlib>
#include <gtest/gtest.h>
#include <regex>

namespace vkpt::tests {
namespace {

TEST(Calibration, OurMapIsAsBrightAsItsLightmaps)
{
    const std::string map = VKPT_GAME_FOLDER "/baseq2/maps/vkpt1.bsp";
    ASSERT_TRUE(std::filesystem::exists(map)) << "the build has made no game data: build the target game_data";
    const ScratchFolder folder;
    const ProgramResult result = run_program(VKPT_CALIBRATE_LIGHT,
        { map, "--basedir", VKPT_GAME_FOLDER, "--module", VKPT_TESTED_MODULE, "--luxels", "500", "--spp", "16",
            "--bounces", "2" },
        folder.path(), { "XDG_CACHE_HOME=" VKPT_TEST_CACHE });
    EXPECT_EQ(result.status, 0) << result.errors;
    // vkpt1.bsp, luxels, and the quartiles of path-traced to baked: docs/calibration.md has the middle one.
    std::smatch row;
    ASSERT_TRUE(std::regex_search(result.output, row, std::regex("vkpt1\\.bsp +500 +([0-9.]+) +([0-9.]+) +([0-9.]+)")))
        << result.output;
    EXPECT_NEAR(std::stod(row[2]), 0.83, 0.08);
    EXPECT_LT(std::stod(row[1]), std::stod(row[2]));
    EXPECT_GT(std::stod(row[3]), std::stod(row[2]));
}

TEST(Calibration, TellsWhatItCannotUse)
{
    const ScratchFolder folder;
    folder.write("none.bsp", "no map");
    EXPECT_EQ(run_program(VKPT_CALIBRATE_LIGHT, { "nothere.bsp" }, folder.path()).status, 2);
    const ProgramResult result = run_program(VKPT_CALIBRATE_LIGHT, { "none.bsp" }, folder.path());
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.errors.find("none.bsp"), std::string::npos) << result.errors;
}

} // namespace
} // namespace vkpt::tests

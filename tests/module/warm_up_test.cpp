// SPDX-License-Identifier: GPL-2.0-or-later
// The shaders of a frame are compiled before it, in the background, and remembered as compiled.
#include "common/read_text.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"
#include "tests/module/test_cache.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

// Draws some filtered frames of the map and returns the names of what was timed.
std::vector<std::string> draw_passes(const GameFolder& folder)
{
    // How tables are read is measured at each start, and both ways may be as quick: the shaders of one way are asked
    // for here.
    Session session(folder, { { "flt_denoiser", "asvgf" }, { "flt_taa", "on" }, { "pt_table_reads", "address" } });
    session.load_map("room");
    session.look({ -100, 0, 50 }, { 100, 0, 50 });
    session.extension().time_every_pass();
    session.draw(3);
    session.capture();
    return session.timed_passes();
}

TEST(ShaderWarmUp, CompilesEveryPassOfTheFrameOnce)
{
    GameFolder folder;
    folder.add_wall("lamp", white_index);
    MapBuilder map;
    map.add_lit_room("missing");
    folder.add_map("room", map.finish());
    draw_passes(folder);
    Session::end_idle();
    // Only the list is made anew.
    const OwnCache cache("warmed");
    std::filesystem::path list;
    for (const char* width : { "512", "default" })
        std::filesystem::remove(cache.path() / ("driver-" + std::string(width)) / "compiled.txt");

    const std::vector<std::string> passes = draw_passes(folder);
    for (const char* width : { "512", "default" }) {
        const std::filesystem::path path = cache.path() / ("driver-" + std::string(width)) / "compiled.txt";
        if (std::filesystem::exists(path))
            list = path;
    }
    Session::end_idle();
    if (list.empty() && !Session(folder).has_line("llvmpipe"))
        GTEST_SKIP() << "only Mesa's CPU driver compiles at the dispatch";
    Session::end_idle();
    const std::string compiled = read_text(list);
    EXPECT_GT(passes.size(), 10u);
    for (const std::string& pass : passes)
        if (pass != "2d") {
            EXPECT_NE(compiled.find(pass + ".comp"), std::string::npos) << pass << " was left to the frame";
        }

    draw_passes(folder);
    EXPECT_EQ(read_text(list), compiled) << "something was compiled twice";
}

} // namespace
} // namespace vkpt::tests

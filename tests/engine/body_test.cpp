// SPDX-License-Identifier: GPL-2.0-or-later
// The player's own body in the mirror of our map, in the real engine: the client does not send it.
#include "tests/engine/engine_run.hpp"
#include "tests/engine/picture_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace vkpt::tests {

namespace {

// The start faces the mirror, which is 80 units away; nothing else moves.
constexpr const char* before_the_mirror = R"({
"classname" "worldspawn"
}
{
"classname" "info_player_start"
"origin" "0 -360 32"
"angle" "270"
})";

// Mean over a part of the picture, in shares of its size.
double mean_difference(
    const formats::Image& a, const formats::Image& b, double left, double right, double top, double bottom)
{
    double sum = 0;
    int count = 0;
    for (int y = int(top * a.height); y < int(bottom * a.height); y++)
        for (int x = int(left * a.width); x < int(right * a.width); x++, count++) {
            const formats::Rgba8 p = a.pixels[size_t(y) * size_t(a.width) + size_t(x)],
                                 q = b.pixels[size_t(y) * size_t(b.width) + size_t(x)];
            sum += std::max({ std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b) });
        }
    return sum / count;
}

} // namespace

TEST(Engine, ShowsThePlayerInTheMirror)
{
    EngineOptions options;
    options.files["maps/vkpt1.ent"] = before_the_mirror;
    options.render_scale = 100;
    const std::string capture = std::string("wait_25\n") + capture_some;
    options.script = std::string("wait_100\npt_player_body 1\n") + capture + "pt_player_body 0\n" + capture + "quit\n";
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+set", "sv_entfile", "1", "+set", "deathmatch", "0",
        "+set", "cl_bob", "0", "+set", "crosshair", "0", "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    run.expect_clean();
    const auto pictures = list_pictures(run.captures());
    ASSERT_GE(pictures.size(), 2u) << run.result().console;
    const formats::Image with = load_picture(pictures.front()), without = load_picture(pictures.back());
    ASSERT_EQ(with.pixels.size(), without.pixels.size());
    const double in_mirror = mean_difference(with, without, 0.485, 0.515, 0.48, 0.68);
    const double beside = mean_difference(with, without, 0, 0.15, 0.1, 0.6);
    EXPECT_GT(in_mirror, 12) << beside;
    EXPECT_LT(beside, in_mirror / 4); // noise, which two live frames differ by
    EXPECT_LT(measure_picture(with).black, 0.5);
}

} // namespace vkpt::tests

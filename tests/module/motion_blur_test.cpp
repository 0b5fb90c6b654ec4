// SPDX-License-Identifier: GPL-2.0-or-later
// Extension::blend_next_view: what has moved goes into one average.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

TEST(MotionBlur, IsTheMeanOfTheMoments)
{
    GameFolder folder;
    folder.add_wall("wall", 180);
    folder.add_wall("lamp", white_index);
    const std::string path = folder.add_cube("cube", 12, red_index);
    MapBuilder map;
    map.add_lit_room("wall");
    folder.add_map("room", map.finish());
    Session session(folder);
    session.load_map("room");
    engine::Entity cube = make_entity(session.module().register_model(path.c_str()), { 0, 0, 30 });
    session.view.entities = &cube;
    session.view.entity_count = 1;
    // Camera and cube have moved.
    const auto set_moment = [&](bool later) {
        session.look({ -100, later ? 12.0f : 0.0f, 60 }, { 0, 0, 40 });
        cube.origin[1] = later ? 24 : -24;
    };
    constexpr int frames = 200;
    const auto converged = [&](bool later) {
        set_moment(later);
        return session.accumulate(frames);
    };
    const Radiance first = converged(false), second = converged(true);
    set_moment(false);
    session.set("pt_accumulate", 0);
    session.draw();
    session.set("pt_accumulate", 1);
    session.draw();
    for (int i = 1; i < 2 * frames; i++) {
        set_moment(i % 2 == 1);
        session.extension().blend_next_view();
        session.draw();
    }
    EXPECT_EQ(session.extension().accumulated_frames(), uint32_t(2 * frames));
    const Radiance blurred = session.capture();
    Radiance mean = first;
    for (size_t i = 0; i < mean.pixels.size(); i++)
        mean.pixels[i] = (first.pixels[i] + second.pixels[i]) * 0.5f;
    const double noise = error_between(blurred, mean);
    EXPECT_LT(noise, 0.1 * error_between(blurred, first));
    EXPECT_LT(noise, 0.1 * error_between(blurred, second));
    // Without it the next moment is not looked at, or begins anew.
    set_moment(false);
    cube.origin[1] = 0;
    session.draw();
    EXPECT_EQ(session.extension().accumulated_frames(), 1u);
}

} // namespace
} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// A window on a display of double density has four times the pixels that the engine asked for.
#include "tests/window/mock_window.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

TEST(WindowOfHighDensity, IsFilledFromTheFirstFrameOn)
{
    for (const int density : { 1, 2 }) {
        SCOPED_TRACE("density " + std::to_string(density));
        MockWindow window { 96, 64, density };
        MockEngine engine("8.70 x86_64");
        const auto expect_size = [&](const engine::Exports8& module) {
            int width = 0, height = 0;
            module.get_drawable_size(&width, &height);
            EXPECT_EQ(width, 96 * density);
            EXPECT_EQ(height, 64 * density);
        };
        const ModuleInWindow module(engine, window, {}, expect_size); // where the engine asks
        ASSERT_TRUE(module.is_running());
        expect_size(module.exports());
        module.draw(3);
        expect_size(module.exports());
        const ImageSize picture = module.extension().frame_size();
        EXPECT_EQ(picture.width, 96 * density);
        EXPECT_EQ(picture.height, 64 * density);
    }
}

} // namespace
} // namespace vkpt::tests

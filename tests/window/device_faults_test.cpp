// SPDX-License-Identifier: GPL-2.0-or-later
// What drivers of GPUs and displays may do to a window, and CPU drivers do not: by the layer of faults.
#include "tests/fault_layer/faults.hpp"
#include "tests/window/mock_window.hpp"

#include <algorithm>
#include <chrono>
#include <gtest/gtest.h>
#include <vector>

namespace vkpt::tests {
namespace {

class WithFaults : public testing::Test {
protected:
    MockWindow window;
    MockEngine engine { "8.70 x86_64" };
};
class Presenting : public WithFaults { };
class LostDevice : public WithFaults { };
class Devices : public WithFaults { };

// A frame's waiting for the display would else be the next frame's, and the device's time.
TEST_F(Presenting, TakesThePictureOnceTheFrameIsSubmitted)
{
    const Faults faults;
    const ModuleInWindow module(engine, window);
    ASSERT_TRUE(module.is_running());
    module.draw(); // which uploads, too
    for (uint32_t frame = 2; frame <= 4; frame++) {
        const FaultCounts before = Faults::counts();
        module.draw();
        const FaultCounts after = Faults::counts();
        EXPECT_EQ(after.acquired, frame);
        EXPECT_EQ(after.presented, frame);
        EXPECT_EQ(after.submissions_before_acquire, before.submissions + 1) << "the frame";
        EXPECT_EQ(after.submissions, before.submissions + 2) << "and the copy into the picture";
    }
}

// Some drivers say of every picture that it is not the best for its window.
TEST_F(Presenting, MakesNewPicturesOnlyForAnotherSize)
{
    const Faults faults("suboptimal");
    const ModuleInWindow module(engine, window);
    ASSERT_TRUE(module.is_running());
    module.draw(5);
    EXPECT_EQ(Faults::counts().swapchains, 1u);
    window.width = 120;
    module.draw(5);
    EXPECT_EQ(Faults::counts().swapchains, 2u);
    EXPECT_GE(Faults::counts().presented, 8u);
}

// The image is another one then: 2D is drawn on that.
TEST_F(Presenting, DrawsOnWhileHdrIsSwitched)
{
    const Faults faults("hdr 64 1000104008"); // A2B10G10R10, HDR10_ST2084
    const ModuleInWindow module(engine, window);
    ASSERT_TRUE(module.is_running());
    const auto picture = [&] {
        module.draw(3);
        std::vector<uint8_t> pixels(size_t(window.width) * size_t(window.height) * 4);
        EXPECT_TRUE(module.extension().capture_display(pixels.data()));
        return pixels;
    };
    const std::vector<uint8_t> expected = picture();
    EXPECT_GT(std::max({ expected[0], expected[1], expected[2] }), 20) << "nothing is drawn";
    const uint32_t swapchains = Faults::counts().swapchains;
    for (const char* hdr : { "1", "0" }) {
        engine.set("pt_hdr", hdr);
        EXPECT_TRUE(picture() == expected) << hdr;
    }
    EXPECT_EQ(Faults::counts().swapchains, swapchains + 2);
}

TEST_F(Presenting, RestsWhileTheWindowIsMinimised)
{
    const Faults faults;
    const ModuleInWindow module(engine, window);
    ASSERT_TRUE(module.is_running());
    module.draw(2);
    const FaultCounts before = Faults::counts();
    window.flags = window_minimised;
    constexpr int frames = 5;
    const auto start = std::chrono::steady_clock::now();
    module.draw(frames);
    EXPECT_GE(std::chrono::steady_clock::now() - start, frames * std::chrono::milliseconds(8));
    EXPECT_EQ(Faults::counts().acquired, before.acquired);
    EXPECT_EQ(Faults::counts().swapchains, before.swapchains);
    window.flags = 0;
    module.draw(3);
    EXPECT_GE(Faults::counts().presented, before.presented + 2);
}

// Whichever question about it is the first to notice.
TEST_F(Presenting, SurvivesTheLossOfItsSurface)
{
    const Faults faults;
    const ModuleInWindow module(engine, window);
    ASSERT_TRUE(module.is_running());
    module.draw(2);
    for (const char* fault : { "surface", "surface formats", "surface modes" }) {
        engine.console.clear();
        faults.set(fault);
        window.width += 8; // so that new pictures are asked for
        module.draw(6);
        EXPECT_EQ(engine.lines_with("the window's surface was lost").size(), 1u) << fault;
        const uint32_t presented = Faults::counts().presented;
        module.draw(2);
        EXPECT_EQ(Faults::counts().presented, presented + 2) << fault;
    }
}

TEST_F(Presenting, SurvivesWindowsWithoutPixels)
{
    const Faults faults;
    const ModuleInWindow module(engine, window);
    ASSERT_TRUE(module.is_running());
    module.draw(2);
    window.width = window.height = 0;
    const uint32_t acquired = Faults::counts().acquired;
    module.draw(3);
    EXPECT_LE(Faults::counts().acquired, acquired + 3);
    window.width = 96;
    window.height = 64;
    module.draw(3);
    EXPECT_GE(Faults::counts().presented, 4u);
}

// The engine loads the module anew; a device that is lost again would be lost for ever.
TEST_F(LostDevice, IsReplacedOnce)
{
    const Faults faults;
    const auto lose = [&](const ModuleInWindow& module) {
        module.draw(2);
        faults.set("lost");
        module.exports().begin_frame(0);
        const std::optional<RaisedError> error = catch_error([&] { module.exports().end_frame(); });
        EXPECT_EQ(Faults::counts().losses, 1u);
        return error;
    };
    {
        const ModuleInWindow module(engine, window);
        ASSERT_TRUE(module.is_running());
        EXPECT_FALSE(lose(module));
        EXPECT_EQ(engine::Restart(engine.restart), engine::Restart::full);
        const std::vector<std::string> lines = engine.lines_with("device lost");
        ASSERT_EQ(lines.size(), 1u);
        for (const char* part : { "vkQueueSubmit", "first pass", "96 x 64", "pt_trace", "pt_validation 1", "driver" })
            EXPECT_NE(lines[0].find(part), std::string::npos) << part << " is missing in: " << lines[0];
        // Until it is loaded anew.
        module.draw(3);
        EXPECT_EQ(module.exports().register_model("models/x.md2"), nullptr);
        int width = 7, height = 7;
        module.exports().draw_get_pic_size(&width, &height, "x");
        EXPECT_EQ(width, -1);
    }
    engine.restart = 0;
    const ModuleInWindow module(engine, window);
    ASSERT_TRUE(module.is_running());
    const std::optional<RaisedError> error = lose(module);
    ASSERT_TRUE(error);
    EXPECT_NE(error->text.find("device lost"), std::string::npos) << error->text;
    EXPECT_NE(engine::Restart(engine.restart), engine::Restart::full);
}

TEST_F(Devices, ThatLackPartsOfVulkanAreFound)
{
    const Faults faults("portable");
    const ModuleInWindow module(engine, window);
    ASSERT_TRUE(module.is_running());
    EXPECT_TRUE(Faults::counts().lists_portable);
    EXPECT_TRUE(Faults::counts().enables_portable);
    module.draw(2);
}

TEST_F(Devices, MayHaveQueuesForComputeAlone)
{
    const Faults faults("compute");
    const ModuleInWindow module(engine, window);
    ASSERT_TRUE(module.is_running());
    module.draw(3);
    EXPECT_EQ(Faults::counts().presented, 3u);
}

TEST_F(Devices, MayHaveNoTimestamps)
{
    const Faults faults("untimed");
    const ModuleInWindow module(engine, window, { { "pt_target_ms", "5" } });
    ASSERT_TRUE(module.is_running());
    module.draw(4);
    EXPECT_EQ(Faults::counts().timestamps, 0u);
    EXPECT_EQ(Faults::counts().presented, 4u);
}

} // namespace
} // namespace vkpt::tests

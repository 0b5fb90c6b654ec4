// SPDX-License-Identifier: GPL-2.0-or-later
// Every format that displays offer is taken, in the best order, and gets its pixels packed as Vulkan defines them.
#include "ref_vkpt/engine/errors.hpp"
#include "ref_vkpt/vulkan/window_format.hpp"
#include "tests/window/present_shader.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace vkpt::tests {
namespace {

std::vector<VkSurfaceFormatKHR> srgb_formats(const std::vector<VkFormat>& formats)
{
    std::vector<VkSurfaceFormatKHR> list;
    for (const VkFormat format : formats)
        list.push_back({ format, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR });
    return list;
}

VkFormat choose(const std::vector<VkFormat>& formats) { return choose_window_format(srgb_formats(formats)).format; }

TEST(WindowFormat, AnyOneThatDisplaysHaveIsTaken)
{
    for (const VkFormat format : { VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_A8B8G8R8_UNORM_PACK32,
             VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_A8B8G8R8_SRGB_PACK32,
             VK_FORMAT_A2R10G10B10_UNORM_PACK32, VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_R16G16B16A16_SFLOAT })
        EXPECT_EQ(choose({ VK_FORMAT_R5G6B5_UNORM_PACK16, format }), format);
}

TEST(WindowFormat, EightBitsAreBest)
{
    EXPECT_EQ(choose({ VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_B8G8R8A8_UNORM }),
        VK_FORMAT_B8G8R8A8_UNORM);
    EXPECT_EQ(choose({ VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_A2R10G10B10_UNORM_PACK32, VK_FORMAT_R8G8B8A8_SRGB }),
        VK_FORMAT_R8G8B8A8_SRGB);
}

TEST(WindowFormat, OtherColourSpacesAndUnknownFormatsAreNamed)
{
    const std::vector<VkSurfaceFormatKHR> offered { { VK_FORMAT_B8G8R8A8_UNORM, VK_COLOR_SPACE_HDR10_ST2084_EXT },
        { VK_FORMAT_R5G6B5_UNORM_PACK16, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR } };
    try {
        choose_window_format(offered);
        ADD_FAILURE() << "taken";
    } catch (const FatalError& error) {
        EXPECT_NE(std::string(error.what()).find("VkFormat 44, 4;"), std::string::npos) << error.what();
    }
}

TEST(WindowFormat, HdrIsTakenWhereItIsWantedAndOffered)
{
    const VkSurfaceFormatKHR plain { VK_FORMAT_B8G8R8A8_UNORM, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR },
        half_floats { VK_FORMAT_R16G16B16A16_SFLOAT, VK_COLOR_SPACE_EXTENDED_SRGB_LINEAR_EXT },
        hdr10 { VK_FORMAT_A2R10G10B10_UNORM_PACK32, VK_COLOR_SPACE_HDR10_ST2084_EXT },
        wide { VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_COLOR_SPACE_DISPLAY_P3_NONLINEAR_EXT };
    const std::vector all { plain, half_floats, hdr10, wide }, some { plain, wide, half_floats }, none { wide, plain };
    EXPECT_FALSE(choose_window_format(all).is_hdr());
    EXPECT_EQ(choose_window_format(all, true).packing, shared::PRESENT_BGR10A2);
    EXPECT_EQ(choose_window_format(all, true).transfer, shared::PRESENT_HDR10);
    EXPECT_EQ(choose_window_format(all, true).color_space, VK_COLOR_SPACE_HDR10_ST2084_EXT);
    EXPECT_EQ(choose_window_format(some, true).transfer, shared::PRESENT_SCRGB);
    EXPECT_EQ(choose_window_format(some, true).words, 2u);
    EXPECT_EQ(choose_window_format(none, true).format, VK_FORMAT_B8G8R8A8_UNORM);
    EXPECT_FALSE(choose_window_format(none, true).is_hdr());
}

// A window's pixel as its format's definition reads it, 0..1.
glm::vec4 unpack(uint32_t packing, glm::uvec2 words)
{
    const auto bits = [&](uint32_t shift, uint32_t count) {
        const uint32_t most = (1u << count) - 1;
        return float(words.x >> shift & most) / float(most);
    };
    switch (packing) {
    case shared::PRESENT_RGBA8:
        return { bits(0, 8), bits(8, 8), bits(16, 8), bits(24, 8) };
    case shared::PRESENT_BGRA8:
        return { bits(16, 8), bits(8, 8), bits(0, 8), bits(24, 8) };
    case shared::PRESENT_RGB10A2: // VK_FORMAT_A2B10G10R10: red in the lowest bits
        return { bits(0, 10), bits(10, 10), bits(20, 10), bits(30, 2) };
    case shared::PRESENT_BGR10A2:
        return { bits(20, 10), bits(10, 10), bits(0, 10), bits(30, 2) };
    default:
        return { glm::unpackHalf2x16(words.x), glm::unpackHalf2x16(words.y) };
    }
}

TEST(WindowFormat, PixelsKeepTheirColours)
{
    for (const uint32_t packing : { shared::PRESENT_RGBA8, shared::PRESENT_BGRA8, shared::PRESENT_RGB10A2,
             shared::PRESENT_BGR10A2, shared::PRESENT_RGBA16F })
        for (uint32_t value = 0; value < 256; value++) {
            const glm::uvec3 rgb(value, (value * 7 + 30) & 255, (value * 13 + 101) & 255);
            const glm::vec4 shown
                = unpack(packing, glsl::pack_for_window(rgb.x | rgb.y << 8 | rgb.z << 16 | 0xff000000u, packing));
            for (int i = 0; i < 3; i++) // as near as 10 bits or a half come
                EXPECT_NEAR(shown[i], float(rgb[i]) / 255, packing < shared::PRESENT_RGB10A2 ? 0 : 0.5f / 1023)
                    << "packing " << packing << ", value " << value << ", channel " << i;
            EXPECT_EQ(shown.w, 1);
        }
}

TEST(PresentMode, FollowsTheCvarWhereTheSurfaceCan)
{
    constexpr VkPresentModeKHR immediate = VK_PRESENT_MODE_IMMEDIATE_KHR, mailbox = VK_PRESENT_MODE_MAILBOX_KHR,
                               fifo = VK_PRESENT_MODE_FIFO_KHR, relaxed = VK_PRESENT_MODE_FIFO_RELAXED_KHR;
    const std::vector all { fifo, relaxed, mailbox, immediate }, some { fifo, mailbox }, least { fifo };
    EXPECT_EQ(choose_present_mode(all, VSync::off), immediate);
    EXPECT_EQ(choose_present_mode(all, VSync::on), fifo);
    EXPECT_EQ(choose_present_mode(all, VSync::adaptive), relaxed);
    EXPECT_EQ(choose_present_mode(some, VSync::off), mailbox);
    EXPECT_EQ(choose_present_mode(some, VSync::adaptive), fifo);
    EXPECT_EQ(choose_present_mode(least, VSync::off), fifo);
}

} // namespace
} // namespace vkpt::tests

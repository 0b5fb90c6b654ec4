// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/window_format.hpp"

#include "ref_vkpt/engine/errors.hpp"
#include "shaders/shared/present.h"

#include <algorithm>
#include <fmt/format.h>

namespace vkpt {

namespace {

// The best first. Our image is sRGB-encoded. Its copy into an image of the window converts nothing, so that to a
// format with _SRGB in its name it is what it is to that without.
constexpr WindowFormat known_formats[] = {
    { VK_FORMAT_B8G8R8A8_UNORM, shared::PRESENT_BGRA8 },
    { VK_FORMAT_R8G8B8A8_UNORM, shared::PRESENT_RGBA8 },
    { VK_FORMAT_A8B8G8R8_UNORM_PACK32, shared::PRESENT_RGBA8 },
    { VK_FORMAT_B8G8R8A8_SRGB, shared::PRESENT_BGRA8 },
    { VK_FORMAT_R8G8B8A8_SRGB, shared::PRESENT_RGBA8 },
    { VK_FORMAT_A8B8G8R8_SRGB_PACK32, shared::PRESENT_RGBA8 },
    { VK_FORMAT_A2R10G10B10_UNORM_PACK32, shared::PRESENT_BGR10A2 },
    { VK_FORMAT_A2B10G10R10_UNORM_PACK32, shared::PRESENT_RGB10A2 },
    { VK_FORMAT_R16G16B16A16_SFLOAT, shared::PRESENT_RGBA16F, 2 },
};

// HDR10 is what screens take; half floats are converted once more, by the desktop.
constexpr WindowFormat hdr_formats[] = {
    { VK_FORMAT_A2B10G10R10_UNORM_PACK32, shared::PRESENT_RGB10A2, 1, VK_COLOR_SPACE_HDR10_ST2084_EXT,
        shared::PRESENT_HDR10 },
    { VK_FORMAT_A2R10G10B10_UNORM_PACK32, shared::PRESENT_BGR10A2, 1, VK_COLOR_SPACE_HDR10_ST2084_EXT,
        shared::PRESENT_HDR10 },
    { VK_FORMAT_R16G16B16A16_SFLOAT, shared::PRESENT_RGBA16F, 2, VK_COLOR_SPACE_EXTENDED_SRGB_LINEAR_EXT,
        shared::PRESENT_SCRGB },
};

const WindowFormat* find_offered(std::span<const WindowFormat> wishes, std::span<const VkSurfaceFormatKHR> offered)
{
    for (const WindowFormat& wish : wishes)
        if (std::ranges::any_of(offered, [&](const VkSurfaceFormatKHR& format) {
                return format.format == wish.format && format.colorSpace == wish.color_space;
            }))
            return &wish;
    return nullptr;
}

} // namespace

WindowFormat choose_window_format(std::span<const VkSurfaceFormatKHR> offered, bool wants_hdr)
{
    if (const WindowFormat* found = wants_hdr ? find_offered(hdr_formats, offered) : nullptr)
        return *found;
    if (const WindowFormat* found = find_offered(known_formats, offered))
        return *found;
    std::string numbers;
    for (const VkSurfaceFormatKHR& format : offered)
        numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", int(format.format));
    throw FatalError("the window takes no images of 8 or 10 bits or half floats a colour, only VkFormat " + numbers
        + "; set the desktop to 24 bits of colour, or choose another device with pt_device");
}

VkPresentModeKHR choose_present_mode(std::span<const VkPresentModeKHR> offered, VSync vsync)
{
    constexpr VkPresentModeKHR wishes[][2] = {
        { VK_PRESENT_MODE_IMMEDIATE_KHR, VK_PRESENT_MODE_MAILBOX_KHR },
        { VK_PRESENT_MODE_FIFO_KHR, VK_PRESENT_MODE_FIFO_KHR },
        { VK_PRESENT_MODE_FIFO_RELAXED_KHR, VK_PRESENT_MODE_FIFO_KHR },
    };
    for (const VkPresentModeKHR wish : wishes[int(vsync)])
        if (std::ranges::find(offered, wish) != offered.end())
            return wish;
    return VK_PRESENT_MODE_FIFO_KHR; // which every surface has
}

} // namespace vkpt

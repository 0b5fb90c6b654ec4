// SPDX-License-Identifier: GPL-2.0-or-later
// Which of the formats and presentation modes that a window's surface has are taken.
#pragma once

#include "ref_vkpt/vulkan/functions.hpp"

#include <cstdint>
#include <span>

namespace vkpt {

struct WindowFormat {
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t packing = 0; // PRESENT_RGBA8 and so on
    uint32_t words = 1; // of a pixel
    VkColorSpaceKHR color_space = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    uint32_t transfer = 0; // PRESENT_SDR, PRESENT_HDR10, PRESENT_SCRGB
    bool is_hdr() const { return transfer != 0; }
};

// An HDR one where `wants_hdr` and there is one. Throws FatalError where none of those offered is known.
WindowFormat choose_window_format(std::span<const VkSurfaceFormatKHR> offered, bool wants_hdr = false);

// As r_vsync says: never wait for the screen; always; not with a frame that is late already, which then tears.
enum class VSync { off, on, adaptive };

VkPresentModeKHR choose_present_mode(std::span<const VkPresentModeKHR> offered, VSync vsync);

} // namespace vkpt

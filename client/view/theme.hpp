// SPDX-License-Identifier: GPL-2.0-or-later
// Colours and sizes of the viewer's interface.
#pragma once

#include <cstddef>
#include <imgui.h>

namespace vkpt::client::view {

inline constexpr ImU32 colour_a = IM_COL32(255, 183, 77, 255); // side A
inline constexpr ImU32 colour_b = IM_COL32(79, 195, 247, 255); // side B
inline constexpr ImU32 colour_dim = IM_COL32(160, 166, 176, 255);
inline constexpr ImU32 colour_text = IM_COL32(236, 238, 242, 255);
inline constexpr ImU32 colour_plate = IM_COL32(12, 13, 15, 215); // behind text over the picture
inline constexpr ImU32 colour_warning = IM_COL32(255, 112, 100, 255);
inline constexpr float panel_width = 380;

// Style and font of the current context.
void apply_theme();

// A colour for the n-th of several things.
ImU32 series_colour(size_t n);

} // namespace vkpt::client::view

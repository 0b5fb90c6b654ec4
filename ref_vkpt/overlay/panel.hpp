// SPDX-License-Identifier: GPL-2.0-or-later
// Lines of text on a darkened ground in the window's upper corner, in the game's own font.
#pragma once

#include "ref_vkpt/draw2d/draw2d.hpp"

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>

namespace vkpt {

struct PanelLine {
    std::string text;
    bool marked = false; // in the font's other colour
    bool operator==(const PanelLine&) const = default;
};

enum class PanelSide { left, right };

// How large a character of 8 pixels is shown in a window so high: the menus' whole scales.
float panel_scale(int window_height);

// How many characters of a line there is room for.
size_t panel_columns(VkExtent2D window);

void draw_panel(Draw2d& draw2d, VkExtent2D window, PanelSide side, std::span<const PanelLine> lines);

// Of these lines, the one at a place in the window; nothing: none is there.
std::optional<size_t> find_line(VkExtent2D window, PanelSide side, std::span<const PanelLine> lines, glm::vec2 place);
// The middle of a line's right end.
glm::vec2 end_of_line(VkExtent2D window, PanelSide side, std::span<const PanelLine> lines, size_t line);

// An arrow, with its tip there.
void draw_pointer(Draw2d& draw2d, VkExtent2D window, glm::vec2 tip);

} // namespace vkpt

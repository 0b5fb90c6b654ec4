// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/overlay/panel.hpp"

#include <algorithm>

namespace vkpt {

namespace {

constexpr int character = 8, gap = 2; // pixels of the font, between lines
constexpr int other_colour = 128; // the font's second half

} // namespace

float panel_scale(int window_height) { return float(std::max(1, window_height / 360)); }

// Beside them there is a margin of two on either side: before the ground and within it.
size_t panel_columns(VkExtent2D window)
{
    return size_t(std::max(0, int(float(window.width) / (character * panel_scale(int(window.height)))) - 4));
}

void draw_panel(Draw2d& draw2d, VkExtent2D window, PanelSide side, std::span<const PanelLine> lines)
{
    if (lines.empty())
        return;
    const float scale = panel_scale(int(window.height));
    const auto pixels = [&](int units) { return int(float(units) * scale); };
    size_t columns = 0;
    for (const PanelLine& line : lines)
        columns = std::max(columns, line.text.size());
    const int margin = pixels(character), line_height = pixels(character + gap);
    Rectangle ground { margin, margin, pixels(character * (int(columns) + 2)),
        line_height * int(lines.size()) + margin };
    if (side == PanelSide::right)
        ground.x = int(window.width) - margin - ground.width;
    draw2d.draw_shade(ground);
    int y = ground.y + margin / 2 + pixels(gap) / 2;
    for (const PanelLine& line : lines) {
        int x = ground.x + margin;
        for (const char c : line.text) {
            draw2d.draw_character(x, y, (c & 127) + (line.marked ? other_colour : 0), scale);
            x += pixels(character);
        }
        y += line_height;
    }
}

} // namespace vkpt

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

namespace {

struct Layout {
    Rectangle ground;
    int margin, first, line_height; // pixels; `first`: the first line's top
};

Layout lay_out(VkExtent2D window, PanelSide side, std::span<const PanelLine> lines)
{
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
    return { ground, margin, ground.y + margin / 2 + pixels(gap) / 2, line_height };
}

} // namespace

void draw_panel(Draw2d& draw2d, VkExtent2D window, PanelSide side, std::span<const PanelLine> lines)
{
    if (lines.empty())
        return;
    const float scale = panel_scale(int(window.height));
    const Layout layout = lay_out(window, side, lines);
    draw2d.draw_shade(layout.ground);
    int y = layout.first;
    for (const PanelLine& line : lines) {
        int x = layout.ground.x + layout.margin;
        for (const char c : line.text) {
            draw2d.draw_character(x, y, (c & 127) + (line.marked ? other_colour : 0), scale);
            x += int(character * scale);
        }
        y += layout.line_height;
    }
}

std::optional<size_t> find_line(VkExtent2D window, PanelSide side, std::span<const PanelLine> lines, glm::vec2 place)
{
    const auto [ground, margin, first, line_height] = lay_out(window, side, lines);
    const glm::ivec2 point(place);
    if (point.x < ground.x || point.x >= ground.x + ground.width || point.y < first)
        return std::nullopt;
    const auto line = size_t((point.y - first) / line_height);
    return line < lines.size() ? std::optional(line) : std::nullopt;
}

glm::vec2 end_of_line(VkExtent2D window, PanelSide side, std::span<const PanelLine> lines, size_t line)
{
    const auto [ground, margin, first, line_height] = lay_out(window, side, lines);
    return { ground.x + ground.width - margin, first + (int(line) * 2 + 1) * line_height / 2 };
}

void draw_pointer(Draw2d& draw2d, VkExtent2D window, glm::vec2 tip)
{
    constexpr int height = 9, black = 0, white = 15; // units; of the game's palette
    const auto unit = int(panel_scale(int(window.height)));
    const glm::ivec2 corner(tip);
    for (int row = 0; row < height; row++) { // a triangle with an edge
        draw2d.draw_fill({ corner.x, corner.y + row * unit, (row + 1) * unit, unit }, black);
        if (row > 1 && row + 1 < height)
            draw2d.draw_fill({ corner.x + unit, corner.y + row * unit, (row - 1) * unit, unit }, white);
    }
}

} // namespace vkpt

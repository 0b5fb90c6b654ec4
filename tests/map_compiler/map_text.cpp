// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/map_compiler/map_text.hpp"

#include "tools/map_compiler/compiler.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <set>

namespace vkpt::tests {

std::string side_text(glm::ivec3 a, glm::ivec3 b, glm::ivec3 c, const std::string& texture, const std::string& surface)
{
    return fmt::format("( {} {} {} ) ( {} {} {} ) ( {} {} {} ) {} 0 0 0 1 1{}\n", a.x, a.y, a.z, b.x, b.y, b.z, c.x,
        c.y, c.z, texture, surface);
}

std::string box_brush(const Box& box, const std::string& texture, const std::string& surface)
{
    const auto [x0, y0, z0] = std::array { box.mins.x, box.mins.y, box.mins.z };
    const auto [x1, y1, z1] = std::array { box.maxs.x, box.maxs.y, box.maxs.z };
    return "{\n" + side_text({ x0, y0, z0 }, { x0, y1, z0 }, { x0, y0, z1 }, texture, surface)
        + side_text({ x1, y0, z0 }, { x1, y0, z1 }, { x1, y1, z0 }, texture, surface)
        + side_text({ x0, y0, z0 }, { x0, y0, z1 }, { x1, y0, z0 }, texture, surface)
        + side_text({ x0, y1, z0 }, { x1, y1, z0 }, { x0, y1, z1 }, texture, surface)
        + side_text({ x0, y0, z0 }, { x1, y0, z0 }, { x0, y1, z0 }, texture, surface)
        + side_text({ x0, y0, z1 }, { x0, y1, z1 }, { x1, y0, z1 }, texture, surface) + "}\n";
}

std::string prism_brush(const std::vector<glm::ivec2>& base, int bottom, int top, const std::string& texture)
{
    std::string text = "{\n" + side_text({ 0, 0, bottom }, { 1, 0, bottom }, { 0, 1, bottom }, texture)
        + side_text({ 0, 0, top }, { 0, 1, top }, { 1, 0, top }, texture);
    for (size_t i = 0; i < base.size(); i++) {
        const glm::ivec2 a = base[i], b = base[(i + 1) % base.size()];
        text += side_text({ a.x, a.y, bottom }, { a.x, a.y, top }, { b.x, b.y, bottom }, texture);
    }
    return text + "}\n";
}

namespace {

std::vector<int> cell_borders(const std::vector<Box>& air, int axis)
{
    constexpr int wall = 32;
    std::set<int> borders;
    for (const Box& box : air)
        borders.insert({ box.mins[axis], box.maxs[axis] });
    const int first = *borders.begin() - wall, last = *borders.rbegin() + wall;
    borders.insert({ first, last });
    return { borders.begin(), borders.end() };
}

bool is_air(const std::vector<Box>& air, const Box& cell)
{
    return std::ranges::any_of(air, [&](const Box& box) {
        for (int axis = 0; axis < 3; axis++)
            if (cell.mins[axis] < box.mins[axis] || cell.maxs[axis] > box.maxs[axis])
                return false;
        return true;
    });
}

} // namespace

std::string walls_around(const std::vector<Box>& air, const std::string& texture)
{
    const std::vector<int> x = cell_borders(air, 0), y = cell_borders(air, 1), z = cell_borders(air, 2);
    std::string text;
    for (size_t i = 0; i + 1 < x.size(); i++)
        for (size_t j = 0; j + 1 < y.size(); j++)
            for (size_t k = 0; k + 1 < z.size(); k++) {
                Box cell { { x[i], y[j], z[k] }, { x[i + 1], y[j + 1], z[k + 1] } };
                if (is_air(air, cell))
                    continue;
                for (; k + 2 < z.size(); k++) { // one brush upwards
                    const Box above { { x[i], y[j], z[k + 1] }, { x[i + 1], y[j + 1], z[k + 2] } };
                    if (is_air(air, above))
                        break;
                    cell.maxs.z = above.maxs.z;
                }
                text += box_brush(cell, texture);
            }
    return text;
}

std::string entity_text(const Pairs& pairs, const std::string& brushes)
{
    std::string text = "{\n";
    for (const auto& [key, value] : pairs)
        text += fmt::format("\"{}\" \"{}\"\n", key, value);
    return text + brushes + "}\n";
}

std::string two_rooms::text()
{
    std::string world = walls_around({ room_a, room_b, room_c, doorway, pit, { { 600, 256, 0 }, { 700, 520, 128 } },
                                         { { 256, 420, 0 }, { 700, 520, 128 } } },
        "wall");
    world += box_brush({ pit.mins, { pit.maxs.x, pit.maxs.y, water_level } }, "water", " 32 40 0"); // warp, trans66
    for (int step = 0; step < 4; step++)
        world += box_brush({ { 400 + step * 32, 100, 0 }, { 528, 256, 16 + 16 * step } }, "step");
    world += box_brush({ { -64, -16, 184 }, { 0, 48, 192 } }, "lamp", " 0 1 400");
    world += box_brush({ { 500, -64, 184 }, { 564, 0, 192 } }, "lamp", " 0 1 400");
    world += box_brush({ { -100, 100, 0 }, { -60, 140, 60 } }, "crate", " 134217729 0 0"); // detail, solid
    world += prism_brush({ { 128, 128 }, { 160, 160 }, { 128, 192 }, { 96, 160 } }, 0, 128, "pillar");
    world += box_brush({ { -250, 200, 100 }, { -200, 250, 192 } }, "clip");
    world += box_brush({ { -32, 540, 0 }, { 32, 548, 64 } }, "glass", " 2 16 0"); // window, trans33
    return "// Two rooms\n" + entity_text({ { "classname", "worldspawn" } }, world)
        + entity_text({ { "classname", "info_player_start" }, { "origin", "64 0 24" }, { "angle", "0" } })
        + entity_text({ { "classname", "func_door" }, { "angle", "-1" } },
            box_brush({ { 264, -48, 0 }, { 280, 48, 112 } }, "door"))
        + entity_text(
            { { "classname", "light" }, { "light", "200" }, { "origin", "0 460 150" }, { "_color", "1 0.5 0.25" } })
        + entity_text({ { "classname", "light" }, { "light", "150" }, { "origin", "650 400 100" }, { "style", "1" } })
        + entity_text({ { "classname", "func_rotating" }, { "speed", "20" } },
            box_brush({ { 600, -100, 40 }, { 680, -80, 60 } }, "fan")
                + box_brush({ { 636, -94, 46 }, { 644, -86, 54 } }, "origin"))
        + entity_text({ { "classname", "trigger_once" } }, box_brush({ { 300, -40, 0 }, { 310, 40, 40 } }, "trigger"));
}

std::string open_room_text()
{
    const auto& [mins, maxs] = two_rooms::room_a;
    const std::string walls = box_brush({ { mins.x, mins.y, -16 }, { maxs.x, maxs.y, 0 } }, "floor")
        + box_brush({ { mins.x - 16, mins.y, 0 }, { mins.x, maxs.y, maxs.z } }, "wall")
        + box_brush({ { maxs.x, mins.y, 0 }, { maxs.x + 16, maxs.y, maxs.z } }, "wall")
        + box_brush({ { mins.x, mins.y - 16, 0 }, { maxs.x, mins.y, maxs.z } }, "wall")
        + box_brush({ { mins.x, maxs.y, 0 }, { maxs.x, maxs.y + 16, maxs.z } }, "wall");
    return entity_text({ { "classname", "worldspawn" } }, walls)
        + entity_text({ { "classname", "info_player_start" }, { "origin", "0 0 24" } });
}

namespace {

formats::Bsp compile_with(const std::string& text, bool light)
{
    tools::CompileOptions options;
    options.threads = 2;
    options.light = light;
    const formats::Bsp bsp = tools::compile_map(text, "test.map", options);
    return formats::read_bsp(formats::write_bsp(bsp), "test.bsp");
}

} // namespace

formats::Bsp compile(const std::string& text) { return compile_with(text, true); }

formats::Bsp compile_dark(const std::string& text) { return compile_with(text, false); }

} // namespace vkpt::tests

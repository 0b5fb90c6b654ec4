// SPDX-License-Identifier: GPL-2.0-or-later
// Procedural wall pictures: a recipe gives colour and height at every point of the unit tile; relief is baked in
// mildly.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

namespace vkpt::tools {

struct Surface {
    glm::vec3 colour { 0.5f };
    float height = 0; // 1 = 1/64 of the tile
};
using Recipe = std::function<Surface(glm::vec2 uv)>; // u right, v down, both 0..1

struct Texture {
    std::string name; // below textures/, no ending
    int size = 256; // of the WAL; the PNG twin has twice that
    Recipe recipe;
    uint32_t flags = 0, contents = 0;
    int32_t value = 0;
    std::string next_animation;
};

// `size` x `size`, row by row.
std::vector<glm::vec3> render_surface(const Recipe& recipe, int size);

// Building blocks. Distances are in tiles, negative inside, and wrap at the tile's border.
float wrapped_box(glm::vec2 uv, glm::vec2 low, glm::vec2 high);
float wrapped_distance(glm::vec2 uv, glm::vec2 point);
glm::vec3 hue_shift(glm::vec3 colour, float amount); // brightness +-amount

struct Plate {
    glm::vec2 low, high;
    glm::vec3 colour;
    float bolt_inset = 0; // tiles from the corners; 0: no bolts
    float lift = 1; // height
};
struct PlateStyle {
    glm::vec3 gap_colour { 0.07f, 0.08f, 0.09f };
    float gap = 0.004f; // half of the space between plates, tiles
    float bevel = 0.008f; // tiles
    float cut = 0.02f; // chamfered corners, tiles
    float wear = 0.5f; // 0 new .. 1 old
    float grain = 0.04f;
    uint32_t seed = 1;
};
// Painted metal plates on a dark ground, with chipped edges, grime and bolts.
Surface plates(glm::vec2 uv, std::span<const Plate> list, const PlateStyle& style);

// All of the house's textures.
std::vector<Texture> structural_textures(); // walls, floors, trims, crates
std::vector<Texture> natural_textures(); // stone, plants, liquids, sky
std::vector<Texture> emissive_textures(); // light panels, screens
std::vector<Texture> tool_textures(); // what the compiler and editors use

} // namespace vkpt::tools

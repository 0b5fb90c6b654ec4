// SPDX-License-Identifier: GPL-2.0-or-later
// Models built from rigid parts. All of them share one skin, an atlas of materials: each face takes a whole material
// cell, whose painted rim gives it a bevel. Space: x forward, y left, z up, Quake units.
#pragma once

#include "formats/image.hpp"
#include "formats/model.hpp"
#include "tools/asset_generator/output.hpp"

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

namespace vkpt::tools {

enum class Material : int {
    steel,
    dark_steel,
    gunmetal,
    rubber,
    amber_paint,
    teal_paint,
    red_paint,
    green_paint,
    blue_paint,
    copper,
    gold,
    chrome,
    cloth,
    skin,
    white_paint,
    visor,
    glow_amber,
    glow_teal,
    glow_red,
    glow_green,
    glow_blue,
    glow_violet,
    glow_white,
    fire,
    flesh,
    bone,
    hazard,
    medic,
    grille,
    wood,
    smoke,
    armour,
    count
};

inline constexpr std::string_view shared_skin = "models/vkpt/skin.pcx";
// `armour`: colour of the Material::armour cell, by which player skins differ.
formats::IndexedImage make_skin(glm::vec3 armour);

struct Pose {
    std::string name; // at most 15 letters
    std::vector<glm::mat4> parts; // model from part; a missing one is the identity
};

class Mesh {
public:
    // Everything added from now on belongs to `part`.
    void begin_part(int part) { part_ = part; }
    // Corners counter-clockwise seen from outside.
    void quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, Material material);
    void triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, Material material);
    void box(glm::vec3 low, glm::vec3 high, Material material);
    // A box whose upper face is `taper` times the lower one's size (z up).
    void tapered_box(glm::vec3 low, glm::vec3 high, float taper, Material material);
    // A round bar from `from` to `to`; its radii at both ends.
    void tube(
        glm::vec3 from, glm::vec3 to, float radius_from, float radius_to, Material side, Material caps, int sides = 8);
    void ball(glm::vec3 centre, glm::vec3 radii, Material material, int slices = 8, int stacks = 5);
    // Adds another mesh's faces, moved, as the current part.
    void add(const Mesh& other, const glm::mat4& placement);

    size_t triangle_count() const { return faces_.size(); }
    formats::Md2Model build(const std::vector<Pose>& poses, const std::vector<std::string>& skins) const;
    formats::Md2Model build_still() const;

private:
    struct Corner {
        glm::vec3 position, normal;
        glm::vec2 uv;
        int part;
    };
    uint32_t corner(glm::vec3 position, glm::vec3 normal, Material material, glm::vec2 local);
    void face(uint32_t a, uint32_t b, uint32_t c) { faces_.push_back({ a, b, c }); }

    std::vector<Corner> corners_;
    std::vector<std::array<uint32_t, 3>> faces_;
    int part_ = 0;
};

glm::mat4 move(glm::vec3 by);
// Degrees, Quake's way: pitch down, yaw left, roll right; roll first.
glm::mat4 turn(float pitch, float yaw, float roll = 0);
glm::mat4 stretch(glm::vec3 by);

void write_shared_skin(const Output& out);
void write_model(const Output& out, std::string_view path, const formats::Md2Model& model);

} // namespace vkpt::tools

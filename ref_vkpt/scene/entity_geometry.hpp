// SPDX-License-Identifier: GPL-2.0-or-later
// What a refdef shows beside the world, as triangles in world space: models, brush models, sprites, beams, particles.
// Every function appends to `out`. Things whose numbers are not finite, or lie far outside of any map, append nothing.
#pragma once

#include "formats/model.hpp"
#include "shaders/shared/scene.h"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace vkpt {

// Unit vectors in 2 x 16 bit snorm, x in the low half, as shaders/lib/packing.glsl does. A vector without direction
// gives +z.
uint32_t encode_octahedral(glm::vec3 direction);
glm::vec3 decode_octahedral(uint32_t bits);

struct Axes {
    glm::vec3 forward, right, up;
};
// Quake's angles are pitch, yaw, roll in degrees. Yaw turns counter-clockwise seen from above; positive pitch looks
// down; positive roll lifts the left side. Zero: forward +x, right -y, up +z.
Axes angle_vectors(glm::vec3 angles);

// Model space (x forward, y left, z up) to world space. `rotation` keeps lengths and angles.
struct Transform {
    glm::vec3 origin { 0 };
    glm::mat3 rotation { 1 };
    glm::vec3 point(glm::vec3 p) const { return origin + rotation * p; }
    glm::vec3 direction(glm::vec3 d) const { return rotation * d; }
};
// Brush models turn as angle_vectors says; MD2 models too, except that they roll the other way round. (Quake II's
// renderers turn entities by the negatives of pitch and roll, having negated both before for brush models but only
// pitch for MD2.)
Transform brush_model_transform(glm::vec3 origin, glm::vec3 angles);
Transform md2_transform(glm::vec3 origin, glm::vec3 angles);
// Where an entity stands between its last two places: the engine's renderers blend MD2 models' origins as their frames.
glm::vec3 blend_origins(glm::vec3 origin, glm::vec3 old_origin, float backlerp);

// Left-handed players see their weapon mirrored: plane through the camera, its normal the camera's right vector.
struct Mirror {
    glm::vec3 point, normal;
};

struct Md2Pose {
    Transform transform;
    int frame = 0, old_frame = 0; // out of range: the nearest one
    float backlerp = 0; // 0: frame, 1: old_frame
    float shell_distance = 0; // pushes all positions out along their normals
    std::optional<Mirror> mirror;
};
inline constexpr float powerup_shell_distance = 4; // quad damage and its like, around a player or monster
inline constexpr float weapon_shell_distance = 0.5f; // around a view weapon, where 4 units would fill the screen

void append_md2(
    const formats::Md2Model& model, const Md2Pose& pose, uint32_t material, std::vector<shared::Triangle>& out);

struct BrushModelPose {
    Transform transform;
    std::function<uint32_t(uint32_t)> remap_material; // none: materials stay
    int first_emitter = -1; // added to the triangles' emitters; -1: they emit nothing
};
// `triangles` are in model space.
void append_brush_model(
    std::span<const shared::Triangle> triangles, const BrushModelPose& pose, std::vector<shared::Triangle>& out);

// A square facing against camera.forward, the picture upright.
void append_sprite(const formats::Sp2Sprite::Frame& frame, glm::vec3 origin, const Axes& camera, uint32_t material,
    std::vector<shared::Triangle>& out);

// A closed prism of six sides; u runs around, v from start to end.
void append_beam(glm::vec3 start, glm::vec3 end, float diameter, uint32_t material, std::vector<shared::Triangle>& out);

// A square around `origin` facing against camera.forward, as wide as the dot that Quake II draws: 1.25 units, and
// slowly more with its distance from `eye`, so that it stays visible.
float particle_width(float distance);
void append_particle(
    glm::vec3 origin, glm::vec3 eye, const Axes& camera, uint32_t material, std::vector<shared::Triangle>& out);

// Stands for a missing model: an octahedron, 16 units from its middle to each corner.
void append_null_model(const Transform& transform, uint32_t material, std::vector<shared::Triangle>& out);

} // namespace vkpt

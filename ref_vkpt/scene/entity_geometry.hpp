// SPDX-License-Identifier: GPL-2.0-or-later
// Where things stand that a refdef shows, and those of them that have no mesh as triangles in world space: sprites,
// beams, particles. The functions append to `out`. Things whose numbers are not finite, or lie far outside of any map,
// append nothing.
#pragma once

#include "formats/model.hpp"
#include "ref_vkpt/lights/octahedral.hpp"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <vector>

namespace vkpt {

// Finite, and not far outside of any map: small enough that products of coordinates stay finite.
bool is_sane(float value);
bool is_sane(glm::vec3 v);

// A vector as the engine's structures have it.
inline glm::vec3 to_vec3(const float v[3]) { return { v[0], v[1], v[2] }; }

struct Axes {
    glm::vec3 forward, right, up;
};
// Quake's angles are pitch, yaw, roll in degrees. Yaw turns counter-clockwise seen from above; positive pitch looks
// down; positive roll lifts the left side. Zero: forward +x, right -y, up +z.
Axes angle_vectors(glm::vec3 angles);
bool is_sane(const Axes& axes);

// Model space (x forward, y left, z up) to world space. `rotation` keeps lengths and angles.
struct Transform {
    glm::vec3 origin { 0 };
    glm::mat3 rotation { 1 };
    glm::vec3 point(glm::vec3 p) const { return origin + rotation * p; }
    glm::vec3 direction(glm::vec3 d) const { return rotation * d; }
    bool operator==(const Transform&) const = default;
};
bool is_sane(const Transform& transform);
// Brush models turn as angle_vectors says; MD2 models too, except that they roll the other way round. (Quake II's
// renderers turn entities by the negatives of pitch and roll, having negated both before for brush models but only
// pitch for MD2.)
Transform brush_model_transform(glm::vec3 origin, glm::vec3 angles);
Transform md2_transform(glm::vec3 origin, glm::vec3 angles);
// Where an entity stands between its last two places: the engine's renderers blend MD2 models' origins as their frames.
glm::vec3 blend_origins(glm::vec3 origin, glm::vec3 old_origin, float backlerp);

// A square facing against camera.forward, the texture upright.
void append_sprite(const formats::Sp2Sprite::Frame& frame, glm::vec3 origin, const Axes& camera, uint32_t material,
    std::vector<shared::Triangle>& out);

// A closed prism of six sides; u runs around, v from start to end.
void append_beam(glm::vec3 start, glm::vec3 end, float diameter, uint32_t material, std::vector<shared::Triangle>& out);

// A square around `origin` facing against camera.forward, as wide as the dot that Quake II draws: 1.25 units, and
// slowly more with its distance from `eye`, so that it stays visible; all that times `size`.
float particle_width(float distance);
void append_particle(glm::vec3 origin, glm::vec3 eye, const Axes& camera, uint32_t material,
    std::vector<shared::Triangle>& out, float size = 1);

// Stands for a missing model: an octahedron, 16 units from its middle to each corner.
void append_null_model(const Transform& transform, uint32_t material, std::vector<shared::Triangle>& out);
void append_octahedron(const Transform& transform, float radius, uint32_t material, std::vector<shared::Triangle>& out);

} // namespace vkpt

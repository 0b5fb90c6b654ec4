// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/entity_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace vkpt {

using glm::vec2;
using glm::vec3;
using shared::Triangle;

namespace {

struct Corner {
    vec3 position;
    vec2 uv;
    uint32_t normal;
};

void append_triangle(const Corner& a, const Corner& b, const Corner& c, uint32_t material, std::vector<Triangle>& out)
{
    Triangle triangle {};
    int i = 0;
    for (const Corner* corner : { &a, &b, &c }) {
        triangle.positions[i] = corner->position;
        triangle.uvs[i] = corner->uv;
        triangle.normals[i++] = corner->normal;
    }
    triangle.material = material;
    triangle.emitter = -1;
    triangle.cluster = -1;
    out.push_back(triangle);
}

// Corners counter-clockwise seen from the front.
void append_quad(const std::array<Corner, 4>& corners, uint32_t material, std::vector<Triangle>& out)
{
    append_triangle(corners[0], corners[1], corners[2], material, out);
    append_triangle(corners[0], corners[2], corners[3], material, out);
}

// left..right along camera.right and bottom..top along camera.up, from `origin`.
struct Extent {
    float left, right, bottom, top;
};

void append_billboard(
    vec3 origin, const Extent& extent, const Axes& camera, uint32_t material, std::vector<Triangle>& out)
{
    const uint32_t normal = encode_octahedral(-camera.forward);
    const auto corner = [&](float x, float y, vec2 uv) {
        return Corner { origin + camera.right * x + camera.up * y, uv, normal };
    };
    append_quad({ corner(extent.left, extent.bottom, { 0, 1 }), corner(extent.right, extent.bottom, { 1, 1 }),
                    corner(extent.right, extent.top, { 1, 0 }), corner(extent.left, extent.top, { 0, 0 }) },
        material, out);
}

} // namespace

bool is_sane(float value) { return std::abs(value) < 1e6f; } // not NaN
bool is_sane(vec3 v) { return is_sane(v.x) && is_sane(v.y) && is_sane(v.z); }
bool is_sane(const Axes& axes) { return is_sane(axes.forward) && is_sane(axes.right) && is_sane(axes.up); }
bool is_sane(const Transform& t)
{
    return is_sane(t.origin) && is_sane(t.rotation[0]) && is_sane(t.rotation[1]) && is_sane(t.rotation[2]);
}

Axes angle_vectors(vec3 angles)
{
    const Transform t = brush_model_transform(vec3(0), angles);
    return { t.rotation[0], -t.rotation[1], t.rotation[2] };
}

Transform brush_model_transform(vec3 origin, vec3 angles)
{
    const vec3 a = glm::radians(angles);
    const float sp = std::sin(a.x), cp = std::cos(a.x), sy = std::sin(a.y), cy = std::cos(a.y), sr = std::sin(a.z),
                cr = std::cos(a.z);
    // First roll about x, then pitch about y, then yaw about z; the columns are forward, left and up.
    return { origin,
        glm::mat3(vec3(cp * cy, cp * sy, -sp), vec3(sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, sr * cp),
            vec3(cr * sp * cy + sr * sy, cr * sp * sy - sr * cy, cr * cp)) };
}

Transform md2_transform(vec3 origin, vec3 angles)
{
    return brush_model_transform(origin, { angles.x, angles.y, -angles.z });
}

vec3 blend_origins(vec3 origin, vec3 old_origin, float backlerp)
{
    return backlerp > 0 && is_sane(old_origin) ? glm::mix(origin, old_origin, std::min(backlerp, 1.f)) : origin;
}

void append_sprite(const formats::Sp2Sprite::Frame& frame, vec3 origin, const Axes& camera, uint32_t material,
    std::vector<Triangle>& out)
{
    if (!is_sane(origin) || !is_sane(camera) || frame.width < 1 || frame.height < 1)
        return;
    const float left = -float(frame.origin_x), bottom = -float(frame.origin_y);
    append_billboard(
        origin, { left, left + float(frame.width), bottom, bottom + float(frame.height) }, camera, material, out);
}

void append_beam(vec3 start, vec3 end, float diameter, uint32_t material, std::vector<Triangle>& out)
{
    constexpr int sides = 6;
    const float length = glm::length(end - start);
    if (!is_sane(start) || !is_sane(end) || !is_sane(diameter) || !(diameter > 0) || !(length > 1e-3f))
        return;
    const vec3 along = (end - start) / length;
    const vec3 helper = std::abs(along.z) < 0.7f ? vec3(0, 0, 1) : vec3(1, 0, 0);
    const vec3 across = glm::normalize(glm::cross(helper, along)), upward = glm::cross(along, across);

    std::array<vec3, sides + 1> spokes; // the last is the first again, bit for bit, so that the prism is watertight
    for (int i = 0; i < sides; i++) {
        const float angle = glm::radians(360.f / sides) * float(i);
        spokes[size_t(i)] = across * std::cos(angle) + upward * std::sin(angle);
    }
    spokes[sides] = spokes[0];
    const auto corner = [&](int side, float v, vec3 normal) {
        return Corner { (v > 0 ? end : start) + spokes[size_t(side)] * (diameter / 2), { float(side) / sides, v },
            encode_octahedral(normal) };
    };
    for (int i = 0; i < sides; i++) {
        const vec3 a = spokes[size_t(i)], b = spokes[size_t(i) + 1];
        append_quad({ corner(i, 0, a), corner(i + 1, 0, b), corner(i + 1, 1, b), corner(i, 1, a) }, material, out);
    }
    for (int i = 1; i + 1 < sides; i++) {
        append_triangle(corner(0, 0, -along), corner(i + 1, 0, -along), corner(i, 0, -along), material, out);
        append_triangle(corner(0, 1, along), corner(i, 1, along), corner(i + 1, 1, along), material, out);
    }
}

float particle_width(float distance)
{
    // A point of 40 * 10 / distance pixels in a view 480 high whose focal length is 320 pixels covers 1.25 units. The
    // original renderer keeps that size up to 20 units and then lets it grow by 0.4 % a unit.
    return distance < 20 ? 1.25f : 1.25f * (1 + 0.004f * distance);
}

void append_particle(
    vec3 origin, vec3 eye, const Axes& camera, uint32_t material, std::vector<Triangle>& out, float size)
{
    if (!is_sane(origin) || !is_sane(eye) || !is_sane(camera) || !(size > 0))
        return;
    const float half = size * particle_width(glm::dot(origin - eye, camera.forward)) / 2;
    append_billboard(origin, { -half, half, -half, half }, camera, material, out);
}

void append_null_model(const Transform& transform, uint32_t material, std::vector<Triangle>& out)
{
    append_octahedron(transform, 16, material, out);
}

void append_octahedron(const Transform& transform, float radius, uint32_t material, std::vector<Triangle>& out)
{
    if (!is_sane(transform))
        return;
    for (int octant = 0; octant < 8; octant++) {
        const vec3 sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
        const uint32_t normal = encode_octahedral(transform.direction(glm::normalize(sign)));
        const Corner x { transform.point({ sign.x * radius, 0, 0 }), { 0, 0 }, normal };
        const Corner y { transform.point({ 0, sign.y * radius, 0 }), { 1, 0 }, normal };
        const Corner z { transform.point({ 0, 0, sign.z * radius }), { 0, 1 }, normal };
        const bool even = sign.x * sign.y * sign.z > 0; // each reflection turns the corners' order around
        append_triangle(x, even ? y : z, even ? z : y, material, out);
    }
}

} // namespace vkpt

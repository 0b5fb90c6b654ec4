// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/camera.hpp"

#include "ref_vkpt/scene/entity_geometry.hpp"
#include "ref_vkpt/scene/projection.hpp"

#include <algorithm>
#include <cstring>
#include <glm/common.hpp>
#include <numbers>

namespace vkpt {

namespace {

// Half the image's width and height on the projection's plane, whose units are pixels' sides in either direction but
// where the engine says otherwise, and where the image is the whole sphere.
glm::vec2 half_extent(const engine::RefDef& refdef, const Projection& projection)
{
    constexpr float pi = std::numbers::pi_v<float>;
    if (projection.kind == shared::PROJECTION_EQUIRECTANGULAR)
        return { pi, pi / 2 };
    const float fov = projection.fov > 0 ? projection.fov : refdef.fov_x;
    const float width = plane_half_width(projection.kind, fov);
    if (projection.kind == shared::PROJECTION_PERSPECTIVE && projection.fov == 0)
        return { width, plane_half_width(projection.kind, refdef.fov_y) };
    return { width, width * float(refdef.height) / float(std::max(refdef.width, 1)) };
}

} // namespace

bool is_same(const Viewpoint& a, const Viewpoint& b)
{
    // Plain floats without padding.
    static_assert(sizeof(shared::Camera) == 12 * sizeof(float));
    return std::memcmp(&a.camera, &b.camera, sizeof(shared::Camera)) == 0 && a.origin == b.origin && a.size == b.size
        && a.blend == b.blend && a.underwater == b.underwater && a.projection == b.projection;
}

Viewpoint make_viewpoint(const engine::RefDef& refdef, VkExtent2D image, const Projection& projection)
{
    Viewpoint view;
    const glm::vec2 extent = half_extent(refdef, projection);
    const Axes axes = angle_vectors(to_vec3(refdef.view_angles));
    view.camera.eye = to_vec3(refdef.view_origin);
    view.camera.forward = axes.forward;
    view.camera.right = axes.right * extent.x;
    view.camera.up = axes.up * extent.y;
    view.projection = projection.kind;
    const glm::ivec2 limit(image.width, image.height);
    view.origin = glm::clamp(glm::ivec2(refdef.x, refdef.y), glm::ivec2(0), limit - 1);
    view.size = glm::clamp(glm::ivec2(refdef.width, refdef.height), glm::ivec2(1), limit - view.origin);
    view.blend = { refdef.blend[0], refdef.blend[1], refdef.blend[2], std::clamp(refdef.blend[3], 0.0f, 1.0f) };
    view.underwater = (refdef.flags & engine::RDF_UNDERWATER) != 0;
    return view;
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/camera.hpp"

#include "ref_vkpt/scene/entity_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

namespace vkpt {

namespace {

glm::vec3 to_vec3(const float v[3]) { return { v[0], v[1], v[2] }; }

float tangent_of_half(float degrees) { return std::tan(glm::radians(std::clamp(degrees, 1.0f, 179.0f)) / 2); }

} // namespace

bool is_same(const Viewpoint& a, const Viewpoint& b)
{
    // Plain floats without padding.
    static_assert(sizeof(shared::Camera) == 12 * sizeof(float));
    return std::memcmp(&a.camera, &b.camera, sizeof(shared::Camera)) == 0 && a.origin == b.origin && a.size == b.size
        && a.blend == b.blend && a.underwater == b.underwater;
}

Viewpoint make_viewpoint(const engine::RefDef& refdef, VkExtent2D image)
{
    Viewpoint view;
    const Axes axes = angle_vectors(to_vec3(refdef.view_angles));
    view.camera.eye = to_vec3(refdef.view_origin);
    view.camera.forward = axes.forward;
    view.camera.right = axes.right * tangent_of_half(refdef.fov_x);
    view.camera.up = axes.up * tangent_of_half(refdef.fov_y);
    const glm::ivec2 limit(image.width, image.height);
    view.origin = glm::clamp(glm::ivec2(refdef.x, refdef.y), glm::ivec2(0), limit - 1);
    view.size = glm::clamp(glm::ivec2(refdef.width, refdef.height), glm::ivec2(1), limit - view.origin);
    view.blend = { refdef.blend[0], refdef.blend[1], refdef.blend[2], std::clamp(refdef.blend[3], 0.0f, 1.0f) };
    view.underwater = (refdef.flags & engine::RDF_UNDERWATER) != 0;
    return view;
}

} // namespace vkpt

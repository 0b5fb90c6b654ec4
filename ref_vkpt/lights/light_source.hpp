// SPDX-License-Identifier: GPL-2.0-or-later
// An emitter as what is prepared ahead sees it: as a disc, or as a sphere that looks like one from everywhere. A spot
// that sends nothing sideways is a disc that faces along its axis.
#pragma once

#include "common/colour.hpp"
#include "ref_vkpt/lights/spot_cone.hpp"
#include "shaders/shared/scene.h"

#include <cmath>
#include <numbers>

namespace vkpt {

struct LightSource {
    glm::vec3 centre, normal; // unit; normal 0: a sphere
    float area; // that is seen from its front
    float power; // luminance, lightstyle at 1, times area; of a spot times the root of the share that it lights
};

inline LightSource make_light_source(const shared::Emitter& e)
{
    if (is_sphere(e)) {
        const float disc = std::numbers::pi_v<float> * e.p1.x * e.p1.x;
        const bool is_forward = has_cone(e) && outer_cosine(e) > 0;
        // A spot lights a part of what is in front of it, or around. A choice that does not know which part has the
        // least variance with the root of the mean square of the light.
        const float lit = has_cone(e) ? (1 - outer_cosine(e)) / (is_forward ? 1 : 2) : 1;
        return { e.p0, is_forward ? e.p2 : glm::vec3(0), disc, luminance(e.radiance) * disc * std::sqrt(lit) };
    }
    const glm::vec3 across = glm::cross(e.p1 - e.p0, e.p2 - e.p0);
    const float size = glm::length(across), area = 0.5f * size;
    return { (e.p0 + e.p1 + e.p2) / 3.0f, size > 0 ? across / size : glm::vec3(0), area, luminance(e.radiance) * area };
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// How wide an image is on the plane of its projection (shaders/lib/projection.glsl), and what angles it may show.
#pragma once

#include "shaders/shared/cvars.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace vkpt {

// Degrees from left to right, at most.
inline float max_fov(int projection)
{
    switch (projection) {
    case shared::PROJECTION_PERSPECTIVE:
        return 179;
    case shared::PROJECTION_PANINI:
    case shared::PROJECTION_STEREOGRAPHIC:
        return 340;
    default:
        return 360;
    }
}

// Half of it, for an angle in degrees from left to right.
inline float plane_half_width(int projection, float fov)
{
    const float half = glm::radians(std::clamp(fov, 1.0f, max_fov(projection))) / 2;
    switch (projection) {
    case shared::PROJECTION_PERSPECTIVE:
        return std::tan(half);
    case shared::PROJECTION_PANINI:
    case shared::PROJECTION_STEREOGRAPHIC:
        return 2 * std::tan(half / 2);
    default:
        return half;
    }
}

// The other way round.
inline float fov_of_half_width(int projection, float width)
{
    switch (projection) {
    case shared::PROJECTION_PERSPECTIVE:
        return glm::degrees(2 * std::atan(width));
    case shared::PROJECTION_PANINI:
    case shared::PROJECTION_STEREOGRAPHIC:
        return glm::degrees(4 * std::atan(width / 2));
    default:
        return glm::degrees(2 * width);
    }
}

} // namespace vkpt

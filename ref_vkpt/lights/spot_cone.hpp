// SPDX-License-Identifier: GPL-2.0-or-later
// The cone of a spot light, as an Emitter holds it (see CONE_SLACK in shaders/shared/scene.h).
#pragma once

#include "shaders/shared/scene.h"

namespace vkpt {

inline bool is_sphere(const shared::Emitter& e)
{
    return e.type == shared::EMITTER_SPHERE || e.type == shared::EMITTER_SUN;
}

// `axis`: unit. All light at `inner_cosine` and above, none at `outer_cosine`, which is smaller.
inline void set_cone(shared::Emitter& sphere, glm::vec3 axis, float inner_cosine, float outer_cosine)
{
    sphere.p1.y = 1 / (inner_cosine - outer_cosine);
    sphere.p1.z = inner_cosine;
    sphere.p2 = axis;
}

inline bool has_cone(const shared::Emitter& e) { return e.type == shared::EMITTER_SPHERE && e.p1.y > 0; }
inline float outer_cosine(const shared::Emitter& spot) { return spot.p1.z - 1 / spot.p1.y; }

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The lights of the game module (formats/light_code.hpp) as emitters.
#pragma once

#include "formats/light_code.hpp"
#include "ref_vkpt/scene/entity_geometry.hpp"

#include <vector>

namespace vkpt {

// `point_scale`: radiant intensity of a light of value 1 (EmissionScales::point). Radiance comes without lightstyle,
// which is 0, the steady one. Numbers that are not sane append nothing.
void append_placed_lights(formats::LightModel model, const formats::CodedLight& light, const Transform& transform,
    float time, float point_scale, std::vector<shared::Emitter>& out);

} // namespace vkpt

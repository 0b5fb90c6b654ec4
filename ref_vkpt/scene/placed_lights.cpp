// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/placed_lights.hpp"

#include <numbers>

namespace vkpt {

namespace {

// A light's sphere has to be clear of the marker, rod or shade that shows it.
shared::Emitter make_sphere(glm::vec3 centre, float radius, glm::vec3 intensity)
{
    constexpr float pi = std::numbers::pi_v<float>;
    shared::Emitter emitter {};
    emitter.type = shared::EMITTER_SPHERE;
    emitter.p0 = centre;
    emitter.p1.x = radius;
    emitter.area = 4 * pi * radius * radius;
    emitter.radiance = intensity / (pi * radius * radius);
    return emitter;
}

} // namespace

void append_placed_lights(formats::LightModel model, const formats::CodedLight& light, const Transform& transform,
    float time, float point_scale, std::vector<shared::Emitter>& out)
{
    if (!is_sane(transform))
        return;
    const float level = formats::light_level(light.style, light.phase, time);
    const glm::vec3 intensity = light.colour * (level * point_scale * light.value * light.value * light.value);
    if (intensity == glm::vec3(0))
        return;
    if (model == formats::LightModel::flare) {
        const glm::vec3 tip(formats::flare_tip, 0, 0);
        out.push_back(make_sphere(transform.point(tip), light.radius, intensity));
        return;
    }
    const uint32_t count = model == formats::LightModel::swarm ? light.count : 1;
    for (uint32_t i = 0; i < count; i++)
        out.push_back(make_sphere(transform.origin + formats::place_in_swarm(i, count, time), light.radius, intensity));
}

} // namespace vkpt

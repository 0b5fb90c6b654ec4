// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/air.hpp"

#include "common/colour.hpp"
#include "common/numbers.hpp"
#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/lights/media.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

namespace vkpt {

namespace {

void fill_filter_boxes(shared::SceneView& out, const SceneSnapshot& scene)
{
    std::vector<shared::FilterBox> boxes = scene.world->models[0].filter_boxes;
    for (const shared::FilterBox& box : scene.filter_boxes)
        add_filter_box(boxes, box);
    out.filter_box_count = uint32_t(boxes.size());
    constexpr shared::FilterBox nothing { glm::vec3(1e30f), glm::vec3(-1e30f) };
    std::ranges::fill(out.filter_boxes, nothing);
    std::ranges::copy(boxes, out.filter_boxes);
}

// Where the engine says that the eye is in a liquid.
uint32_t find_eye_medium(const formats::Bsp& bsp, glm::vec3 eye)
{
    const uint32_t medium = medium_at(bsp, eye);
    return medium != shared::MEDIUM_NONE ? medium : shared::MEDIUM_WATER;
}

// Of pt_fog_color; what is no colour is said once.
glm::vec3 read_fog_colour(const std::string& text)
{
    static std::string refused;
    if (const auto rgb = parse_numbers<float, 3>(text))
        return glm::max(glm::vec3((*rgb)[0], (*rgb)[1], (*rgb)[2]), glm::vec3(0));
    if (refused != text)
        engine::print(
            "ref_vkpt: pt_fog_color \"{}\" is not three numbers, such as \"0.5 0.55 0.6\": grey is taken", text);
    refused = text;
    return glm::vec3(0.5f);
}

// The sun that brings most light. False: there is none.
bool fill_sun(shared::SceneView& out, const SceneSnapshot& scene)
{
    float brightest = 0;
    for (const shared::Emitter& emitter : scene.emitters) {
        if (emitter.type != shared::EMITTER_SUN)
            continue;
        // A ball of radiance L whose half angle has the sine s sends the irradiance pi L s^2.
        const float sine = emitter.p1.x / shared::SUN_DISTANCE;
        const glm::vec3 irradiance
            = emitter.radiance * (std::numbers::pi_v<float> * sine * sine * scene.lightstyles[emitter.lightstyle]);
        if (luminance(irradiance) <= brightest)
            continue;
        brightest = luminance(irradiance);
        out.to_sun = glm::normalize(emitter.p0);
        out.sun_irradiance = irradiance;
    }
    return brightest > 0;
}

void fill_fog(shared::FrameUniforms& uniforms, const SceneSnapshot& scene)
{
    const std::vector<shared::FogBox>& boxes = scene.world->fog_boxes;
    if (boxes.empty() && uniforms.cvars.pt_fog <= 0)
        return;
    uniforms.flags |= shared::FRAME_FOG;
    uniforms.scene.fog_box_count = uint32_t(boxes.size());
    std::ranges::copy(boxes, uniforms.scene.fog_boxes);
    uniforms.scene.fog_radiance = read_fog_colour(cvars::values().pt_fog_color);
    if (uniforms.cvars.pt_god_rays > 0 && fill_sun(uniforms.scene, scene))
        uniforms.flags |= shared::FRAME_GOD_RAYS;
}

} // namespace

void fill_air(shared::FrameUniforms& uniforms, const SceneSnapshot& scene)
{
    if (!scene.world)
        return;
    fill_filter_boxes(uniforms.scene, scene);
    if (uniforms.flags & shared::FRAME_UNDERWATER)
        uniforms.scene.eye_medium = find_eye_medium(scene.world->bsp, uniforms.camera.eye);
    fill_fog(uniforms, scene);
}

} // namespace vkpt

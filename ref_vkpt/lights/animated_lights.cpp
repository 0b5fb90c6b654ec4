// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/animated_lights.hpp"

#include "common/colour.hpp"

namespace vkpt {

void AnimatedLights::add(const EmissionSource& source, size_t face, std::span<shared::Emitter> emitters)
{
    const uint32_t texinfo = source.bsp.faces[face].texinfo;
    if (emitters.empty() || source.bsp.texinfos[texinfo].next < 0)
        return;
    const auto [row, is_new]
        = rows_.try_emplace({ texinfo, emitters[0].lightstyle }, first_row_ + uint32_t(lights_.size()));
    if (is_new) {
        AnimatedLight& light = lights_.emplace_back();
        light.lightstyle = emitters[0].lightstyle;
        const float whole = luminance(face_radiance(source, texinfo));
        for_each_frame(source.bsp, texinfo,
            [&](uint32_t frame) { light.shares.push_back(luminance(frame_radiance(source, frame)) / whole); });
    }
    for (shared::Emitter& emitter : emitters)
        emitter.lightstyle = row->second;
}

void AnimatedLights::append_rows(std::vector<float>& lightstyles, float time) const
{
    for (const AnimatedLight& light : lights_)
        lightstyles.push_back(lightstyles[light.lightstyle] * light.share(animation_tick(time)));
}

} // namespace vkpt

#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// What the light sampler makes of one pixel's surface: for every light of its list the weight and the probability, and
// how often it is really picked. For people who look at samplers (Extension::inspect_pixel); no part of a frame.
#include "lib/frame.glsl"
#include "lib/light_choice.glsl"
#include "shared/probes.h"

layout(local_size_x = PIXEL_GROUP_SIZE) in;
VKPT_PUSH_CONSTANTS

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer InspectedSurfaceBuffer
{
    InspectedSurface v;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer InspectedLightBuffer { InspectedLight v[]; };

// The n-th of the choices that are averaged over, or counted, by `lane`.
LightRandom choice_random(uint n, uint lane)
{
    return light_random(make_random(uvec2(n & 0xffffu, lane), frame.frame_index, frame.seed), 0u);
}

void write_surface(PrimarySurface primary, uint light_count, uint choices)
{
    Surface s = primary.surface;
    InspectedSurfaceBuffer(push.surface).v
        = InspectedSurface(s.position, primary.depth, s.normal, s.roughness, s.geometric_normal, s.metallic, s.albedo,
            primary.cluster, unpack_floats3(load_emitted(push.pixel)), light_count, choices);
}

// All but `picked`, which every lane counts up.
void write_light(uint place, LightListView list, Surface s, LightOptions options)
{
    uint emitter = light_at(list, place);
    Emitter e = load_emitter(list, emitter);
    float sum = 0.0;
    ROLLED_FOR (uint n = 0u; n < push.draws; n++)
        sum += light_probability(list, s, emitter, choice_random(n, place), options);
    InspectedLightBuffer lights = InspectedLightBuffer(push.lights);
    lights.v[place].emitter = emitter;
    lights.v[place].type = e.type;
    lights.v[place].centre = is_sphere(e) ? e.p0 : (e.p0 + e.p1 + e.p2) / 3.0;
    lights.v[place].area = e.area;
    lights.v[place].radiance = e.radiance;
    lights.v[place].lightstyle = e.lightstyle;
    lights.v[place].weight = light_contribution(make_predictor(s, options), e);
    lights.v[place].probability = sum / float(push.draws);
}

void main()
{
    uint lane = gl_GlobalInvocationID.x, lanes = gl_NumWorkGroups.x * PIXEL_GROUP_SIZE;
    uint choices_per_lane = (push.choices + lanes - 1u) / lanes;
    PrimarySurface primary = load_primary_surface(push.pixel);
    bool has_surface = primary.depth >= 0.0;
    LightListView list = open_light_list(light_tables(), primary.cluster);
    uint count = has_surface ? light_count(list) : 0u;
    if (lane == 0u)
        write_surface(primary, count, has_surface ? choices_per_lane * lanes : 0u);
    if (!has_surface)
        return;
    LightOptions options = light_options();
    ROLLED_FOR (uint place = lane; place < min(count, push.capacity); place += lanes)
        write_light(place, list, primary.surface, options);
    ROLLED_FOR (uint n = 0u; n < choices_per_lane; n++) {
        LightSample choice = sample_light(list, primary.surface, choice_random(n, lane + 0x10000u), options);
        int place = choice.emitter < 0 ? -1 : find_light(list, uint(choice.emitter));
        if (place >= 0 && uint(place) < push.capacity)
            atomicAdd(InspectedLightBuffer(push.lights).v[place].picked, 1u);
    }
}

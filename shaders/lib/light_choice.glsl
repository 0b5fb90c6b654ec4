// SPDX-License-Identifier: GPL-2.0-or-later
// The light sampler that this pass was built with, and the settings that it is called with.
#ifndef VKPT_LIB_LIGHT_CHOICE
#define VKPT_LIB_LIGHT_CHOICE

#include "../shared/specialization.h"
#include "surfaces.glsl"
#include "emitters.glsl"
#include "random.glsl"
#ifdef VKPT_TRACE_SOFTWARE
#define VKPT_LANE_MEMORY lane_stack() // see light_subsets.glsl
#endif
#ifdef VKPT_ALWAYS_RIS // a pass that measures, whatever sampler the image is made with
#include "../light_samplers/ris.glsl"
#elif defined(VKPT_ALWAYS_SUBSET_PPS)
#include "../light_samplers/subset_pps.glsl"
#else
#include "selected_light_sampler.glsl"
#endif

const bool light_sampler_mis = (light_sampler_traits & SAMPLER_MIS) != 0u;

layout(constant_id = LIGHT_WEIGHT_CONSTANT) const int fixed_light_weight = NOT_FIXED;
layout(constant_id = LIGHT_POINT_CONSTANT) const int fixed_light_point = NOT_FIXED;

LightOptions light_options()
{
    int weight = fixed_light_weight == NOT_FIXED ? frame.cvars.pt_light_weight : fixed_light_weight;
    int point = fixed_light_point == NOT_FIXED ? frame.cvars.pt_light_point : fixed_light_point;
    return LightOptions(uint(frame.cvars.pt_light_subset), weight, point, LtcBuffer(frame.ltc), uvec4(0u));
}

#endif

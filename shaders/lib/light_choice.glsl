// SPDX-License-Identifier: GPL-2.0-or-later
// The light sampler that this pass was built with, and the settings that it is called with.
#ifndef VKPT_LIB_LIGHT_CHOICE
#define VKPT_LIB_LIGHT_CHOICE

#include "surfaces.glsl"
#include "emitters.glsl"
#include "random.glsl"
#ifdef VKPT_TRACE_SOFTWARE
#define VKPT_LANE_MEMORY lane_stack() // see light_subsets.glsl
#endif
#ifdef VKPT_ALWAYS_RIS // a pass that measures, whatever sampler the picture is made with
#include "../light_samplers/ris.glsl"
#elif defined(VKPT_ALWAYS_SUBSET_PPS)
#include "../light_samplers/subset_pps.glsl"
#else
#include "selected_light_sampler.glsl"
#endif

const bool light_sampler_mis = (light_sampler_traits & SAMPLER_MIS) != 0u;

LightOptions light_options()
{
    return LightOptions(uint(frame.cvars.pt_light_subset), frame.cvars.pt_light_weight, frame.cvars.pt_light_point,
        LtcBuffer(frame.ltc));
}

#endif

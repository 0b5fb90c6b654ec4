// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/frame_flags.hpp"

#include "ref_vkpt/cvars.hpp"
#include "shaders/shared/frame.h"

namespace vkpt {

uint32_t filter_flags()
{
    using namespace shared;
    const int denoiser = cvars::shader_values().flt_denoiser;
    const bool all_classic = cvars::shader_values().pt_wipe >= 1; // nothing is lit that could be filtered
    uint32_t flags = cvars::values().flt_taa != "off" ? FRAME_ANTIALIASED : 0;
    if (all_classic)
        return flags != 0 ? flags | FRAME_REPROJECTED : 0;
    if (denoiser != DENOISER_OFF)
        flags |= FRAME_DENOISED;
    if (denoiser == DENOISER_SVGF || denoiser == DENOISER_ASVGF)
        flags |= FRAME_SPATIAL;
    if (denoiser == DENOISER_ASVGF)
        flags |= FRAME_REPLAYED;
    return flags != 0 ? flags | FRAME_REPROJECTED : 0;
}

uint32_t possible_flags()
{
    using namespace shared;
    const uint32_t filters = filter_flags();
    return filters | (filters & FRAME_REPROJECTED ? FRAME_HISTORY | FRAME_LAYERED : 0)
        | (uses_light_cache() && (filters & FRAME_DENOISED || corrects_light_cache()) ? FRAME_LIGHT_CACHE : 0)
        | (filters & FRAME_DENOISED && cvars::values().pt_light_visibility != 0 ? FRAME_PUBLISH_VISIBILITY : 0)
        | (cvars::shader_values().pt_bloom > 0 ? FRAME_BLOOM : 0)
        | (cvars::shader_values().pt_wipe > 0 ? FRAME_WIPE : 0);
}

bool uses_light_cache()
{
    return cvars::shader_values().pt_indirect != shared::INDIRECT_TRACE && cvars::values().pt_bounces > 0;
}

bool corrects_light_cache() { return cvars::shader_values().pt_indirect == shared::INDIRECT_BOTH; }

} // namespace vkpt

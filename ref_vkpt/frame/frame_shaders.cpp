// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/frame_shaders.hpp"

#include "ref_vkpt/cvars.hpp"

#include <fmt/format.h>

namespace vkpt {

std::string traced_shader(std::string_view pass, TraceBackend backend)
{
    return fmt::format("{}.comp:{}", pass, name_of(backend));
}

std::string lit_shader(std::string_view pass, TraceBackend backend)
{
    return fmt::format("{}.comp:{}:{}", pass, cvars::values().pt_light_sampler, name_of(backend));
}

std::vector<std::string> frame_shaders(TraceBackend backend)
{
    const CvarValues& cvars = cvars::values();
    const shared::ShaderCvars filters = cvars::shader_values();
    std::vector<std::string> shaders;
    if (backend != TraceBackend::pipeline)
        shaders = { lit_shader("indirect_light", backend), lit_shader("direct_light", backend),
            traced_shader("light_level", backend), traced_shader("primary_visibility", backend) };
    const auto add = [&](std::initializer_list<const char*> passes) {
        for (const char* pass : passes)
            shaders.push_back(std::string(pass) + ".comp");
    };
    if (filters.flt_denoiser == shared::DENOISER_SVGF || filters.flt_denoiser == shared::DENOISER_ASVGF)
        add({ "denoise_filter", "denoise_spread_first", "denoise_spread" });
    if (filters.flt_denoiser != shared::DENOISER_OFF)
        add({ "denoise_temporal" });
    if (filters.flt_denoiser == shared::DENOISER_ASVGF)
        add({ "denoise_gradient", "denoise_gradient_filter", "replay_samples" });
    if (cvars.flt_taa != "off" || filters.flt_denoiser != shared::DENOISER_OFF)
        add({ "blend_layers" });
    if (cvars.flt_taa != "off")
        add({ "temporal_antialiasing" });
    add({ "accumulate", "exposure", "tone_map", "draw_quads" });
    if (filters.pt_bloom > 0)
        add({ "bloom_shrink", "bloom_grow" });
    return shaders;
}

} // namespace vkpt

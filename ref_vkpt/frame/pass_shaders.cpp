// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/pass_shaders.hpp"

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/frame/frame_flags.hpp"
#include "ref_vkpt/vulkan/shaders.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace vkpt {

namespace {

bool traces(const Pass& pass) { return pass.kind == PassKind::traced || pass.kind == PassKind::lit; }

} // namespace

std::string shader_of(const Pass& pass, const ShaderChoice& choice)
{
    const bool chooses = pass.kind == PassKind::lit || pass.kind == PassKind::choosing;
    return fmt::format("{}.comp{}{}{}{}", pass.name, chooses ? ":" : "",
        chooses ? std::string_view(choice.light_sampler) : "", traces(pass) ? ":" : "",
        traces(pass) ? name_of(choice.backend) : "");
}

bool is_ray_pipeline(const Pass& pass, const ShaderChoice& choice)
{
    return choice.backend == TraceBackend::pipeline && traces(pass);
}

std::vector<std::string> frame_shaders(TraceBackend backend)
{
    const ShaderChoice choice { backend, cvars::values().pt_light_sampler };
    const uint32_t flags = possible_flags();
    std::vector<std::string> shaders;
    for (const Pass& pass : pass_rows)
        if ((pass.is_run_with(flags) || pass.id == PassId::draw_quads) && !is_ray_pipeline(pass, choice))
            shaders.push_back(shader_of(pass, choice));
    // The time grows with the code.
    std::ranges::stable_sort(shaders, std::greater(), [](const std::string& name) { return find_shader(name).size(); });
    return shaders;
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The names of the passes' shaders (see find_shader): some were built once for each trace backend and light sampler.
#pragma once

#include "ref_vkpt/frame/pass_rows.hpp"
#include "ref_vkpt/rays/backend.hpp"

#include <string>
#include <vector>

namespace vkpt {

// Which of a pass's builds.
struct ShaderChoice {
    TraceBackend backend = TraceBackend::software;
    std::string light_sampler;
};

std::string shader_of(const Pass& pass, const ShaderChoice& choice);
// Whether that is a ray generation shader.
bool is_ray_pipeline(const Pass& pass, const ShaderChoice& choice);

// The compute shaders of a world's frame with the present settings, those first that take longest to compile.
std::vector<std::string> frame_shaders(TraceBackend backend);

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The names of the passes' shaders (see find_shader): some were built once for each trace backend and light sampler.
#pragma once

#include "ref_vkpt/trace/backend.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

// Of a pass that traces rays.
std::string traced_shader(std::string_view pass, TraceBackend backend);
// Of a pass that also chooses lights, by pt_light_sampler.
std::string lit_shader(std::string_view pass, TraceBackend backend);

// The compute shaders of a world's frame with the present settings, those first that take longest to compile.
std::vector<std::string> frame_shaders(TraceBackend backend);

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The shaders that the build compiled and embedded.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace vkpt {

// SPIR-V; empty: no such shader. Names: "tone_map.comp"; where a light sampler is part of a pass: "direct_light.comp:subset".
std::span<const uint32_t> find_shader(std::string_view name);
// The light samplers that the build found, sorted.
std::span<const std::string_view> light_sampler_names();

} // namespace vkpt

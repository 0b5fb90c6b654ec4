// SPDX-License-Identifier: GPL-2.0-or-later
// The shaders that the build compiled and embedded.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace vkpt {

// SPIR-V; empty: no such shader. Names: "tone_map.comp"; where a light sampler is part of a pass:
// "direct_light.comp:subset".
std::span<const uint32_t> find_shader(std::string_view name);
// How the build compiled it; all empty: no such shader.
struct ShaderBuild {
    std::string_view file; // in shaders/
    std::string_view light_sampler; // "": the pass does not depend on it
    std::string_view options; // of glslangValidator, with spaces between
};
ShaderBuild find_shader_build(std::string_view name);
// Of spirv-opt, which goes over every shader after that, with spaces between.
extern const std::string_view shader_optimizations;

// The light samplers that the build found, sorted.
struct LightSampler {
    const char* name;
    uint32_t traits; // SAMPLER_* of shaders/shared/light_sampler.h
};
std::span<const LightSampler> light_samplers();
// nullptr: there is none of that name.
const LightSampler* find_light_sampler(std::string_view name);

} // namespace vkpt

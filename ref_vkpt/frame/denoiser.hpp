// SPDX-License-Identifier: GPL-2.0-or-later
// The denoiser's passes: how often each is run, over what, and what it is told. docs/denoiser.md explains them.
#pragma once

#include "ref_vkpt/frame/pass_recorder.hpp"

namespace vkpt {

// Pixels that share a bounce ray, where the denoiser filters them.
glm::uvec2 choose_bounce_block(const Device& device);
PassWork stratum_work(const shared::FrameUniforms& uniforms);
std::vector<PassStep> gradient_filter_steps(const shared::FrameUniforms& uniforms);
// The spatial filter's levels: the first one's result is what the next view accumulates on, and the last is part of
// `accumulate`.
std::vector<PassStep> spread_first_steps(const shared::FrameUniforms& uniforms);
std::vector<PassStep> spread_steps(const shared::FrameUniforms& uniforms);
std::vector<PassStep> accumulate_steps(const shared::FrameUniforms& uniforms);

} // namespace vkpt

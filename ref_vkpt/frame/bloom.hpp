// SPDX-License-Identifier: GPL-2.0-or-later
// Bloom: light that the eye scatters around bright things, as a pyramid of averages of the image.
#pragma once

#include "ref_vkpt/frame/pass_recorder.hpp"

namespace vkpt {

// Leaves bloom out where the settings have none, or the image is too small.
void begin_bloom(shared::FrameUniforms& uniforms);
std::vector<PassStep> bloom_shrink_steps(const shared::FrameUniforms& uniforms);
std::vector<PassStep> bloom_grow_steps(const shared::FrameUniforms& uniforms);

} // namespace vkpt

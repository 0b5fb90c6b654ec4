// SPDX-License-Identifier: GPL-2.0-or-later
// What fills the space between things: liquids and glass that colour light, and fog.
#pragma once

#include "ref_vkpt/scene/snapshot.hpp"

namespace vkpt {

// Fills the scene's filter boxes, fog and sun, the medium that the eye is in, and the flags that go with them.
void fill_air(shared::FrameUniforms& uniforms, const SceneSnapshot& scene);

} // namespace vkpt

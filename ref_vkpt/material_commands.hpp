// SPDX-License-Identifier: GPL-2.0-or-later
// The console command `mat`: what is under the crosshair is made of, and changing it.
#pragma once

#include "ref_vkpt/scene/world.hpp"

#include <cstdint>
#include <optional>

namespace vkpt {

struct Module;

// `mat`, `mat ATTRIBUTE VALUE`, `mat reset`, `mat save`.
void run_material_command(Module& module);

// The texinfo of the world's face that the ray meets first.
std::optional<uint32_t> find_texinfo(const World& world, glm::vec3 origin, glm::vec3 direction);

} // namespace vkpt

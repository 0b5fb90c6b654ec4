// SPDX-License-Identifier: GPL-2.0-or-later
// A refdef's entities, particles and dynamic lights as triangles, materials and emitters of a snapshot.
#pragma once

#include "ref_vkpt/engine/contract.hpp"
#include "ref_vkpt/scene/snapshot.hpp"
#include "ref_vkpt/scene/textures.hpp"

#include <span>

namespace vkpt {

// `snapshot` holds the world's materials already (none without a world). Handles in `refdef` are of this map, or
// nullptr. `player_body`: entities beside the refdef's.
void add_entities(SceneSnapshot& snapshot, const engine::RefDef& refdef, std::span<const engine::Entity> player_body,
    const TextureStore& textures, const MaterialDefaults& defaults, SkinLampCache& skin_lamps);

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// Gives each dynamic emitter a slot that it keeps while it lives, though the engine tells of lights without names and
// in any order.
#pragma once

#include "shaders/shared/scene.h"

#include <cstdint>
#include <vector>

namespace vkpt {

class DynamicLights {
public:
    // Orders this frame's emitters by slot, empty slots filled with dark emitters, and returns the slot of each as
    // given. An emitter is last frame's if it is of the same kind and the nearest such one, at most `farthest_move`
    // away: spheres of one lightstyle, triangles of one radiance (areas change with a model's frames). (Hundreds that
    // are alike and move at once are told apart by their order instead.)
    std::vector<uint32_t> arrange(std::vector<shared::Emitter>& emitters);
    // Per slot of the last arrange(): whether the light lived in the frame before.
    const std::vector<bool>& lived_before() const { return lived_before_; }

    static constexpr float farthest_move = 160; // units in a frame

private:
    std::vector<shared::Emitter> last_; // by slot
    std::vector<bool> used_, lived_before_;
};

// An empty slot's emitter: lists leave it out.
inline bool is_dark(const shared::Emitter& emitter) { return emitter.radiance == glm::vec3(0); }

} // namespace vkpt

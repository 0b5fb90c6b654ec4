// SPDX-License-Identifier: GPL-2.0-or-later
// A refdef that outlives the engine's call: all that it points to is copied.
#pragma once

#include "ref_vkpt/engine/contract.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace vkpt {

class KeptRefDef {
public:
    explicit KeptRefDef(const engine::RefDef& from);
    KeptRefDef(const KeptRefDef&) = delete;
    KeptRefDef& operator=(const KeptRefDef&) = delete;

    const engine::RefDef& refdef() const { return refdef_; }
    // What another camera sees of it: without the weapon before the eye, and with what only mirrors show to the player.
    const std::vector<engine::Entity>& seen_from_outside() const { return seen_from_outside_; }

private:
    engine::RefDef refdef_;
    std::vector<engine::Entity> entities_, seen_from_outside_;
    std::vector<engine::DynamicLight> dlights_;
    std::vector<engine::Particle> particles_;
    std::array<engine::Lightstyle, engine::max_lightstyles> lightstyles_ {};
};

} // namespace vkpt

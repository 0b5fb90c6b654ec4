// SPDX-License-Identifier: GPL-2.0-or-later
// The player's own body, which the engine's client leaves out of what it sends: seen in mirrors, shadows and bounced
// light.
#pragma once

#include "ref_vkpt/engine/contract.hpp"

#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace vkpt {

struct Texture;
struct World;

// What the engine has registered; nullptr: not that.
struct RegisteredBody {
    std::function<void*(const std::string& path)> model;
    std::function<void*(const std::string& path)> skin;
};

class PlayerBody {
public:
    // The body and the weapon in its hands, as entities with RF_VIEWERMODEL. Empty where the view shows no weapon: then
    // it is a spectator's, a dead player's or an intermission's. `skin`: "male/grunt", as the engine's cvar has it.
    std::vector<engine::Entity> stand(
        const engine::RefDef& refdef, const World& world, const std::string& skin, const RegisteredBody& registered);

private:
    struct Frames {
        int now = 0, before = 0;
    };
    void animate(const engine::RefDef& refdef, const World& world, const engine::Entity& weapon);

    // Models have ten frames a second, as the server has.
    int tick_ = -1;
    float tick_time_ = 0;
    glm::vec3 tick_eye_ { 0 };
    int step_ = 0; // of the sequence
    bool is_crouched_ = false;
    Frames frames_;
};

} // namespace vkpt

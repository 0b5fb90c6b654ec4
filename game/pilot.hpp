// SPDX-License-Identifier: GPL-2.0-or-later
// A player's hands: follows a path of navigation's nodes with the inputs that a human has.
#pragma once

#include "game/navigation.hpp"

#include <cstdint>
#include <vector>

namespace vkpt::game {

// What is to be known of the player at each moment.
struct PlayerView {
    glm::vec3 origin { 0 }, velocity { 0 };
    bool on_ground = false, in_water = false;
};

// What the player does next. `move` and `climb` in -1..1 of full speed, in world space.
struct Inputs {
    glm::vec3 move { 0 };
    float climb = 0; // > 0: jump, or swim up
    glm::vec3 angles { 0 };
    bool attack = false;
};

class Pilot {
public:
    // Angles to begin with.
    void reset(glm::vec3 angles);
    void follow(uint32_t from, std::vector<uint32_t> path);
    void drop_path() { path_.clear(); }
    bool has_path() const { return !path_.empty(); }
    uint32_t target() const { return path_.empty() ? Navigation::none : path_.front(); }
    uint32_t goal() const { return path_.empty() ? Navigation::none : path_.back(); }
    // The node last passed.
    uint32_t behind() const { return behind_; }
    // Where to look; by itself it looks where it goes.
    void look(glm::vec3 angles) { angles_ = angles; }

    // The inputs of the next `seconds`.
    Inputs steer(const Navigation& navigation, const PlayerView& player, float seconds);

private:
    void pass_nodes(const Navigation& navigation, const PlayerView& player);
    glm::vec3 look_ahead(const Navigation& navigation, const PlayerView& player) const;
    void turn_towards(glm::vec3 direction, float seconds);

    std::vector<uint32_t> path_; // from the next node on
    uint32_t behind_ = Navigation::none;
    glm::vec3 angles_ { 0 };
    bool jumped_ = false; // on the present edge
};

// Whole turns off, -180..180.
float wrap_degrees(float degrees);

} // namespace vkpt::game

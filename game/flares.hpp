// SPDX-License-Identifier: GPL-2.0-or-later
// The flare gun: burning flares that bounce, roll, sputter, smoke and die.
#pragma once

#include "game/host.hpp"
#include "game/random.hpp"

#include <vector>

namespace vkpt::game {

class Flares {
public:
    explicit Flares(Host& host)
        : host_(host)
        , random_(0)
    {
    }

    // The command `flare`: throws one from the player's eye.
    void run(const Command& command);
    void begin_level();
    // Once a server frame.
    void update();

private:
    struct Flare {
        int entity;
        glm::vec3 origin, velocity, angles, spin; // degrees, degrees a second
        float age = 0; // seconds
        bool rests = false;
    };
    void move(Flare& flare, float seconds);
    static bool turn_at(Flare& flare, glm::vec3 normal);
    static void roll(Flare& flare, float seconds);
    bool has_ground(const Flare& flare) const;
    void show(const Flare& flare);
    void smoke(const Flare& flare);

    Host& host_;
    std::vector<Flare> flares_;
    int thrown_ = 0; // in this level
    Random random_;
};

} // namespace vkpt::game

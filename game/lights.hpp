// SPDX-License-Identifier: GPL-2.0-or-later
// The lights that operators place: the command `light`, and the entities that clients see.
#pragma once

#include "game/host.hpp"
#include "game/light_text.hpp"

#include <vector>

namespace vkpt::game {

class Lights {
public:
    explicit Lights(Host& host)
        : host_(host)
    {
    }

    void run(const Command& command);
    // A level begins: the lights of its file, if it has one.
    void begin_level();
    // Once a server frame, `viewer` being whoever drags a light.
    void update(const Edict* viewer);
    // With the game's saves: beside the level's file, which the engine names.
    void write_level(const std::string& file) const;
    void read_level(const std::string& file);

private:
    struct Placed {
        Light light;
        int entity = -1; // OwnEntities' handle
    };
    void add(const Command& command);
    void list(const Command& command) const;
    void save(const Command& command) const;
    void load(const Command& command);
    void grab(const Command& command);
    void undo(const Command& command);

    std::vector<Light> list_lights() const;
    // All lights anew; what was before is kept for undo().
    void replace(std::vector<Light> lights, bool with_undo = true);
    void remember();
    void show(Placed& placed);
    // Which light the player looks at: the nearest to the ray by angle. Throws TextError if there is none.
    size_t find_aimed(const Command& command) const;
    std::string own_file(const std::string& level_file) const;
    TextFiles files() const;

    Host& host_;
    std::vector<Placed> placed_;
    std::vector<std::vector<Light>> history_;
    bool is_editing_ = false;
    int grabbed_ = -1; // index in placed_
    float grab_distance_ = 0;
};

} // namespace vkpt::game

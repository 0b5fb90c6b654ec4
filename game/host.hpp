// SPDX-License-Identifier: GPL-2.0-or-later
// What the parts of this module share: the server's functions, the game's table, and what goes with them.
#pragma once

#include "game/contract.hpp"
#include "game/files.hpp"
#include "game/own_entities.hpp"
#include "game/replies.hpp"

#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt::game {

struct Box {
    glm::vec3 mins { 0 }, maxs { 0 };
};

struct Host {
    Imports engine {}; // as the server gave them
    Exports* game = nullptr; // the real game's
    OwnEntities entities;
    Replies replies;
    int frame = 0; // server frames since the level began
    std::string map; // its name, without folder and ending
    std::filesystem::path write_folder; // empty: the engine's was not found

    Edict* edict(int number) const { return edict_at(*game, number); }
    int number_of(const Edict* edict) const
    {
        return int(
            (reinterpret_cast<const char*>(edict) - reinterpret_cast<const char*>(game->edicts)) / game->edict_size);
    }
    int client_count() const { return int(cvar_number("maxclients", "1")); }
    float cvar_number(const char* name, const char* value) const { return engine.cvar(name, value, 0)->number; }

    // To one player, or with nullptr to the server's console. Ends the line.
    void say(Edict* player, std::string_view text);
    Trace trace(glm::vec3 from, glm::vec3 to, const Box& box, const Edict* ignored, int mask) const;
    int contents(glm::vec3 p) const { return engine.point_contents(&p.x); }
};

inline glm::vec3 to_vec3(const float v[3]) { return { v[0], v[1], v[2] }; }
inline void put(glm::vec3 v, float out[3])
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

// Where a player looks from and to.
struct Eye {
    glm::vec3 origin, angles, forward;
};
Eye eye_of(const Edict& player);
glm::vec3 forward_of(glm::vec3 angles);
inline constexpr float frame_seconds = 0.1f;

// A command that an operator has typed.
struct Command {
    std::vector<std::string> words; // without the command's own name
    Edict* sender; // nullptr: the server's console
    Edict* player; // whose view counts: the sender, else the first player; nullptr: nobody plays
    std::string word(size_t i) const { return i < words.size() ? words[i] : std::string(); }
};

} // namespace vkpt::game

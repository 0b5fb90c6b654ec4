// SPDX-License-Identifier: GPL-2.0-or-later
// Entities of this module in the game's array. They are there only while the server looks: before each call into the
// game their slots become as the game left them, so it never meets one, and may use every slot itself.
#pragma once

#include "game/contract.hpp"

#include <cstdint>
#include <vector>

namespace vkpt::game {

// The game's array of entities, through its table.
inline Edict* edict_at(const Exports& game, int number)
{
    return reinterpret_cast<Edict*>(reinterpret_cast<char*>(game.edicts) + size_t(number) * size_t(game.edict_size));
}

class OwnEntities {
public:
    static constexpr int most = 256;
    // New ones that one message may show: a message of more would not fit what the protocol sends at once.
    static constexpr int max_new_per_frame = 12;

    // A handle, or -1: there are too many.
    int add();
    void remove(int handle);
    void clear();
    // What clients will see; the number is filled in. Call `touch` when the place has changed.
    EntityState& state(int handle) { return entries_[size_t(handle)].edict.state; }
    // `reach`: clients that see any of a box of so many units to all sides are told of it.
    void touch(int handle, float reach);

    // Before and after each call into the game. `show` copies the entities into the highest slots that the game does
    // not use, and returns how many slots the server has to look at.
    void hide(const Exports& game);
    int show(const Exports& game, const Imports& engine);
    // What was shown so far has been sent.
    void begin_frame() { new_ones_ = 0; }
    // Entities that found no slot at the last show().
    int without_slot() const { return without_slot_; }

private:
    struct Entry {
        Edict edict {};
        bool in_use = false, is_new = false, moved = false;
        int slot = -1; // where it is shown now
    };
    void place(Entry& entry, int slot, const Exports& game, const Imports& engine);

    std::vector<Entry> entries_;
    int new_ones_ = 0, without_slot_ = 0;
};

} // namespace vkpt::game

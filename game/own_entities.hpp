// SPDX-License-Identifier: GPL-2.0-or-later
// Entities of this module in the game's array. They are there only while the server looks: before each call into the
// game their slots become as the game left them, so it never meets one, and may use every slot itself.
#pragma once

#include "game/contract.hpp"

#include <cstdint>
#include <deque>
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
    // So many take another slot in each frame, and are sent as new ones. Where a client asks for everything at once, as
    // when it begins to record a demo, the server leaves out what does not fit and later believes that it was sent: so
    // all are sent again within seconds.
    static constexpr int renewed_per_frame = 3;
    static constexpr int spare_places = 24; // a slot rests for some frames: clients would blend what was in it

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
    void begin_frame();
    // Entities that found no slot at the last show().
    int without_slot() const { return without_slot_; }

private:
    struct Entry {
        Edict edict {};
        bool in_use = false, is_new = false, moved = false;
        int slot = -1; // where it is shown now
        int place = -1; // its slot, counted from the top of the array
    };
    void place(Entry& entry, int slot, const Exports& game, const Imports& engine);
    void renew(Entry& entry);

    std::vector<Entry> entries_;
    std::deque<int> free_places_; // the longest unused first
    int place_count_ = 0; // free or taken
    size_t next_renewed_ = 0;
    int new_ones_ = 0, without_slot_ = 0;
};

} // namespace vkpt::game

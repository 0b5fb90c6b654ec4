// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/own_entities.hpp"

#include <algorithm>
#include <cstring>

namespace vkpt::game {

int OwnEntities::add()
{
    size_t handle = 0;
    while (handle < entries_.size() && entries_[handle].in_use)
        handle++;
    if (handle == most)
        return -1;
    if (handle == entries_.size())
        entries_.emplace_back();
    entries_[handle] = {};
    entries_[handle].in_use = entries_[handle].is_new = true;
    return int(handle);
}

void OwnEntities::remove(int handle)
{
    // Its slot is as the game left it: entities change only while they are hidden.
    entries_[size_t(handle)] = {};
}

void OwnEntities::clear() { entries_.clear(); }

void OwnEntities::touch(int handle, float reach)
{
    Entry& entry = entries_[size_t(handle)];
    entry.moved = true;
    std::fill_n(entry.edict.mins, 3, -reach);
    std::fill_n(entry.edict.maxs, 3, reach);
}

void OwnEntities::hide(const Exports& game)
{
    for (Entry& entry : entries_) {
        if (entry.slot < 0)
            continue;
        Edict* slot = edict_at(game, entry.slot);
        entry.edict = *slot; // the server has noted where it is
        std::memset(static_cast<void*>(slot), 0, sizeof *slot);
        entry.slot = -1;
    }
}

void OwnEntities::place(Entry& entry, int slot, const Exports& game, const Imports& engine)
{
    Edict* edict = edict_at(game, slot);
    entry.edict.state.number = slot;
    entry.edict.in_use = 1;
    entry.edict.solid = SOLID_NOT;
    *edict = entry.edict;
    entry.slot = slot;
    if (entry.moved)
        engine.link_entity(edict);
    entry.moved = entry.is_new = false;
}

int OwnEntities::show(const Exports& game, const Imports& engine)
{
    int end = game.edict_count;
    without_slot_ = 0;
    const int last_slot = std::min(game.max_edicts, max_edicts) - 1;
    for (size_t i = 0; i < entries_.size(); i++) {
        Entry& entry = entries_[i];
        if (!entry.in_use)
            continue;
        const int slot = last_slot - int(i);
        if (slot < game.edict_count) {
            without_slot_++;
            continue;
        }
        if (entry.is_new && new_ones_ >= max_new_per_frame)
            continue;
        new_ones_ += entry.is_new;
        place(entry, slot, game, engine);
        end = std::max(end, slot + 1);
    }
    return end;
}

} // namespace vkpt::game

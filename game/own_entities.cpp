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
    while (free_places_.size() <= spare_places)
        free_places_.push_back(place_count_++);
    std::ranges::sort(free_places_);
    entries_[handle].place = free_places_.front();
    free_places_.pop_front();
    return int(handle);
}

void OwnEntities::remove(int handle)
{
    // Its slot is as the game left it: entities change only while they are hidden.
    free_places_.push_back(entries_[size_t(handle)].place);
    entries_[size_t(handle)] = {};
}

void OwnEntities::clear()
{
    entries_.clear();
    free_places_.clear();
    place_count_ = 0;
    next_renewed_ = 0;
}

void OwnEntities::begin_frame()
{
    new_ones_ = 0;
    if (std::ranges::any_of(entries_, [](const Entry& entry) { return entry.in_use && entry.is_new; }))
        return; // they come first
    for (int i = 0; i < renewed_per_frame && size_t(i) < entries_.size(); i++) {
        Entry& entry = entries_[next_renewed_++ % entries_.size()];
        if (entry.in_use)
            renew(entry);
    }
}

void OwnEntities::renew(Entry& entry)
{
    free_places_.push_back(entry.place);
    entry.place = free_places_.front();
    free_places_.pop_front();
    entry.moved = true; // to be linked there
}

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
    for (Entry& entry : entries_) {
        if (!entry.in_use)
            continue;
        const int slot = last_slot - entry.place;
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

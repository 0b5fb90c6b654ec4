// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/photo/kept_refdef.hpp"

#include <algorithm>

namespace vkpt {

namespace {

template <class Item> std::vector<Item> copy_items(const Item* items, int32_t count, int32_t limit)
{
    return items ? std::vector<Item>(items, items + std::clamp(count, 0, limit)) : std::vector<Item>();
}

} // namespace

KeptRefDef::KeptRefDef(const engine::RefDef& from)
    : refdef_(from)
    , entities_(copy_items(from.entities, from.entity_count, engine::max_entities))
    , dlights_(copy_items(from.dlights, from.dlight_count, engine::max_dlights))
    , particles_(copy_items(from.particles, from.particle_count, engine::max_particles))
{
    for (engine::Entity entity : entities_)
        if (!(entity.flags & engine::RF_WEAPONMODEL)) {
            entity.flags &= ~engine::RF_VIEWERMODEL;
            seen_from_outside_.push_back(entity);
        }
    if (from.lightstyles)
        std::copy_n(from.lightstyles, lightstyles_.size(), lightstyles_.begin());
    refdef_.entities = entities_.data();
    refdef_.entity_count = int32_t(entities_.size());
    refdef_.dlights = dlights_.data();
    refdef_.dlight_count = int32_t(dlights_.size());
    refdef_.particles = particles_.data();
    refdef_.particle_count = int32_t(particles_.size());
    refdef_.lightstyles = from.lightstyles ? lightstyles_.data() : nullptr;
    refdef_.area_bits = nullptr; // the world is drawn whole
}

} // namespace vkpt

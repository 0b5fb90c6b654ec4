// SPDX-License-Identifier: GPL-2.0-or-later
#include "common/trace/view_copy.hpp"

#include <algorithm>

namespace vkpt::trace {

View copy_view(const engine::RefDef& from, const NumberOf& model, const NumberOf& skin)
{
    View view;
    view.refdef = from;
    const auto count = [](int32_t wanted, int limit) { return size_t(std::clamp(wanted, 0, limit)); };
    for (size_t i = 0; i < count(from.entity_count, engine::max_entities); i++) {
        const engine::Entity& entity = from.entities[i];
        view.entities.push_back({ entity, model(entity.model), skin(entity.skin) });
    }
    view.dlights.assign(from.dlights, from.dlights + count(from.dlight_count, engine::max_dlights));
    view.particles.assign(from.particles, from.particles + count(from.particle_count, engine::max_particles));
    view.has_lightstyles = from.lightstyles != nullptr;
    if (from.lightstyles)
        std::copy_n(from.lightstyles, engine::max_lightstyles, view.lightstyles.begin());
    view.has_area_bits = from.area_bits != nullptr;
    if (from.area_bits)
        std::copy_n(from.area_bits, max_area_bytes, view.area_bits.begin());
    return view;
}

std::vector<engine::Entity> entities_of(const View& view, const HandleOf& model, const HandleOf& skin)
{
    std::vector<engine::Entity> entities;
    for (const View::Entity& recorded : view.entities) {
        engine::Entity& entity = entities.emplace_back(recorded.entity);
        entity.model = model(recorded.model);
        entity.skin = skin(recorded.skin);
    }
    return entities;
}

engine::RefDef refdef_of(const View& view, const std::vector<engine::Entity>& entities)
{
    engine::RefDef refdef = view.refdef;
    refdef.area_bits = view.has_area_bits ? view.area_bits.data() : nullptr;
    refdef.lightstyles = view.has_lightstyles ? view.lightstyles.data() : nullptr;
    refdef.entity_count = int32_t(entities.size());
    refdef.entities = entities.data();
    refdef.dlight_count = int32_t(view.dlights.size());
    refdef.dlights = view.dlights.data();
    refdef.particle_count = int32_t(view.particles.size());
    refdef.particles = view.particles.data();
    return refdef;
}

} // namespace vkpt::trace

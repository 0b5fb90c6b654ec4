// SPDX-License-Identifier: GPL-2.0-or-later
#include "common/trace/blend_views.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace vkpt::trace {

namespace {

using Entity = View::Entity;

// In units between two views; what is farther apart is not one thing that moves.
constexpr float max_eye_way = 64, max_entity_way = 96, max_light_way = 128, max_particle_way = 32;
constexpr float max_seconds = 0.5f; // between two views of one course

float blend(float before, float after, float share) { return before + (after - before) * share; }

// The short way round.
float blend_angle(float before, float after, float share)
{
    return before + std::remainder(after - before, 360.0f) * share;
}

template <size_t count> void blend_all(float (&to)[count], const float (&after)[count], float share)
{
    for (size_t i = 0; i < count; i++)
        to[i] = blend(to[i], after[i], share);
}

void blend_angles(float (&to)[3], const float (&after)[3], float share)
{
    for (size_t i = 0; i < 3; i++)
        to[i] = blend_angle(to[i], after[i], share);
}

float distance(const float (&a)[3], const float (&b)[3])
{
    return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

bool is_cut(const engine::RefDef& before, const engine::RefDef& after)
{
    const float seconds = after.time - before.time;
    return !(seconds >= 0 && seconds <= max_seconds) || before.flags != after.flags
        || !(distance(before.view_origin, after.view_origin) <= max_eye_way);
}

// The nearest of those that look like it and that nothing else is: its place in `after`.
template <class Item, class IsAlike>
std::vector<std::optional<size_t>> match(
    const std::vector<Item>& before, const std::vector<Item>& after, float reach, IsAlike is_alike)
{
    std::vector<std::optional<size_t>> matches(before.size());
    std::vector<bool> taken(after.size());
    for (size_t i = 0; i < before.size(); i++) {
        float nearest = reach;
        for (size_t k = 0; k < after.size(); k++)
            if (const auto way = taken[k] ? std::nullopt : is_alike(before[i], after[k]); way && *way <= nearest) {
                nearest = *way;
                matches[i] = k;
            }
        if (matches[i])
            taken[*matches[i]] = true;
    }
    return matches;
}

// How far apart they are; nothing: they are not the same thing.
std::optional<float> entity_way(const Entity& a, const Entity& b)
{
    const bool is_alike = a.model == b.model && a.skin == b.skin && a.entity.flags == b.entity.flags
        && a.entity.skin_number == b.entity.skin_number;
    return is_alike ? std::optional(distance(a.entity.origin, b.entity.origin)) : std::nullopt;
}

// An animation goes from previous_frame to frame while backlerp falls from 1 to 0; then the next pair begins.
void blend_animation(engine::Entity& to, const engine::Entity& after, float share)
{
    if (to.frame == after.frame && to.previous_frame == after.previous_frame) {
        to.backlerp = blend(to.backlerp, after.backlerp, share);
    } else if (to.frame == after.previous_frame) {
        const float gone = share * (to.backlerp + 1 - after.backlerp);
        if (gone <= to.backlerp) {
            to.backlerp -= gone;
        } else {
            const float left = 1 - (gone - to.backlerp);
            to.previous_frame = after.previous_frame;
            to.frame = after.frame;
            to.backlerp = left;
        }
    } else if (share >= 0.5f) {
        to.frame = after.frame;
        to.previous_frame = after.previous_frame;
        to.backlerp = after.backlerp;
    }
}

// Where a model is shown: between its last two places.
void settle_origin(engine::Entity& entity)
{
    blend_all(entity.origin, entity.previous_origin, entity.backlerp);
    std::ranges::copy(entity.origin, entity.previous_origin);
}

void blend_entity(engine::Entity& to, engine::Entity after, float share)
{
    if (to.flags & engine::RF_BEAM) { // both of its ends
        blend_all(to.origin, after.origin, share);
        blend_all(to.previous_origin, after.previous_origin, share);
        return;
    }
    settle_origin(to);
    settle_origin(after);
    blend_animation(to, after, share);
    blend_all(to.origin, after.origin, share);
    std::ranges::copy(to.origin, to.previous_origin);
    blend_angles(to.angles, after.angles, share);
    to.alpha = blend(to.alpha, after.alpha, share);
}

// Blends what both have by `blend_item`, and adds what the nearer one alone has.
template <class Item, class BlendItem>
std::vector<Item> blend_lists(const std::vector<Item>& before, const std::vector<Item>& after,
    const std::vector<std::optional<size_t>>& matches, float share, BlendItem blend_item)
{
    std::vector<Item> result;
    std::vector<bool> taken(after.size());
    for (size_t i = 0; i < before.size(); i++) {
        if (!matches[i] && share >= 0.5f)
            continue;
        result.push_back(before[i]);
        if (matches[i]) {
            blend_item(result.back(), after[*matches[i]]);
            taken[*matches[i]] = true;
        }
    }
    for (size_t k = 0; k < after.size(); k++)
        if (!taken[k] && share >= 0.5f)
            result.push_back(after[k]);
    return result;
}

void blend_dlights(View& to, const View& before, const View& after, float share)
{
    const auto matches = match(before.dlights, after.dlights, max_light_way,
        [](const auto& a, const auto& b) { return std::optional(distance(a.origin, b.origin)); });
    to.dlights = blend_lists(
        before.dlights, after.dlights, matches, share, [&](engine::DynamicLight& light, const auto& next) {
            blend_all(light.origin, next.origin, share);
            blend_all(light.color, next.color, share);
            light.intensity = blend(light.intensity, next.intensity, share);
        });
}

// There are thousands, in nearly the same order: each is looked for close to where the last one was found. The client
// puts new ones in front, so from the end.
void blend_particles(View& to, const View& before, const View& after, float share)
{
    constexpr size_t looked_at = 64;
    std::vector<std::optional<size_t>> matches(before.particles.size());
    size_t end = after.particles.size();
    for (size_t i = before.particles.size(); i-- > 0;)
        for (size_t k = end; k-- > (end > looked_at ? end - looked_at : 0);) {
            const engine::Particle &a = before.particles[i], &b = after.particles[k];
            if (a.color == b.color && distance(a.origin, b.origin) <= max_particle_way) {
                matches[i] = end = k;
                break;
            }
        }
    to.particles = blend_lists(
        before.particles, after.particles, matches, share, [&](engine::Particle& particle, const auto& next) {
            blend_all(particle.origin, next.origin, share);
            particle.alpha = blend(particle.alpha, next.alpha, share);
        });
}

} // namespace

View blend_views(const View& before, const View& after, float share)
{
    if (is_cut(before.refdef, after.refdef))
        return share < 0.5f ? before : after;
    View view = share < 0.5f ? before : after; // lightstyles, areas
    view.refdef = before.refdef;
    engine::RefDef& refdef = view.refdef;
    const engine::RefDef& next = after.refdef;
    refdef.fov_x = blend(refdef.fov_x, next.fov_x, share);
    refdef.fov_y = blend(refdef.fov_y, next.fov_y, share);
    blend_all(refdef.view_origin, next.view_origin, share);
    blend_angles(refdef.view_angles, next.view_angles, share);
    blend_all(refdef.blend, next.blend, share);
    refdef.time = blend(refdef.time, next.time, share);
    view.entities = blend_lists(before.entities, after.entities,
        match(before.entities, after.entities, max_entity_way, entity_way), share,
        [&](Entity& entity, const Entity& later) { blend_entity(entity.entity, later.entity, share); });
    blend_dlights(view, before, after, share);
    blend_particles(view, before, after, share);
    return view;
}

} // namespace vkpt::trace

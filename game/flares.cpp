// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/flares.hpp"

#include "formats/light_code.hpp"
#include "game/light_text.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace vkpt::game {

namespace {

constexpr size_t max_flares = 24;
constexpr Box flare_box { { -2, -2, -2 }, { 2, 2, 2 } };
constexpr float throw_speed = 550, throw_lift = 120; // units a second
constexpr float gravity = 800, bounce = 0.45f, rolling_drag = 2.2f, water_drag = 4, water_gravity = 0.12f;
constexpr float rest_speed = 15, max_rolling_fall = 60; // units a second
constexpr float steepest_rest = 0.7f; // normal's z
constexpr float life = 30, dying = 4; // seconds, of which the last grow darker
constexpr float flare_value = 320, flare_reach = 1400, flare_radius = 1;
constexpr glm::vec3 flare_colour(1, 0.13f, 0.035f);
constexpr int move_parts = 4;

} // namespace

void Flares::run(const Command& command)
{
    if (!command.player)
        throw TextError("nobody plays who could throw a flare");
    // Less than 0: no end of them.
    const int supply = int(host_.cvar_number("vkpt_flares", "20"));
    if (supply >= 0 && thrown_ >= supply)
        throw TextError(fmt::format("no flares are left: vkpt_flares gives {} for a level, -1 no end of them", supply));
    const Eye eye = eye_of(*command.player);
    if (flares_.size() == max_flares) {
        host_.entities.remove(flares_.front().entity);
        flares_.erase(flares_.begin());
    }
    const int entity = host_.entities.add();
    if (entity < 0)
        throw TextError("there are too many lights, flares and emitters");
    thrown_++;
    Flare flare { entity, eye.origin, eye.forward * throw_speed + glm::vec3(0, 0, throw_lift), eye.angles,
        { random_.between(-500, 500), random_.between(-200, 200), 0 } };
    for (int i = 0; i < 3; i++)
        flare.velocity[i] += float(command.player->client->state.move.velocity[i]) / 8;
    // Not from within a wall that the player looks at closely.
    const Trace way = host_.trace(eye.origin, eye.origin + eye.forward * 16.0f, flare_box, command.player, mask_solid);
    flare.origin = to_vec3(way.end);
    flares_.push_back(flare);
    show(flares_.back());
}

void Flares::begin_level()
{
    flares_.clear();
    thrown_ = 0;
    random_ = Random(1);
}

void Flares::move(Flare& flare, float seconds)
{
    const bool in_liquid = (host_.contents(flare.origin) & mask_liquid) != 0;
    flare.velocity.z -= gravity * (in_liquid ? water_gravity : 1) * seconds;
    if (in_liquid)
        flare.velocity *= std::max(0.0f, 1 - water_drag * seconds);
    bool rolls = false;
    flare.angles += flare.spin * seconds;
    // What it meets turns it for the rest of the time: gravity alone would hold it to the floor that it rolls on.
    constexpr int max_bumps = 4;
    float left = seconds;
    for (int bump = 0; bump < max_bumps && left > 0; bump++) {
        const glm::vec3 to = flare.origin + flare.velocity * left;
        const Trace hit = host_.trace(flare.origin, to, flare_box, nullptr, mask_solid);
        if (is_true(hit.all_solid)) { // in a door or a lift that came
            flare.velocity = glm::vec3(0);
            return;
        }
        flare.origin = to_vec3(hit.end);
        left *= 1 - hit.fraction;
        if (hit.fraction == 1)
            break;
        rolls |= turn_at(flare, to_vec3(hit.plane.normal));
    }
    if (rolls)
        roll(flare, seconds);
}

// Where it meets a plane. True: it rolls along it.
bool Flares::turn_at(Flare& flare, glm::vec3 normal)
{
    const float into = glm::dot(flare.velocity, normal);
    const bool rolls = normal.z > steepest_rest && std::abs(into) < max_rolling_fall;
    flare.velocity -= normal * (into * (rolls ? 1 : 1 + bounce));
    if (!rolls)
        flare.spin *= 0.6f;
    return rolls;
}

// It lies down: the spin of the flight becomes that of rolling, across the way.
void Flares::roll(Flare& flare, float seconds)
{
    flare.velocity *= std::max(0.0f, 1 - rolling_drag * seconds);
    const float speed = glm::length(flare.velocity);
    flare.spin = glm::vec3(-flare.angles.x * 4, 0, speed * 20);
    flare.rests = speed < rest_speed;
    if (flare.rests)
        flare.velocity = flare.spin = glm::vec3(0);
}

// What it lay on may have gone: a door, a lift.
bool Flares::has_ground(const Flare& flare) const
{
    const glm::vec3 below = flare.origin - glm::vec3(0, 0, 2);
    return host_.trace(flare.origin, below, flare_box, nullptr, mask_solid).fraction < 1;
}

void Flares::show(const Flare& flare)
{
    formats::CodedLight light;
    light.colour = flare_colour;
    const float left = std::clamp((life - flare.age) / dying, 0.0f, 1.0f);
    light.value = flare_value * (0.25f + 0.75f * left);
    light.radius = flare_radius;
    light.style = formats::LightStyle::sputter;
    light.phase = uint32_t(flare.entity);
    EntityState& state = host_.entities.state(flare.entity);
    const auto model = size_t(formats::LightModel::flare);
    state.model = host_.engine.model_index(std::string(formats::light_models[model]).c_str());
    state.skin = formats::encode_light(light);
    state.effects = EF_GRENADE;
    state.render_flags = RF_FULLBRIGHT;
    put(to_vec3(state.origin), state.old_origin);
    put(flare.origin, state.origin);
    put(flare.angles, state.angles);
    host_.entities.touch(flare.entity, flare_reach);
}

void Flares::smoke(const Flare& flare)
{
    constexpr float up[3] = { 0, 0, 1 };
    const Imports& engine = host_.engine;
    const glm::vec3 tip = flare.origin + forward_of(flare.angles) * formats::flare_tip;
    engine.write_byte(svc_temp_entity);
    engine.write_byte(host_.frame % 2 ? TE_SPARKS : TE_CHAINFIST_SMOKE);
    engine.write_position(&tip.x);
    if (host_.frame % 2)
        engine.write_direction(up);
    engine.multicast(&tip.x, MULTICAST_PVS);
}

void Flares::update()
{
    constexpr uint32_t rarely = 3;
    for (Flare& flare : flares_) {
        flare.age += frame_seconds;
        flare.rests = flare.rests && has_ground(flare);
        for (int part = 0; part < move_parts && !flare.rests; part++)
            move(flare, frame_seconds / move_parts);
        show(flare);
        if (random_.next() % rarely == 0 && !(host_.contents(flare.origin) & mask_liquid))
            smoke(flare);
    }
    std::erase_if(flares_, [&](const Flare& flare) {
        if (flare.age < life)
            return false;
        host_.entities.remove(flare.entity);
        return true;
    });
}

} // namespace vkpt::game

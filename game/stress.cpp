// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/stress.hpp"

#include "formats/light_code.hpp"
#include "game/light_text.hpp"

#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace vkpt::game {

namespace {

constexpr float emitter_radius = 2, emitter_value = 130, emitter_reach = 900;
constexpr int hops = 12; // from the player to where a swarm begins
constexpr float longest_hop = 1024;

Box ball_box(float radius) { return { glm::vec3(-radius), glm::vec3(radius) }; }

float speed_of(const std::string& pattern)
{
    if (pattern.empty() || pattern == "drift")
        return 80;
    if (pattern == "fast")
        return 320;
    if (pattern == "still")
        return 0;
    throw TextError("stress N [SEED] [drift|fast|still]: '" + pattern + "' is no pattern");
}

} // namespace

void Stress::run(const Command& command)
{
    const int count = int(parse_number(command.word(0), "the number of emitters", 0, max_emitters));
    const uint32_t seed = command.word(1).empty() ? 0 : uint32_t(parse_number(command.word(1), "the seed", 0, 1e6f));
    const float speed = speed_of(command.word(2));
    clear();
    if (count > 0 && !command.player)
        throw TextError("nobody plays around whom they could be");
    Random random(seed + 1);
    const int swarms = std::min(count, max_swarms);
    for (int i = 0; i < swarms; i++)
        add(random, to_vec3(command.player->state.origin), uint32_t(count / swarms + (i < count % swarms)), speed);
    host_.say(command.sender, fmt::format("{} emitters in {} entities", count, swarms_.size()));
}

void Stress::clear()
{
    for (const Swarm& swarm : swarms_)
        host_.entities.remove(swarm.entity);
    swarms_.clear();
}

// From place to place by free ways.
glm::vec3 Stress::find_place(Random& random, glm::vec3 start, float radius) const
{
    glm::vec3 place = start;
    for (int hop = 0; hop < hops; hop++) {
        const glm::vec3 to = place + random.direction() * longest_hop;
        const Trace way = host_.trace(place, to, ball_box(radius), nullptr, mask_solid);
        if (!is_true(way.start_solid))
            place = glm::mix(place, to_vec3(way.end), random.between(0.3f, 0.9f));
    }
    return place;
}

void Stress::add(Random& random, glm::vec3 start, uint32_t count, float speed)
{
    const int entity = host_.entities.add();
    if (entity < 0)
        throw TextError("there are too many lights, flares and emitters");
    // A swarm needs its ball of air; where a player just fits, the start is no good place and is not kept.
    const float radius = count > 1 ? formats::swarm_radius + emitter_radius : emitter_radius + 2;
    const glm::vec3 near = find_place(random, start, emitter_radius);
    Swarm swarm { entity, find_place(random, near, radius), random.direction() * speed, radius };
    formats::CodedLight light;
    light.colour = glm::mix(glm::vec3(0.35f), glm::abs(random.direction()), 0.7f);
    // The same light from all together, however they are grouped.
    light.value = emitter_value;
    light.radius = emitter_radius;
    light.count = count;
    EntityState& state = host_.entities.state(entity);
    const auto model = size_t(formats::LightModel::swarm);
    state.model = host_.engine.model_index(std::string(formats::light_models[model]).c_str());
    state.skin = formats::encode_light(light);
    state.render_flags = RF_FULLBRIGHT;
    put(swarm.origin, state.origin);
    put(swarm.origin, state.old_origin);
    host_.entities.touch(entity, emitter_reach);
    swarms_.push_back(swarm);
}

void Stress::move(Swarm& swarm)
{
    constexpr int max_bounces = 4;
    float left = frame_seconds;
    for (int i = 0; i < max_bounces && left > 0; i++) {
        const glm::vec3 to = swarm.origin + swarm.velocity * left;
        const Trace hit = host_.trace(swarm.origin, to, ball_box(swarm.radius), nullptr, mask_solid);
        if (is_true(hit.start_solid)) { // a door or a lift came: it waits
            return;
        }
        swarm.origin = to_vec3(hit.end);
        left *= 1 - hit.fraction;
        if (hit.fraction == 1)
            return;
        const glm::vec3 normal = to_vec3(hit.plane.normal);
        swarm.velocity -= normal * (2 * glm::dot(swarm.velocity, normal));
    }
}

void Stress::update()
{
    for (Swarm& swarm : swarms_) {
        if (swarm.velocity == glm::vec3(0))
            continue;
        move(swarm);
        EntityState& state = host_.entities.state(swarm.entity);
        put(to_vec3(state.origin), state.old_origin);
        put(swarm.origin, state.origin);
        host_.entities.touch(swarm.entity, emitter_reach);
    }
}

} // namespace vkpt::game

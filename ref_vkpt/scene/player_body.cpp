// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/player_body.hpp"

#include "ref_vkpt/lights/cluster_finder.hpp"
#include "ref_vkpt/scene/entity_geometry.hpp"
#include "ref_vkpt/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

namespace vkpt {

namespace {

using namespace engine;

// The eye above the origin of the player's box, whose bottom is 24 units below that.
constexpr float eye_height = 22, crouched_eye_height = -2, box_bottom = 24;
// The body stands so far behind the eye, so that the weapon before the eye is not inside of its arms.
constexpr float units_behind_eye = 15;
constexpr float min_speed = 20; // units/s: slower ones stand
constexpr float ticks_per_second = 10;

// Frames of every player model.
struct Sequence {
    int first, count;
};
constexpr Sequence standing { 0, 40 }, running { 40, 6 }, shooting { 46, 8 }, jumping { 67, 1 }, crouching { 135, 19 },
    crawling { 154, 6 }, crouched_shooting { 160, 9 };

// The weapon before the eye, that in the hands of its owner, and between which of its frames it shoots.
struct Weapon {
    std::string_view name, held;
    int last_raised, last_shooting;
};
constexpr Weapon weapons[] = { { "v_blast", "w_blaster", 4, 8 }, { "v_shotg", "w_shotgun", 7, 18 },
    { "v_shotg2", "w_sshotgun", 6, 17 }, { "v_machn", "w_machinegun", 3, 5 }, { "v_chain", "w_chaingun", 4, 31 },
    { "v_launch", "w_glauncher", 5, 16 }, { "v_rocket", "w_rlauncher", 4, 12 }, { "v_hyperb", "w_hyperblaster", 5, 20 },
    { "v_rail", "w_railgun", 3, 18 }, { "v_bfg", "w_bfg", 8, 32 }, { "v_handgr", "a_grenades", 0, 15 } };
constexpr Weapon other_weapon { "", "weapon", 0, 0 };

// "models/weapons/NAME/tris.md2"
const Weapon& find_weapon(const Entity& entity)
{
    const auto* model = static_cast<const Model*>(entity.model);
    const std::string_view path = model ? std::string_view(model->name) : std::string_view();
    const size_t end = std::min(path.rfind('/'), path.size());
    const std::string_view folder = path.substr(0, end);
    const std::string_view name = folder.substr(std::min(folder.rfind('/') + 1, folder.size()));
    const auto* found = std::ranges::find(weapons, name, &Weapon::name);
    return found != std::end(weapons) ? *found : other_weapon;
}

const Entity* find_view_weapon(const RefDef& refdef)
{
    const Entity* end = refdef.entities + refdef.entity_count;
    const Entity* found
        = std::find_if(refdef.entities, end, [](const Entity& e) { return (e.flags & RF_WEAPONMODEL) && e.model; });
    return found != end ? found : nullptr;
}

bool touches_floor(const World& world, glm::vec3 place, float radius)
{
    uint64_t steps = 0;
    return touches_solid(world.bsp, place, radius, steps);
}

// From the floor below the eye: 46 units down where the player stands, and for a moment 28 on a step; 22 where they
// crouch.
bool is_crouched(const World& world, glm::vec3 eye)
{
    constexpr float below = crouched_eye_height + box_bottom, give = 4;
    return touches_floor(world, eye - glm::vec3(0, 0, below), give);
}

bool is_in_the_air(const World& world, glm::vec3 eye)
{
    return !touches_floor(world, eye - glm::vec3(0, 0, eye_height + box_bottom), 16);
}

bool is_player_name(std::string_view name)
{
    return !name.empty() && std::ranges::all_of(name, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

} // namespace

// One frame further with every tick; the sequence by what the eye and the weapon do.
void PlayerBody::animate(const RefDef& refdef, const World& world, const Entity& weapon)
{
    const int tick = int(std::floor(refdef.time * ticks_per_second));
    if (tick == tick_)
        return;
    const glm::vec3 eye = to_vec3(refdef.view_origin);
    const float seconds = refdef.time - tick_time_;
    const bool goes_on = tick_ >= 0 && seconds > 0 && seconds < 1;
    const float speed = goes_on ? glm::distance(glm::vec2(eye), glm::vec2(tick_eye_)) / seconds : 0;
    is_crouched_ = is_crouched(world, eye);
    Sequence sequence = is_crouched_ ? crouching : standing;
    if (speed > min_speed)
        sequence = is_crouched_ ? crawling : running;
    step_++;
    int step = step_;
    if (!is_crouched_ && is_in_the_air(world, eye))
        sequence = jumping;
    const Weapon& shown = find_weapon(weapon);
    if (weapon.frame > shown.last_raised && weapon.frame <= shown.last_shooting) {
        sequence = is_crouched_ ? crouched_shooting : shooting;
        step = std::min(weapon.frame - shown.last_raised - 1, sequence.count - 1);
    }
    frames_.before = frames_.now;
    frames_.now = sequence.first + step % sequence.count;
    if (!goes_on)
        frames_.before = frames_.now;
    tick_ = tick;
    tick_time_ = refdef.time;
    tick_eye_ = eye;
}

std::vector<Entity> PlayerBody::stand(
    const RefDef& refdef, const World& world, const std::string& skin, const RegisteredBody& registered)
{
    const Entity* weapon = find_view_weapon(refdef);
    const glm::vec3 eye = to_vec3(refdef.view_origin);
    if (!weapon || !is_sane(eye) || !is_sane(refdef.time))
        return {};
    const size_t slash = std::min(skin.find('/'), skin.size());
    std::string folder = skin.substr(0, slash), image = skin.substr(std::min(slash + 1, skin.size()));
    if (!is_player_name(folder) || !is_player_name(image) || !registered.model("players/" + folder + "/tris.md2")) {
        folder = "male";
        image = "grunt";
    }
    folder = "players/" + folder + "/";
    Entity body {};
    body.model = registered.model(folder + "tris.md2");
    if (!body.model)
        return {};
    animate(refdef, world, *weapon);
    body.skin = registered.skin(folder + image + ".pcx");
    body.flags = RF_VIEWERMODEL;
    body.frame = frames_.now;
    body.previous_frame = frames_.before;
    body.backlerp = 1 - (refdef.time * ticks_per_second - std::floor(refdef.time * ticks_per_second));
    body.angles[1] = refdef.view_angles[1];
    const float yaw = glm::radians(refdef.view_angles[1]);
    const glm::vec3 offset(std::cos(yaw) * units_behind_eye, std::sin(yaw) * units_behind_eye,
        is_crouched_ ? crouched_eye_height : eye_height);
    for (int i = 0; i < 3; i++)
        body.origin[i] = body.previous_origin[i] = eye[i] - offset[i];
    Entity held = body;
    held.skin = nullptr;
    held.model = registered.model(folder + std::string(find_weapon(*weapon).held) + ".md2");
    if (!held.model)
        held.model = registered.model(folder + std::string(other_weapon.held) + ".md2");
    return held.model ? std::vector { body, held } : std::vector { body };
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// models/weapons/: what the player sees in hand (v_*) and on the floor (g_*).
#include "tools/asset_generator/guns.hpp"
#include "tools/asset_generator/output.hpp"
#include "tools/asset_generator/tau.hpp"

#include <cmath>
#include <glm/common.hpp>

namespace vkpt::tools {

namespace {
using M = Material;

// A gloved hand round a grip at the origin, its forearm leaving to the lower right.
void add_hand(Mesh& m)
{
    m.box({ -3.6f, -1.7f, -5.0f }, { 0.4f, 1.5f, -2.0f }, M::rubber);
    for (int i = 0; i < 3; i++) // knuckles
        m.box({ 0.0f, -1.8f, -4.9f + 1.0f * float(i) }, { 1.1f, 1.7f, -4.1f + 1.0f * float(i) }, M::cloth);
    m.box({ -2.6f, 1.2f, -2.6f }, { 0.8f, 2.1f, -1.7f }, M::cloth); // thumb
    m.tube({ -3.0f, -0.2f, -3.8f }, { -9, -2.2f, -6.4f }, 1.9f, 2.3f, M::cloth, M::rubber);
    m.tube({ -8.4f, -2.0f, -6.2f }, { -18, -5.2f, -10.6f }, 2.7f, 3.2f, M::armour, M::rubber);
}

struct Motion {
    glm::vec3 shift { 0 };
    float pitch = 0, roll = 0;
};

// Where a view weapon is in frame `f` of its raise, fire, rest, lower sequence.
Motion motion_at(const Gun& gun, int f)
{
    if (f <= gun.raised) {
        const float t = 1 - float(f) / float(gun.raised);
        return { { -3 * t * t, 0, -15 * t * t }, 40 * t * t, -14 * t };
    }
    if (f <= gun.fired) {
        const float t = float(f - gun.raised - 1) / float(std::max(gun.fired - gun.raised, 1));
        const float kick = std::exp(-3.5f * t) * (1 - t);
        return { { -3.4f * kick, 0, 0.5f * kick }, -7 * kick, 2 * kick };
    }
    if (f <= gun.rested) {
        const float t = float(f - gun.fired) / float(gun.rested - gun.fired) * tau;
        return { { 0.12f * std::sin(t), 0.10f * std::sin(t), 0.22f * std::sin(t) }, 0.7f * std::sin(t),
            0.6f * std::sin(t) };
    }
    const float t = float(f - gun.rested) / float(gun.lowered - gun.rested);
    return { { -3 * t * t, 0, -15 * t * t }, 40 * t * t, -14 * t };
}

std::vector<Pose> view_poses(const Gun& gun)
{
    const glm::vec3 rest(15.0f, -5.8f, -6.6f); // from the eye
    std::vector<Pose> poses;
    for (int f = 0; f <= gun.lowered; f++) {
        const Motion motion = motion_at(gun, f);
        poses.push_back({ "frame" + std::to_string(f),
            { move(rest + motion.shift) * turn(motion.pitch, 2.5f, motion.roll) * stretch(glm::vec3(0.72f)) } });
    }
    return poses;
}

// Hand grenades are thrown: frames 0-15 raise and throw, 16-48 rest.
void write_hand_grenade(const Output& out)
{
    Mesh m;
    m.ball({ 2.2f, 0, -2.4f }, glm::vec3(2.3f), M::green_paint);
    m.tube({ 2.2f, 0, -0.4f }, { 2.2f, 0, 1.0f }, 0.8f, 0.7f, M::steel, M::gunmetal);
    m.tube({ 2.2f, 0, -2.9f }, { 2.2f, 0, -1.9f }, 2.4f, 2.4f, M::hazard, M::hazard);
    add_hand(m);
    std::vector<Pose> poses;
    for (int f = 0; f <= 48; f++) {
        const float swing = f < 16 ? std::sin(float(f) / 15 * tau * 0.5f) : 0.0f;
        const float sway = f >= 16 ? std::sin(float(f - 16) / 33 * tau) : 0.0f;
        poses.push_back({ "frame" + std::to_string(f),
            { move({ 12.0f + 5 * swing, -6, -6.5f + 4 * swing + 0.2f * sway }) * turn(-50 * swing + sway, 4, 0)
                * stretch(glm::vec3(0.8f)) } });
    }
    write_model(out, "models/weapons/v_handgr/tris.md2", m.build(poses, { std::string(shared_skin) }));
}
}

void write_weapon_models(const Output& out)
{
    for (const Gun& gun : guns()) {
        Mesh in_hand = make_gun(gun);
        add_hand(in_hand);
        const std::string folder = "models/weapons/";
        write_model(out, folder + gun.view + "/tris.md2", in_hand.build(view_poses(gun), { std::string(shared_skin) }));
        if (gun.pickup) {
            Mesh on_floor;
            on_floor.add(make_gun(gun), move({ -6, 0, 0 }) * turn(0, 0, 0) * stretch(glm::vec3(1.25f)));
            write_model(out, folder + gun.pickup + "/tris.md2", on_floor.build_still());
        }
    }
    write_hand_grenade(out);
}

} // namespace vkpt::tools

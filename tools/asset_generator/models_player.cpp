// SPDX-License-Identifier: GPL-2.0-or-later
// players/male/: an articulated figure with the game's 198 frames, its weapons and skins.
#include "tools/asset_generator/canvas.hpp"
#include "tools/asset_generator/guns.hpp"
#include "tools/asset_generator/output.hpp"
#include "tools/asset_generator/palette.hpp"
#include "tools/asset_generator/pictures.hpp"
#include "tools/asset_generator/tau.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vkpt::tools {

namespace {
using M = Material;

enum Part {
    pelvis,
    torso,
    head,
    arm_left,
    arm_right,
    fore_left,
    fore_right,
    thigh_left,
    thigh_right,
    shin_left,
    shin_right,
    part_count
};

// Joint angles in degrees; left and right where two.
struct Stance {
    glm::vec3 root { 0 }; // of the hips
    float lean = 0, twist = 0, fall = 0; // torso forward, torso left, whole body backwards
    float nod = 0;
    float hip[2] { 0, 0 }; // forward
    float knee[2] { 0, 0 }; // bent back
    float shoulder[2] { 62, 48 }; // forward from hanging
    float inward[2] { 34, -12 }; // arms towards the middle (left positive to the right)
    float elbow[2] { 34, 52 };
};

constexpr float hip_height = 1, shoulder_height = 16, neck_height = 20;

Mesh make_figure()
{
    Mesh m;
    m.begin_part(pelvis);
    m.tapered_box({ -3.2f, -5, -2.5f }, { 3.2f, 5, 3 }, 0.95f, M::cloth);
    m.box({ -3.6f, -5.4f, 1.6f }, { 3.6f, 5.4f, 3.2f }, M::rubber);
    m.begin_part(torso);
    m.tapered_box({ -3, -4.6f, 2.6f }, { 3, 4.6f, 9 }, 1.15f, M::cloth);
    m.tapered_box({ -4, -6, 8 }, { 4, 6, 18.5f }, 1.05f, M::armour);
    m.tapered_box({ 3.4f, -4.4f, 10 }, { 5, 4.4f, 17 }, 0.85f, M::armour);
    m.box({ 4.7f, -1, 13 }, { 5.3f, 1, 14.6f }, M::glow_teal);
    m.tapered_box({ -7, -4.5f, 8 }, { -3.8f, 4.5f, 17.5f }, 0.8f, M::gunmetal);
    m.tube({ 0, 0, 18.5f }, { 0, 0, 20.5f }, 2.2f, 2.0f, M::rubber, M::rubber, 7);
    m.begin_part(head);
    m.ball({ 0.2f, 0, 24.2f }, { 4.0f, 3.5f, 4.4f }, M::armour, 10, 7);
    m.tapered_box({ 2.2f, -2.9f, 22.8f }, { 4.5f, 2.9f, 25.6f }, 0.85f, M::visor);
    m.box({ -1.5f, -3.9f, 22.6f }, { 1.2f, 3.9f, 24.6f }, M::gunmetal);
    for (int side = 0; side < 2; side++) {
        const float y = side ? -8.0f : 8.0f;
        m.begin_part(arm_left + side);
        m.ball({ 0, y, shoulder_height + 0.6f }, { 3.3f, 2.9f, 3.2f }, M::armour, 8, 5);
        m.tube({ 0, y, shoulder_height - 1 }, { 0, y, shoulder_height - 8.5f }, 2.1f, 1.8f, M::cloth, M::rubber, 7);
        m.begin_part(fore_left + side);
        m.tube({ 0, y, shoulder_height - 8 }, { 0, y, shoulder_height - 14.5f }, 2.2f, 1.7f, M::armour, M::rubber, 7);
        m.box({ -1.3f, y - 1.2f, shoulder_height - 18 }, { 1.3f, y + 1.2f, shoulder_height - 14.4f }, M::rubber);
        const float hip_y = side ? -3.2f : 3.2f;
        m.begin_part(thigh_left + side);
        m.tube({ 0, hip_y, hip_height }, { 0, hip_y, hip_height - 11.5f }, 3.0f, 2.3f, M::cloth, M::cloth, 8);
        m.box({ 1.2f, hip_y - 1.8f, hip_height - 8 }, { 3.2f, hip_y + 1.8f, hip_height - 2.5f }, M::armour);
        m.begin_part(shin_left + side);
        m.tube({ 0, hip_y, hip_height - 11 }, { 0, hip_y, hip_height - 21.5f }, 2.4f, 2.1f, M::armour, M::rubber, 8);
        m.box({ 1.4f, hip_y - 1.5f, hip_height - 13.4f }, { 3.1f, hip_y + 1.5f, hip_height - 10 }, M::gunmetal);
        m.tapered_box({ -2.6f, hip_y - 2.2f, -24 }, { 5.2f, hip_y + 2.2f, -20.8f }, 0.8f, M::rubber);
    }
    return m;
}

glm::mat4 about(glm::vec3 pivot, const glm::mat4& rotation) { return move(pivot) * rotation * move(-pivot); }

glm::mat4 torso_frame(const Stance& s)
{
    const glm::mat4 body = move(s.root) * about({ 0, 0, -20 }, turn(-s.fall, 0));
    return body * about({ 0, 0, hip_height + 1.5f }, turn(s.lean, s.twist));
}

std::vector<glm::mat4> place_parts(const Stance& s)
{
    std::vector<glm::mat4> parts(part_count, glm::mat4(1));
    const glm::mat4 body = move(s.root) * about({ 0, 0, -20 }, turn(-s.fall, 0));
    parts[pelvis] = body;
    parts[torso] = torso_frame(s);
    parts[head] = parts[torso] * about({ 0, 0, neck_height }, turn(s.nod - s.lean, -s.twist));
    for (size_t side = 0; side < 2; side++) {
        const float y = side ? -8.0f : 8.0f, hip_y = side ? -3.2f : 3.2f;
        const glm::mat4 arm
            = parts[torso] * about({ 0, y, shoulder_height }, turn(0, -s.inward[side]) * turn(-s.shoulder[side], 0));
        parts[arm_left + side] = arm;
        parts[fore_left + side] = arm * about({ 0, y, shoulder_height - 8 }, turn(-s.elbow[side], 0));
        const glm::mat4 thigh = body * about({ 0, hip_y, hip_height }, turn(-s.hip[side], 0));
        parts[thigh_left + side] = thigh;
        parts[shin_left + side] = thigh * about({ 0, hip_y, hip_height - 11 }, turn(s.knee[side], 0));
    }
    return parts;
}

// Stances by sequence; t runs 0..1 through it.
Stance stand(float t)
{
    Stance s;
    const float breath = std::sin(t * tau * 4);
    s.root.z = 0.15f * breath;
    s.lean = 3 + breath;
    s.twist = 5 * std::sin(t * tau);
    s.nod = 3 * std::sin(t * tau * 2);
    s.hip[0] = 6, s.hip[1] = -4, s.knee[0] = 6, s.knee[1] = 4;
    return s;
}
Stance run(float t)
{
    Stance s = stand(0);
    const float a = t * tau;
    s.lean = 14;
    s.root.z = 0.9f * std::sin(2 * a) - 0.8f;
    s.twist = 10 * std::sin(a);
    for (size_t side = 0; side < 2; side++) {
        const float swing = std::sin(a + (side ? tau * 0.5f : 0.0f));
        const float lift = std::cos(a + (side ? tau * 0.5f : 0.0f));
        s.hip[side] = 8 + 40 * swing;
        s.knee[side] = 22 + 46 * std::max(0.0f, lift);
    }
    return s;
}
Stance crouch(float t)
{
    Stance s = stand(t);
    s.root.z -= 9.5f;
    s.lean = 18;
    s.hip[0] = 84, s.knee[0] = 104, s.hip[1] = 48, s.knee[1] = 110;
    return s;
}
Stance crouch_walk(float t)
{
    Stance s = crouch(0);
    for (size_t side = 0; side < 2; side++)
        s.hip[side] += 18 * std::sin(t * tau + (side ? tau * 0.5f : 0.0f));
    return s;
}
Stance recoil(Stance s, float t)
{
    const float kick = std::exp(-4 * t);
    s.lean -= 9 * kick;
    s.shoulder[0] += 8 * kick;
    s.shoulder[1] += 10 * kick;
    return s;
}
Stance flinch(Stance s, float t, float side)
{
    const float hit = std::sin(t * tau * 0.5f);
    s.lean -= 22 * hit;
    s.twist += 24 * hit * side;
    s.nod -= 16 * hit;
    return s;
}
Stance leap(float t)
{
    Stance s = stand(0);
    const float air = std::sin(std::min(t * 1.2f, 1.0f) * tau * 0.5f);
    s.hip[0] = 12 + 40 * air, s.knee[0] = 20 + 50 * air;
    s.hip[1] = -10 + 16 * air, s.knee[1] = 12 + 44 * air;
    s.lean = 8 + 8 * air;
    return s;
}
// A free hand's gesture: `raise` of the left arm and how it waves.
Stance gesture(float t, float raise, float wave)
{
    Stance s = stand(t);
    const float up = std::sin(std::min(1.0f, std::min(t, 1 - t) * 4) * tau * 0.25f);
    s.shoulder[0] += (raise - s.shoulder[0]) * up;
    s.inward[0] += (-6 - s.inward[0]) * up + wave * up * std::sin(t * tau * 3);
    s.elbow[0] += (26 - s.elbow[0]) * up;
    return s;
}
Stance collapse(Stance s, float t, float direction, float twist)
{
    const float fallen = 1 - (1 - t) * (1 - t);
    s.fall = 84 * fallen * direction;
    s.root.z -= 1.6f * fallen;
    s.twist += twist * fallen;
    s.lean *= 1 - fallen;
    for (size_t side = 0; side < 2; side++) {
        s.hip[side] *= 1 - 0.8f * fallen;
        s.knee[side] = s.knee[side] * (1 - 0.8f * fallen) + 14 * fallen * float(side);
        s.shoulder[side] += (20 + 30 * float(side) - s.shoulder[side]) * fallen;
        s.inward[side] += ((side ? 40.0f : -40.0f) - s.inward[side]) * fallen;
    }
    return s;
}

struct Sequence {
    const char* name;
    int frames;
    Stance (*stance)(float t);
    bool loops;
};
// The game counts on exactly this order and these lengths: 198 frames.
constexpr std::array sequences {
    Sequence { "stand", 40, stand, true },
    Sequence { "run", 6, run, true },
    Sequence { "attack", 8, [](float t) { return recoil(stand(0), t); }, false },
    Sequence { "pain1", 4, [](float t) { return flinch(stand(0), t, 1); }, false },
    Sequence { "pain2", 4, [](float t) { return flinch(stand(0), t, -1); }, false },
    Sequence { "pain3", 4, [](float t) { return flinch(stand(0), t, 0.2f); }, false },
    Sequence { "jump", 6, leap, false },
    Sequence { "flip", 12, [](float t) { return gesture(t, 150, 0); }, false },
    Sequence { "salute", 11, [](float t) { return gesture(t, 128, 6); }, false },
    Sequence { "taunt", 17, [](float t) { return gesture(t, 96, 26); }, false },
    Sequence { "wave", 11, [](float t) { return gesture(t, 165, 22); }, false },
    Sequence { "point", 12, [](float t) { return gesture(t, 88, 3); }, false },
    Sequence { "crstnd", 19, crouch, true },
    Sequence { "crwalk", 6, crouch_walk, true },
    Sequence { "crattak", 9, [](float t) { return recoil(crouch(0), t); }, false },
    Sequence { "crpain", 4, [](float t) { return flinch(crouch(0), t, 1); }, false },
    Sequence { "crdeath", 5, [](float t) { return collapse(crouch(0), t, 1, 30); }, false },
    Sequence { "death1", 6, [](float t) { return collapse(stand(0), t, 1, 20); }, false },
    Sequence { "death2", 6, [](float t) { return collapse(stand(0), t, -1, -15); }, false },
    Sequence { "death3", 8, [](float t) { return collapse(stand(0), t, 1, -50); }, false },
};

template <class Place> std::vector<Pose> make_poses(Place place)
{
    std::vector<Pose> poses;
    for (const Sequence& sequence : sequences) {
        for (int f = 0; f < sequence.frames; f++) {
            const float t = float(f) / float(sequence.loops ? sequence.frames : sequence.frames - 1);
            poses.push_back({ sequence.name + std::to_string(f + 1), place(sequence.stance(t)) });
        }
    }
    return poses;
}

void write_face(const Output& out, const std::string& skin, glm::vec3 armour)
{
    Canvas c(32, 32, 4);
    draw_plate(c, { 0, 0 }, { 32, 32 }, 6, ink::teal);
    c.fill(chamfered_box({ 7, 19 }, { 25, 31 }, 5), armour * 0.8f);
    c.fill(circle({ 16, 14 }, 8.5f), armour);
    c.fill(box({ 9, 11.5f }, { 23, 17 }, 2), glm::vec3(0.06f, 0.22f, 0.26f));
    c.fill(line({ 11, 13 }, { 16, 13 }, 0.7f), ink::teal);
    out.write("players/male/" + skin + "_i.pcx", formats::write_pcx(quantise(32, 32, c.shrink(), 0.25f, true)));
}

constexpr glm::vec3 olive(0.40f, 0.44f, 0.28f);
}

void write_shared_skin(const Output& out) { out.write(shared_skin, formats::write_pcx(make_skin(olive))); }

void write_player_models(const Output& out)
{
    struct Skin {
        const char* name;
        glm::vec3 armour;
    };
    constexpr std::array skins {
        Skin { "grunt", olive },
        Skin { "cobalt", { 0.20f, 0.32f, 0.62f } },
        Skin { "ember", { 0.62f, 0.22f, 0.12f } },
        Skin { "brass", { 0.70f, 0.54f, 0.24f } },
    };
    write_shared_skin(out);
    for (const Skin& skin : skins) {
        out.write("players/male/" + std::string(skin.name) + ".pcx", formats::write_pcx(make_skin(skin.armour)));
        write_face(out, skin.name, skin.armour);
    }
    out.write("players/male/disguise.pcx", formats::write_pcx(make_skin({ 0.5f, 0.5f, 0.5f })));
    out.write("players/male/weapon.pcx", formats::write_pcx(make_skin(olive)));
    write_model(
        out, "players/male/tris.md2", make_figure().build(make_poses(place_parts), { "players/male/grunt.pcx" }));

    const auto hold = [](const Stance& s) { return std::vector { torso_frame(s) * move({ 13, -4, 9.5f }) }; };
    const std::vector<Pose> poses = make_poses(hold);
    for (const Gun& gun : guns()) {
        const formats::Md2Model model = make_gun(gun).build(poses, { "players/male/weapon.pcx" });
        write_model(out, "players/male/" + std::string(gun.held) + ".md2", model);
        if (&gun == &guns().front())
            write_model(out, "players/male/weapon.md2", model);
    }
    Mesh grenade;
    grenade.ball({ 2, 0, -1 }, glm::vec3(2.4f), M::green_paint);
    write_model(out, "players/male/a_grenades.md2", grenade.build(poses, { "players/male/weapon.pcx" }));
}

} // namespace vkpt::tools

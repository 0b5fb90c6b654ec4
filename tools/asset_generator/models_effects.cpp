// SPDX-License-Identifier: GPL-2.0-or-later
// Projectiles, explosions, debris and sprites.
#include "tools/asset_generator/canvas.hpp"
#include "tools/asset_generator/mesh.hpp"
#include "tools/asset_generator/noise.hpp"
#include "tools/asset_generator/output.hpp"
#include "tools/asset_generator/palette.hpp"
#include "tools/asset_generator/tau.hpp"

#include <cmath>

namespace vkpt::tools {

namespace {
using M = Material;

void put(const Output& out, std::string_view path, const Mesh& mesh)
{
    write_model(out, "models/" + std::string(path) + "/tris.md2", mesh.build_still());
}

Mesh make_bolt(M glow, float length)
{
    Mesh m;
    m.tube({ -length, 0, 0 }, { length * 0.3f, 0, 0 }, 0.15f, 1.3f, glow, glow, 6);
    m.tube({ length * 0.3f, 0, 0 }, { length * 0.6f, 0, 0 }, 1.3f, 0.1f, M::glow_white, glow, 6);
    return m;
}

Mesh make_rocket()
{
    Mesh m;
    m.tube({ -7, 0, 0 }, { 5, 0, 0 }, 1.7f, 1.7f, M::dark_steel, M::glow_amber, 8);
    m.tube({ 5, 0, 0 }, { 10, 0, 0 }, 1.7f, 0.2f, M::red_paint, M::red_paint, 8);
    for (int i = 0; i < 4; i++) {
        const float a = tau * (float(i) + 0.5f) / 4;
        const glm::vec3 d(0, std::cos(a), std::sin(a)), side(0, -std::sin(a), std::cos(a));
        const glm::vec3 root = d * 1.5f, tip = d * 4.0f;
        const glm::vec3 t = side * 0.2f;
        m.quad(glm::vec3(-7, 0, 0) + root + t, glm::vec3(-2, 0, 0) + root + t, glm::vec3(-5, 0, 0) + tip + t,
            glm::vec3(-8, 0, 0) + tip + t, M::amber_paint);
        m.quad(glm::vec3(-2, 0, 0) + root - t, glm::vec3(-7, 0, 0) + root - t, glm::vec3(-8, 0, 0) + tip - t,
            glm::vec3(-5, 0, 0) + tip - t, M::amber_paint);
    }
    return m;
}

Mesh make_grenade()
{
    Mesh m;
    m.ball({ 0, 0, 0 }, glm::vec3(2.8f), M::green_paint, 8, 6);
    m.tube({ -0.7f, 0, 0 }, { 0.7f, 0, 0 }, 3.0f, 3.0f, M::hazard, M::hazard, 8);
    m.ball({ 0, 0, 3 }, glm::vec3(0.9f), M::glow_red, 6, 4);
    return m;
}

// A rough lump: ball with its points pushed by noise is what debris and gibs look like.
Mesh make_lump(glm::vec3 radii, M a, M b, int pieces, uint32_t seed)
{
    Mesh m;
    for (int i = 0; i < pieces; i++) {
        const auto jitter = [&](int axis) { return hash_unit(i, axis, seed) - 0.5f; };
        const glm::vec3 at = radii * glm::vec3(jitter(0), jitter(1), jitter(2)) * (pieces > 1 ? 1.1f : 0.0f);
        m.ball(at, radii * (0.6f + 0.5f * hash_unit(i, 3, seed)), i & 1 ? b : a, 6, 4);
    }
    return m;
}

Mesh make_shard_box(float size, M material, uint32_t seed)
{
    Mesh part, m;
    part.tapered_box({ -size, -size * 0.6f, -size * 0.25f }, { size, size * 0.6f, size * 0.25f }, 0.6f, material);
    m.add(part, turn(hash_unit(0, 0, seed) * 40, 0, 20));
    m.add(part, move({ size * 0.3f, size * 0.3f, size * 0.2f }) * turn(60, 40, 10) * stretch(glm::vec3(0.6f)));
    return m;
}

Mesh make_bone(float length)
{
    Mesh m;
    m.tube({ -length, 0, 0 }, { length, 0, 0 }, 0.9f, 0.9f, M::bone, M::bone, 6);
    for (const float x : { -length, length })
        m.ball({ x, 0.4f, 0 }, { 1.6f, 1.9f, 1.4f }, M::bone, 6, 4);
    return m;
}

Mesh make_limb(float length, M skin, M end)
{
    Mesh m;
    m.tube({ -length, 0, 0 }, { 0, 0.6f, 0 }, 2.3f, 1.8f, skin, M::flesh, 7);
    m.tube({ 0, 0.6f, 0 }, { length, -0.6f, 0.8f }, 1.8f, 1.4f, skin, M::flesh, 7);
    m.ball({ length + 1.2f, -0.8f, 0.9f }, { 2, 1.5f, 1.2f }, end, 6, 4);
    return m;
}

Mesh make_head(bool bare_bone)
{
    Mesh m;
    m.ball({ 0, 0, 0 }, { 4, 3.4f, 4.4f }, bare_bone ? M::bone : M::skin, 8, 6);
    m.box({ 3.2f, -2.2f, -0.4f }, { 4.2f, 2.2f, 1.2f }, bare_bone ? M::rubber : M::visor);
    m.tube({ 0, 0, -5.4f }, { 0, 0, -3.4f }, 1.8f, 2.2f, M::flesh, M::flesh, 7);
    return m;
}

Mesh make_barrel()
{
    Mesh m;
    m.tube({ 0, 0, -16 }, { 0, 0, 15 }, 10, 10, M::teal_paint, M::dark_steel, 12);
    for (const float z : { -15.5f, -5.5f, 4.5f, 13.5f })
        m.tube({ 0, 0, z }, { 0, 0, z + 1.6f }, 10.6f, 10.6f, M::gunmetal, M::gunmetal, 12);
    m.tube({ 0, 0, -1.5f }, { 0, 0, 2.5f }, 10.3f, 10.3f, M::hazard, M::hazard, 12);
    m.tube({ 5, 0, 15 }, { 5, 0, 16.5f }, 2, 1.6f, M::steel, M::gunmetal, 8);
    return m;
}

// Growing and fading fire balls; skins run from white heat to smoke.
void write_explosion(const Output& out, const std::string& path, int frames, float from, float to, int skins)
{
    Mesh m;
    m.ball({ 0, 0, 0 }, glm::vec3(1), M::fire, 8, 6);
    for (int i = 0; i < 5; i++) {
        const float a = tau * float(i) / 5;
        m.begin_part(1 + i);
        m.ball(glm::vec3(std::cos(a), std::sin(a), 0.5f * std::sin(3 * a)) * 0.8f, glm::vec3(0.6f), M::fire, 7, 5);
    }
    std::vector<Pose> poses;
    for (int f = 0; f < frames; f++) {
        const float t = float(f) / float(std::max(frames - 1, 1));
        const float size = from + (to - from) * std::sqrt(t);
        Pose pose { "blast" + std::to_string(f), {} };
        for (int part = 0; part < 6; part++)
            pose.parts.push_back(move(glm::vec3(0, 0, to * 0.25f * t * t))
                * turn(40 * t * float(part & 1 ? 1 : -1), 70 * t + 15 * float(part), 0)
                * stretch(glm::vec3(size * (1 + 0.25f * std::sin(float(part) * 2 + 4 * t)))));
        poses.push_back(std::move(pose));
    }
    std::vector<std::string> names;
    for (int i = 0; i < skins; i++)
        names.push_back("models/vkpt/fire" + std::to_string(i) + ".pcx");
    write_model(out, path, m.build(poses, names));
}

void write_fire_skins(const Output& out)
{
    constexpr int side = 64, count = 7;
    constexpr glm::vec3 heat[] = { { 1, 1, 0.86f }, { 1, 0.86f, 0.44f }, { 1, 0.64f, 0.2f }, { 0.92f, 0.4f, 0.08f },
        { 0.66f, 0.2f, 0.05f }, { 0.36f, 0.14f, 0.08f }, { 0.2f, 0.18f, 0.17f } };
    for (int i = 0; i < count; i++) {
        std::vector<glm::vec4> pixels;
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                const float n = fractal_noise((glm::vec2(x, y) + 0.5f) / float(side), 10, 3, 601u + uint32_t(i));
                pixels.emplace_back(glm::clamp(heat[i] * (0.6f + 0.8f * n), 0.0f, 1.0f), 1.0f);
            }
        out.write("models/vkpt/fire" + std::to_string(i) + ".pcx",
            formats::write_pcx(quantise(side, side, pixels, 0.4f, false)));
    }
}

// Balls of green plasma: the big gun's shot, its burst and its sparks.
void write_sprite(const Output& out, const std::string& name, int frames, int size, float spikes)
{
    formats::Sp2Sprite sprite;
    for (int f = 0; f < frames; f++) {
        const std::string picture = "sprites/" + name + "_" + std::to_string(f) + ".pcx";
        Canvas canvas(size, size, 2);
        const glm::vec2 middle(float(size) * 0.5f);
        const float radius = float(size) * (0.26f + 0.18f * float(f) / float(frames));
        canvas.paint(
            [=](glm::vec2 p) {
                const glm::vec2 d = p - middle;
                const float wave = std::sin(std::atan2(d.y, d.x) * spikes + float(f) * 1.9f);
                return glm::length(d) - radius * (1 + 0.28f * wave);
            },
            [=](glm::vec2 p) {
                const float t = glm::clamp(glm::length(p - middle) / radius, 0.0f, 1.0f);
                return glm::vec4(glm::mix(glm::vec3(0.95f, 1, 0.9f), glm::vec3(0.16f, 0.85f, 0.24f), t), 1.0f);
            });
        out.write(picture, formats::write_pcx(quantise(size, size, canvas.shrink(), 0.4f, true)));
        sprite.frames.push_back({ size, size, size / 2, size / 2, picture });
    }
    out.write("sprites/" + name + ".sp2", formats::write_sp2(sprite));
}

void write_debris(const Output& out)
{
    put(out, "objects/debris1", make_shard_box(7, M::dark_steel, 1));
    put(out, "objects/debris2", make_shard_box(4, M::teal_paint, 2));
    put(out, "objects/debris3", make_shard_box(5, M::gunmetal, 3));
    put(out, "objects/gibs/bone", make_bone(5));
    put(out, "objects/gibs/bone2", make_bone(3.5f));
    put(out, "objects/gibs/arm", make_limb(6, M::skin, M::rubber));
    put(out, "objects/gibs/leg", make_limb(8, M::cloth, M::rubber));
    put(out, "objects/gibs/head", make_head(false));
    put(out, "objects/gibs/head2", make_head(false));
    put(out, "objects/gibs/skull", make_head(true));
    put(out, "objects/gibs/chest", make_lump({ 5, 6, 4 }, M::flesh, M::bone, 5, 11));
    put(out, "objects/gibs/gear", make_shard_box(4, M::copper, 4));
    put(out, "objects/gibs/sm_meat", make_lump({ 3, 2.4f, 2 }, M::flesh, M::flesh, 3, 12));
    put(out, "objects/gibs/sm_metal", make_shard_box(2.5f, M::steel, 5));
}
}

void write_effect_models(const Output& out)
{
    put(out, "objects/laser", make_bolt(M::glow_amber, 12));
    put(out, "objects/rocket", make_rocket());
    put(out, "objects/grenade", make_grenade());
    put(out, "objects/grenade2", make_grenade());
    put(out, "objects/barrels", make_barrel());
    put(out, "proj/beam", make_bolt(M::glow_red, 16));
    put(out, "proj/lightning", make_bolt(M::glow_blue, 16));
    put(out, "proj/widowbeam", make_bolt(M::glow_violet, 16));
    put(out, "ctf/segment", make_bolt(M::steel, 16));
    put(out, "monsters/parasite/segment", make_bolt(M::flesh, 16)); // drawn by the client itself
    put(out, "monsters/parasite/tip", make_bolt(M::bone, 8));
    Mesh spot, banner, reticle;
    spot.tube({ 0, 0, -24 }, { 0, 0, -22 }, 22, 20, M::gunmetal, M::glow_teal, 12);
    put(out, "objects/dmspot", spot);
    banner.box({ -0.5f, -24, -40 }, { 0.5f, 24, 40 }, M::teal_paint);
    put(out, "objects/banner", banner);
    reticle.box({ -0.1f, -1, -1 }, { 0.1f, 1, 1 }, M::glow_amber);
    put(out, "crosshair", reticle);
    Mesh pit;
    pit.box({ -32, -32, -32 }, { 32, 32, 32 }, M::rubber);
    put(out, "objects/black", pit);
    write_debris(out);
    write_fire_skins(out);
    write_explosion(out, "models/objects/explode/tris.md2", 6, 2, 9, 7);
    write_explosion(out, "models/objects/r_explode/tris.md2", 31, 8, 30, 7);
    write_explosion(out, "models/objects/r_explode2/tris.md2", 31, 8, 44, 7);
    write_explosion(out, "models/objects/smoke/tris.md2", 6, 3, 10, 1);
    write_explosion(out, "models/objects/flash/tris.md2", 4, 3, 6, 1);
    write_sprite(out, "s_bfg1", 2, 64, 7);
    write_sprite(out, "s_bfg2", 6, 128, 9);
    write_sprite(out, "s_bfg3", 6, 96, 11);
}

} // namespace vkpt::tools

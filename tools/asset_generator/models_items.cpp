// SPDX-License-Identifier: GPL-2.0-or-later
// models/items/: what lies on the floor to be taken. Origins are at the item's middle, about 16 above the floor.
#include "tools/asset_generator/mesh.hpp"
#include "tools/asset_generator/output.hpp"
#include "tools/asset_generator/tau.hpp"

#include <cmath>

namespace vkpt::tools {

namespace {
using M = Material;
constexpr float floor_z = -15; // the items' boxes end here

Mesh make_case(glm::vec3 half, M body, M accent, M top)
{
    Mesh m;
    const float z = floor_z + half.z * 2;
    m.tapered_box({ -half.x, -half.y, floor_z }, { half.x, half.y, z }, 0.92f, body);
    m.box({ -half.x - 0.4f, -half.y * 0.3f, floor_z + 1 }, { half.x + 0.4f, half.y * 0.3f, z - 1 }, accent);
    m.box({ -half.x * 0.55f, -half.y * 0.55f, z }, { half.x * 0.55f, half.y * 0.55f, z + 0.7f }, top);
    for (const float x : { -1.0f, 1.0f })
        m.box({ x * half.x * 0.92f - 0.8f, -half.y - 0.5f, floor_z + half.z * 0.6f },
            { x * half.x * 0.92f + 0.8f, half.y + 0.5f, floor_z + half.z * 1.3f }, M::gunmetal);
    return m;
}

Mesh make_health(float size, M rim)
{
    Mesh m = make_case({ 6 * size, 4.5f * size, 3.2f * size }, M::white_paint, rim, M::medic);
    const float z = floor_z + 6.4f * size;
    m.box({ -2.0f * size, -0.5f, z }, { -1.4f * size, 0.5f, z + 2.4f }, M::gunmetal);
    m.box({ 1.4f * size, -0.5f, z }, { 2.0f * size, 0.5f, z + 2.4f }, M::gunmetal);
    m.box({ -2.0f * size, -0.5f, z + 2 }, { 2.0f * size, 0.5f, z + 2.7f }, M::gunmetal);
    return m;
}

// Breast plate with shoulder guards.
Mesh make_armour(M plate, M trim, float bulk)
{
    Mesh m;
    m.tapered_box({ -4 * bulk, -7 * bulk, -12 }, { 4 * bulk, 7 * bulk, 0 }, 1.25f, plate);
    m.tapered_box({ 3.6f * bulk, -5 * bulk, -9 }, { 5.4f * bulk, 5 * bulk, -2 }, 0.8f, trim);
    for (const float side : { -1.0f, 1.0f }) {
        m.ball({ 0, side * 9.5f * bulk, 0.5f }, { 4.5f * bulk, 3.6f * bulk, 3.4f }, trim, 8, 5);
        m.box({ -2, side * 4.5f - 1, 0 }, { 2, side * 4.5f + 1, 2 }, M::rubber);
    }
    m.tube({ 0, 0, 0 }, { 0, 0, 2 }, 3.4f, 3.0f, M::gunmetal, M::rubber);
    m.box({ 4.6f * bulk, -1, -6 }, { 5.8f * bulk, 1, -4 }, M::glow_teal);
    return m;
}

Mesh make_shard()
{
    Mesh m;
    const glm::vec3 tip(0, 0, -3), foot(0, 0, floor_z);
    const glm::vec3 ring[] = { { 3.2f, 0, -9 }, { 0, 2.2f, -8 }, { -3.2f, 0, -10 }, { 0, -2.2f, -9 } };
    for (int i = 0; i < 4; i++) {
        m.triangle(ring[i], ring[(i + 1) % 4], tip, M::green_paint);
        m.triangle(ring[(i + 1) % 4], ring[i], foot, M::glow_green);
    }
    return m;
}

Mesh make_rounds(int count, float radius, float height, M body, M tip)
{
    Mesh m;
    m.box({ -7, -4, floor_z }, { 7, 4, floor_z + 2 }, M::gunmetal);
    for (int i = 0; i < count; i++) {
        const float x = (float(i) - float(count - 1) * 0.5f) * radius * 2.3f;
        m.tube({ x, 0, floor_z + 2 }, { x, 0, floor_z + 2 + height * 0.7f }, radius, radius, body, body);
        m.tube({ x, 0, floor_z + 2 + height * 0.7f }, { x, 0, floor_z + 2 + height }, radius, radius * 0.3f, tip, tip);
    }
    return m;
}

Mesh make_cells()
{
    Mesh m = make_case({ 6, 4, 4 }, M::dark_steel, M::hazard, M::grille);
    for (const float x : { -3.0f, 0.0f, 3.0f })
        m.tube({ x, 0, floor_z + 8 }, { x, 0, floor_z + 11 }, 1.1f, 1.1f, M::glow_teal, M::steel);
    return m;
}

Mesh make_grenades()
{
    Mesh m;
    for (int i = 0; i < 3; i++) {
        const float a = tau * float(i) / 3;
        const glm::vec3 at(4 * std::cos(a), 4 * std::sin(a), floor_z + 3);
        m.ball(at, glm::vec3(3), M::green_paint);
        m.tube(at + glm::vec3(0, 0, 2.6f), at + glm::vec3(0, 0, 4.2f), 0.9f, 0.8f, M::steel, M::gunmetal);
    }
    return m;
}

// A floating sign inside two crossed rings: the powers.
Mesh make_power(M glow, M metal, int spikes)
{
    Mesh m;
    m.ball({ 0, 0, -4 }, glm::vec3(4.2f), glow, 10, 6);
    for (int i = 0; i < spikes; i++) {
        const float a = tau * float(i) / float(spikes);
        const glm::vec3 d(std::cos(a), std::sin(a), 0);
        m.tube(glm::vec3(0, 0, -4) + d * 4.6f, glm::vec3(0, 0, -4) + d * 9.0f, 1.5f, 0.1f, metal, metal, 6);
    }
    m.tube({ 0, 0, 0.6f }, { 0, 0, 4.4f }, 1.5f, 0.1f, metal, metal, 6);
    m.tube({ 0, 0, -8.6f }, { 0, 0, floor_z }, 1.5f, 2.6f, metal, metal, 6);
    return m;
}

Mesh make_tank(M body, M glow) // breather, suit, silencer, adrenaline: a bottle with a lit band
{
    Mesh m;
    m.tube({ 0, 0, floor_z }, { 0, 0, -6 }, 3.6f, 3.6f, body, M::gunmetal, 10);
    m.tube({ 0, 0, -6 }, { 0, 0, -3 }, 3.6f, 1.4f, body, body, 10);
    m.tube({ 0, 0, -3 }, { 0, 0, -1 }, 1.4f, 1.4f, M::steel, M::gunmetal, 8);
    m.tube({ 0, 0, -11.5f }, { 0, 0, -9.5f }, 3.9f, 3.9f, glow, glow, 10);
    return m;
}

Mesh make_key(M glow)
{
    Mesh m;
    m.box({ -1, -6, -12 }, { 1, 6, -3 }, M::dark_steel);
    m.box({ -1.3f, -4.5f, -10.5f }, { 1.3f, 4.5f, -7.5f }, glow);
    m.box({ -1.3f, 1, -6.5f }, { 1.3f, 4.5f, -4.2f }, M::gold);
    return m;
}

Mesh make_gem(M glow)
{
    Mesh m;
    m.tube({ 0, 0, floor_z }, { 0, 0, -12 }, 6, 5, M::gunmetal, M::dark_steel, 8);
    m.tube({ 0, 0, -12 }, { 0, 0, -2 }, 4.5f, 0.2f, glow, glow, 4);
    return m;
}

Mesh make_pack(M cloth, M accent)
{
    Mesh m;
    m.tapered_box({ -4, -6, floor_z }, { 4, 6, 0 }, 0.85f, cloth);
    m.box({ 3.2f, -3.5f, floor_z + 2 }, { 5.5f, 3.5f, -7 }, cloth);
    for (const float y : { -3.6f, 3.6f })
        m.box({ -4.6f, y - 0.7f, floor_z + 1 }, { 4.2f, y + 0.7f, -0.4f }, accent);
    return m;
}
}

void write_item_models(const Output& out)
{
    const auto put = [&](std::string_view path, const Mesh& mesh) {
        write_model(out, "models/items/" + std::string(path) + "/tris.md2", mesh.build_still());
    };
    put("healing/stimpack", make_tank(M::white_paint, M::glow_green));
    put("healing/medium", make_health(1, M::green_paint));
    put("healing/large", make_health(1.35f, M::red_paint));
    put("mega_h", make_power(M::glow_blue, M::white_paint, 4));
    put("armor/shard", make_shard());
    put("armor/jacket", make_armour(M::green_paint, M::cloth, 0.9f));
    put("armor/combat", make_armour(M::amber_paint, M::gunmetal, 1.0f));
    put("armor/body", make_armour(M::red_paint, M::gold, 1.1f));
    put("armor/screen", make_key(M::glow_teal));
    put("armor/shield", make_key(M::glow_blue));
    put("ammo/shells/medium", make_rounds(4, 1.4f, 6, M::red_paint, M::gold));
    put("ammo/bullets/medium", make_case({ 6, 4, 3.5f }, M::teal_paint, M::gunmetal, M::gold));
    put("ammo/cells/medium", make_cells());
    put("ammo/rockets/medium", make_rounds(3, 2.0f, 14, M::dark_steel, M::red_paint));
    put("ammo/slugs/medium", make_rounds(4, 1.3f, 10, M::steel, M::glow_blue));
    put("ammo/grenades/medium", make_grenades());
    put("quaddama", make_power(M::glow_blue, M::chrome, 4));
    put("invulner", make_power(M::glow_amber, M::gold, 8));
    put("adrenal", make_tank(M::red_paint, M::glow_amber));
    put("silencer", make_tank(M::gunmetal, M::steel));
    put("breather", make_tank(M::blue_paint, M::glow_teal));
    put("enviro", make_tank(M::green_paint, M::glow_green));
    put("band", make_pack(M::wood, M::gold));
    put("pack", make_pack(M::cloth, M::teal_paint));
    put("c_head", make_tank(M::skin, M::visor));
    put("keys/data_cd", make_key(M::chrome));
    put("keys/key", make_key(M::glow_blue));
    put("keys/red_key", make_key(M::glow_red));
    put("keys/pass", make_key(M::glow_amber));
    put("keys/power", make_gem(M::glow_blue));
    put("keys/pyramid", make_gem(M::glow_amber));
    put("keys/spinner", make_gem(M::glow_violet));
    put("keys/target", make_key(M::glow_green));

    // The flash round somebody whose armour takes a hit, and the shell round the invulnerable: a hull of plates.
    Mesh shell;
    shell.ball({ 0, 0, 0 }, { 20, 20, 30 }, M::glow_green, 10, 6);
    write_model(out, "models/items/armor/effect/tris.md2", shell.build_still());
    write_model(out, "models/items/shell/tris.md2", shell.build_still());
}

} // namespace vkpt::tools

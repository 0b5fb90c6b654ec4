// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/guns.hpp"

#include <array>
#include <cmath>

namespace vkpt::tools {

namespace {
using M = Material;
constexpr std::array all_guns {
    Gun { "v_blast", nullptr, "w_blaster", 4, 8, 52, 55, 1, 7, 1.3f, M::steel, M::gunmetal, M::glow_amber },
    Gun { "v_shotg", "g_shotg", "w_shotgun", 7, 18, 36, 39, 1, 13, 1.1f, M::gunmetal, M::dark_steel, M::red_paint },
    Gun { "v_shotg2", "g_shotg2", "w_sshotgun", 6, 17, 57, 61, 2, 11, 1.1f, M::gunmetal, M::dark_steel, M::wood },
    Gun { "v_machn", "g_machn", "w_machinegun", 3, 5, 45, 49, 1, 12, 0.8f, M::dark_steel, M::gunmetal, M::teal_paint },
    Gun { "v_chain", "g_chain", "w_chaingun", 4, 31, 61, 64, 6, 12, 0.6f, M::dark_steel, M::steel, M::amber_paint },
    Gun { "v_launch", "g_launch", "w_glauncher", 5, 16, 59, 64, 1, 9, 2.0f, M::green_paint, M::gunmetal, M::hazard },
    Gun { "v_rocket", "g_rocket", "w_rlauncher", 4, 12, 50, 54, 1, 15, 2.2f, M::dark_steel, M::gunmetal, M::red_paint },
    Gun { "v_hyperb", "g_hyperb", "w_hyperblaster", 5, 20, 49, 53, 3, 9, 0.7f, M::steel, M::gunmetal, M::glow_teal },
    Gun { "v_rail", "g_rail", "w_railgun", 3, 18, 56, 61, 2, 17, 0.6f, M::white_paint, M::gunmetal, M::glow_blue },
    Gun { "v_bfg", "g_bfg", "w_bfg", 8, 32, 55, 58, 1, 10, 2.8f, M::gunmetal, M::dark_steel, M::glow_green },
};
}

std::span<const Gun> guns() { return all_guns; }

Mesh make_gun(const Gun& gun)
{
    Mesh m;
    const float r = gun.barrel_radius;
    const float spread = gun.barrels > 1 ? r * (gun.barrels > 3 ? 2.1f : 1.25f) : 0.0f;
    const float half = 1.4f + 0.35f * (r + spread);
    // Receiver, its upper cover and a sloped nose.
    m.box({ -4, -half, -1.4f }, { 5, half, 2.2f }, gun.body);
    m.tapered_box({ -3.4f, -half * 0.8f, 2.2f }, { 4.4f, half * 0.8f, 3.2f }, 0.8f, M::gunmetal);
    m.tube({ 5, 0, 0.4f }, { 7.4f, 0, 0.4f }, half * 1.1f, (r + spread) * 1.15f, gun.body, M::gunmetal);
    m.box({ -1.2f, -half - 0.25f, 0.1f }, { 3.6f, half + 0.25f, 0.9f }, gun.accent); // stripe along both sides
    // Grip, trigger guard, stock.
    m.tapered_box({ -3.2f, -0.9f, -5.6f }, { -0.4f, 0.9f, -1.4f }, 1.0f, M::rubber);
    m.box({ -0.4f, -0.35f, -3.2f }, { 2.2f, 0.35f, -2.8f }, M::gunmetal);
    m.tube({ -5.6f, 0, 0.2f }, { -4, 0, 0.4f }, 0.7f, half * 0.6f, M::rubber, M::gunmetal);
    // Barrels around the axis, with collars.
    for (int i = 0; i < gun.barrels; i++) {
        const float a = 6.2831853f * float(i) / float(gun.barrels) + 0.5236f * float(gun.barrels == 3);
        const glm::vec3 at(0, spread * std::cos(a), 0.4f + spread * std::sin(a));
        m.tube(at + glm::vec3(7, 0, 0), at + glm::vec3(7 + gun.length, 0, 0), r, r * 0.92f, gun.barrel, M::rubber);
    }
    for (const float t : { 0.38f, 0.97f })
        m.tube({ 7 + gun.length * t - 0.7f, 0, 0.4f }, { 7 + gun.length * t + 0.5f, 0, 0.4f }, r + spread + 0.35f,
            r + spread + 0.35f, M::steel, M::gunmetal);
    // Magazine and sight.
    m.tapered_box({ 1.6f, -0.8f, -4.2f }, { 4.4f, 0.8f, -1.4f }, 1.15f, gun.accent);
    m.box({ 2.6f, -0.3f, 3.2f }, { 3.4f, 0.3f, 4.0f }, M::gunmetal);
    m.box({ -2.8f, -0.5f, 3.2f }, { -2.0f, 0.5f, 3.9f }, gun.accent);
    return m;
}

} // namespace vkpt::tools

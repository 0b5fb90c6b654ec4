// SPDX-License-Identifier: GPL-2.0-or-later
// Icons of 24 x 24: a coloured sign on a plate.
#include "tools/asset_generator/pictures.hpp"
#include "tools/asset_generator/tau.hpp"

#include <cmath>

namespace vkpt::tools {

namespace {
using Draw = std::function<void(Canvas&)>;

Picture icon(const std::string& name, glm::vec3 rim, Draw draw)
{
    return { name, 24, 24, [=](Canvas& c) {
                draw_plate(c, { 0, 0 }, { 24, 24 }, 5, rim * 0.75f);
                draw(c);
            } };
}

glm::vec2 spoke(glm::vec2 centre, float radius, float turns)
{
    return centre + glm::vec2(std::cos(turns * tau), std::sin(turns * tau)) * radius;
}

// A gun from the side, muzzle right: body, grip and `barrels` with their length and half width.
Draw gun(float length, float half_width, int barrels, glm::vec3 accent)
{
    return [=](Canvas& c) {
        c.fill(box({ 4, 10 }, { 13, 15 }, 1), ink::grey);
        c.fill(Polygon { { { 5, 14 }, { 9, 14 }, { 8, 19.5f }, { 4, 19.5f } } }, ink::grey * 0.75f);
        for (int i = 0; i < barrels; i++) {
            const float y = 12.2f + (float(i) - float(barrels - 1) * 0.5f) * half_width * 2.3f;
            c.fill(line({ 12, y }, { 12 + length, y }, half_width), ink::pale);
        }
        c.fill(box({ 6, 11 }, { 11, 12.6f }, 0.5f), accent);
        c.fill(circle({ 12.6f + length, 12.2f }, half_width * 0.9f), accent);
    };
}

Draw shield(glm::vec3 colour, int bars)
{
    return [=](Canvas& c) {
        const Polygon body { { { 12, 3.5f }, { 19.5f, 6 }, { 18.5f, 14 }, { 12, 20.5f }, { 5.5f, 14 }, { 4.5f, 6 } } };
        c.fill(body, colour * 0.45f);
        c.fill(outline(body, 0.8f), colour);
        for (int i = 0; i < bars; i++)
            c.fill(box({ 8, 7.2f + 3.2f * float(i) }, { 16, 8.8f + 3.2f * float(i) }, 0.5f), colour);
    };
}

Draw rounds(int count, float radius, float height, glm::vec3 case_colour, glm::vec3 tip)
{
    return [=](Canvas& c) {
        const float step = radius * 2 + 1.2f;
        for (int i = 0; i < count; i++) {
            const float x = 12 + (float(i) - float(count - 1) * 0.5f) * step;
            c.fill(box({ x - radius, 19 - height * 0.62f }, { x + radius, 19.5f }, 0.4f), case_colour);
            c.fill(Polygon { { { x - radius, 19 - height * 0.66f }, { x + radius, 19 - height * 0.66f },
                       { x + radius * 0.35f, 19 - height }, { x - radius * 0.35f, 19 - height } } },
                tip);
        }
    };
}

Draw key_card(glm::vec3 colour)
{
    return [=](Canvas& c) {
        c.fill(box({ 4, 7 }, { 20, 17.5f }, 1.5f), colour * 0.6f);
        c.fill(outline(box({ 4, 7 }, { 20, 17.5f }, 1.5f), 0.6f), colour);
        c.fill(box({ 6.5f, 9.5f }, { 11, 15 }, 0.5f), ink::pale);
        for (int i = 0; i < 3; i++)
            c.fill(box({ 12.5f, 10 + 1.9f * float(i) }, { 18, 10.8f + 1.9f * float(i) }), colour);
    };
}

void draw_cross(Canvas& c)
{
    c.fill(unite(box({ 9.5f, 4.5f }, { 14.5f, 19.5f }, 0.8f), box({ 4.5f, 9.5f }, { 19.5f, 14.5f }, 0.8f)), ink::green);
}
void draw_star(Canvas& c, int points, float inner, glm::vec3 colour)
{
    Polygon star;
    for (int i = 0; i < points * 2; i++)
        star.corners.push_back(spoke({ 12, 12 }, i & 1 ? inner : 8.5f, float(i) / float(points * 2) - 0.25f));
    c.fill(star, colour);
}

std::vector<Picture> weapon_icons()
{
    return {
        icon("w_blaster", ink::amber, gun(4, 1.6f, 1, ink::amber)),
        icon("w_shotgun", ink::amber, gun(7.5f, 1.2f, 1, ink::ember)),
        icon("w_sshotgun", ink::amber, gun(7, 1.2f, 2, ink::ember)),
        icon("w_machinegun", ink::amber, gun(7.5f, 0.8f, 2, ink::pale)),
        icon("w_chaingun", ink::amber, gun(7, 0.8f, 4, ink::pale)),
        icon("w_glauncher", ink::amber, gun(5, 2.6f, 1, ink::green)),
        icon("w_rlauncher", ink::amber, gun(7, 2.8f, 1, ink::ember)),
        icon("w_hyperblaster", ink::amber, gun(6, 0.9f, 3, ink::teal)),
        icon("w_railgun", ink::amber, gun(8, 0.7f, 2, ink::blue)),
        icon("w_bfg", ink::amber, gun(5.5f, 3.4f, 1, ink::green)),
    };
}

std::vector<Picture> ammo_icons()
{
    return {
        icon("a_shells", ink::grey, rounds(3, 2, 9, ink::ember * 0.8f, ink::amber)),
        icon("a_bullets", ink::grey, rounds(4, 1.2f, 13, ink::amber * 0.8f, ink::pale)),
        icon("a_slugs", ink::grey, rounds(2, 1.8f, 15, ink::grey, ink::blue)),
        icon("a_rockets", ink::grey, rounds(2, 2.3f, 16, ink::grey, ink::ember)),
        icon("a_cells", ink::grey,
            [](Canvas& c) {
                c.fill(box({ 6, 6.5f }, { 18, 19.5f }, 1.5f), ink::grey * 0.7f);
                c.fill(box({ 9, 4 }, { 15, 7 }, 0.5f), ink::grey);
                c.fill(Polygon { { { 13, 8 }, { 8.5f, 13.6f }, { 11.4f, 13.6f }, { 10.6f, 18 }, { 15.5f, 12 },
                           { 12.4f, 12 } } },
                    ink::teal);
            }),
        icon("a_grenades", ink::grey,
            [](Canvas& c) {
                c.fill(circle({ 12, 14 }, 5.8f), ink::green * 0.55f);
                c.fill(box({ 6, 13.2f }, { 18, 14.8f }), ink::green);
                c.fill(box({ 10.4f, 5 }, { 13.6f, 9 }, 0.4f), ink::grey);
                c.fill(ring({ 15.6f, 6.2f }, 2, 0.6f), ink::pale);
            }),
    };
}

std::vector<Picture> status_icons()
{
    return {
        icon("i_health", ink::green, draw_cross),
        icon("i_jacketarmor", ink::green, shield(ink::green, 1)),
        icon("i_combatarmor", ink::amber, shield(ink::amber, 2)),
        icon("i_bodyarmor", ink::ember, shield(ink::ember, 3)),
        icon("i_powerscreen", ink::teal, shield(ink::teal, 0)),
        icon("i_powershield", ink::blue, shield(ink::blue, 2)),
        icon("i_help", ink::amber, [](Canvas& c) { draw_centred(c, "?", 12, 4, 16, 3, ink::amber, ink::amber); }),
        icon("i_fixme", ink::ember, [](Canvas& c) { draw_centred(c, "!", 12, 4, 16, 3, ink::ember, ink::ember); }),
        icon("i_pack", ink::grey,
            [](Canvas& c) {
                c.fill(box({ 6, 7 }, { 18, 20 }, 2), ink::grey * 0.7f);
                c.fill(box({ 8, 12 }, { 16, 18 }, 1), ink::grey);
                c.fill(outline(box({ 9, 4 }, { 15, 8 }, 1.5f), 0.7f), ink::pale);
            }),
        icon("i_airstrike", ink::ember,
            [](Canvas& c) {
                c.fill(ring({ 12, 12 }, 6.5f, 0.7f), ink::ember);
                c.fill(line({ 12, 3.5f }, { 12, 20.5f }, 0.6f), ink::ember);
                c.fill(line({ 3.5f, 12 }, { 20.5f, 12 }, 0.6f), ink::ember);
            }),
    };
}

std::vector<Picture> power_icons()
{
    return {
        icon("p_quad", ink::blue, [](Canvas& c) { draw_star(c, 4, 3, ink::blue); }),
        icon("p_invulnerability", ink::amber, [](Canvas& c) { draw_star(c, 8, 5, ink::amber); }),
        icon("p_silencer", ink::grey,
            [](Canvas& c) {
                c.fill(line({ 5, 12 }, { 19, 12 }, 2.4f), ink::grey);
                for (int i = 0; i < 4; i++)
                    c.fill(circle({ 7 + 3.3f * float(i), 12 }, 0.9f), ink::plate);
            }),
        icon("p_rebreather", ink::teal,
            [](Canvas& c) {
                c.fill(line({ 8, 14 }, { 16, 14 }, 3.2f), ink::teal * 0.6f);
                c.fill(circle({ 8, 14 }, 2), ink::teal);
                c.fill(circle({ 16, 14 }, 2), ink::teal);
                for (int i = 0; i < 3; i++)
                    c.fill(ring({ 9 + 3.4f * float(i), 8 - 1.6f * float(i & 1) }, 1.2f, 0.4f), ink::pale);
            }),
        icon("p_envirosuit", ink::green,
            [](Canvas& c) {
                c.fill(circle({ 12, 8 }, 4.2f), ink::green * 0.6f);
                c.fill(box({ 8.6f, 6.8f }, { 15.4f, 9.6f }, 1.2f), ink::pale);
                c.fill(box({ 6.5f, 12.6f }, { 17.5f, 20 }, 2.5f), ink::green);
            }),
        icon("p_adrenaline", ink::ember,
            [](Canvas& c) {
                c.fill(line({ 7, 17 }, { 15, 9 }, 2.4f), ink::pale);
                c.fill(line({ 8.5f, 15.5f }, { 13, 11 }, 1.5f), ink::ember);
                c.fill(line({ 15, 9 }, { 20, 4 }, 0.5f), ink::grey);
            }),
        icon("p_bandolier", ink::amber,
            [](Canvas& c) {
                c.fill(line({ 4, 5 }, { 20, 19 }, 2.4f), ink::amber * 0.5f);
                for (int i = 0; i < 5; i++) {
                    const glm::vec2 m(6 + 3.0f * float(i), 6.7f + 2.65f * float(i));
                    c.fill(line(m + glm::vec2(1.2f, -1.4f), m - glm::vec2(1.2f, -1.4f), 0.8f), ink::amber);
                }
            }),
    };
}

std::vector<Picture> key_icons()
{
    return {
        icon("k_bluekey", ink::blue, key_card(ink::blue)),
        icon("k_redkey", ink::ember, key_card(ink::ember)),
        icon("k_security", ink::teal, key_card(ink::teal)),
        icon("k_datacd", ink::pale,
            [](Canvas& c) {
                c.fill(circle({ 12, 12 }, 8), ink::grey);
                c.fill(ring({ 12, 12 }, 5.5f, 0.5f), ink::teal);
                c.fill(circle({ 12, 12 }, 2.2f), ink::plate);
            }),
        icon("k_dataspin", ink::violet,
            [](Canvas& c) {
                for (int i = 0; i < 3; i++)
                    c.fill(line({ 12, 12 }, spoke({ 12, 12 }, 7, float(i) / 3 - 0.25f), 1.6f), ink::violet);
                c.fill(circle({ 12, 12 }, 2.6f), ink::pale);
            }),
        icon("k_powercube", ink::blue,
            [](Canvas& c) {
                const Polygon top { { { 12, 4 }, { 19, 8 }, { 12, 12 }, { 5, 8 } } };
                const Polygon left { { { 5, 8.6f }, { 11.6f, 12.4f }, { 11.6f, 20 }, { 5, 16 } } };
                const Polygon right { { { 19, 8.6f }, { 12.4f, 12.4f }, { 12.4f, 20 }, { 19, 16 } } };
                c.fill(top, ink::blue);
                c.fill(left, ink::blue * 0.5f);
                c.fill(right, ink::blue * 0.72f);
            }),
        icon("k_pyramid", ink::amber,
            [](Canvas& c) {
                c.fill(Polygon { { { 12, 4 }, { 12, 19 }, { 4, 17 } } }, ink::amber);
                c.fill(Polygon { { { 12, 4 }, { 20, 17 }, { 12, 19 } } }, ink::amber * 0.6f);
            }),
        icon("k_comhead", ink::grey,
            [](Canvas& c) {
                c.fill(box({ 7, 5 }, { 17, 17 }, 4.5f), ink::grey);
                c.fill(box({ 8.5f, 9 }, { 15.5f, 12 }, 1), ink::ember);
                c.fill(box({ 10, 16 }, { 14, 20 }, 0.5f), ink::grey * 0.7f);
            }),
    };
}
}

std::vector<Picture> icon_pictures()
{
    std::vector<Picture> all = weapon_icons();
    for (auto* more : { &ammo_icons, &status_icons, &power_icons, &key_icons })
        for (Picture& picture : more())
            all.push_back(std::move(picture));
    return all;
}

} // namespace vkpt::tools

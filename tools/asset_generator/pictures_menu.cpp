// SPDX-License-Identifier: GPL-2.0-or-later
// Banners, the main menu, console background, the quit screen.
#include "tools/asset_generator/noise.hpp"
#include "tools/asset_generator/pictures.hpp"
#include "tools/asset_generator/tau.hpp"

#include <cmath>

namespace vkpt::tools {

namespace {

Picture banner(const std::string& name, const std::string& text)
{
    constexpr float height = 17, weight = 3;
    const int width = int(text_width(text, height - weight) + weight) + 48;
    return { name, width, 36, [=](Canvas& c) {
                const float w = float(width);
                draw_plate(c, { 0, 0 }, { w, 30 }, 8, ink::teal_dim);
                draw_centred(c, text, w * 0.5f, 6, height, weight, ink::pale, ink::teal);
                c.fill(Polygon { { { w * 0.5f, 30.5f }, { w - 8, 32 }, { w * 0.5f, 33.5f }, { 8, 32 } } }, ink::amber);
            } };
}

Picture menu_entry(const std::string& name, const std::string& text, bool selected)
{
    return { name, 200, 32,
        [=](Canvas& c) {
            constexpr float height = 21, weight = 3.6f;
            const TextShape shape = text_shape(text, { 6, 6 }, height, weight);
            c.fill([=](glm::vec2 p) { return shape(p - 1.2f) - 0.6f; }, glm::vec3(0.02f));
            if (selected) {
                draw_text(c, text, { 6, 6 }, height, weight, { 1.0f, 0.93f, 0.66f }, { 1.0f, 0.52f, 0.10f });
                const float end = 12 + text_width(text, height - weight);
                c.fill(Polygon { { { 4, 29.5f }, { end, 29 }, { end + 8, 30 }, { end, 31 }, { 4, 31 } } }, ink::amber);
            } else {
                draw_text(c, text, { 6, 6 }, height, weight, { 0.82f, 0.90f, 0.92f }, { 0.32f, 0.52f, 0.58f });
            }
        } };
}

// The pointer beside the main menu: an iris with a light running round it.
Picture cursor(int frame)
{
    return { "m_cursor" + std::to_string(frame), 24, 28, [=](Canvas& c) {
                const glm::vec2 m(12, 14);
                c.fill(circle(m, 11), ink::plate);
                c.fill(ring(m, 10, 0.9f), ink::teal);
                for (int i = 0; i < 3; i++) {
                    const float turn = (float(frame) / 15 + float(i) / 3) * tau;
                    const glm::vec2 d(std::cos(turn), std::sin(turn));
                    c.fill(line(m + d * 3.6f, m + d * 7.2f, 1.1f), ink::teal);
                    c.fill(circle(m + d * 10.0f, 1.9f), ink::amber);
                }
                const float pulse = 0.5f + 0.5f * std::sin(float(frame) / 15 * tau);
                c.fill(circle(m, 2.2f + pulse * 0.9f), glm::mix(ink::ember, ink::amber, pulse));
            } };
}

void draw_plaque(Canvas& c)
{
    draw_plate(c, { 0, 0 }, { 44, 152 }, 10, ink::teal);
    const char* letters[] = { "V", "K", "P", "T" };
    for (int i = 0; i < 4; i++)
        draw_centred(c, letters[i], 22, 14 + 33.0f * float(i), 25, 4.4f, ink::pale, ink::teal);
    c.fill(Polygon { { { 5, 12 }, { 6.4f, 76 }, { 5, 142 }, { 3.6f, 76 } } }, ink::amber);
}

// Dusk behind a colonnade; beams of light fall across. `glow` places the sun, 0..1.
void draw_dusk(Canvas& c, glm::vec2 sun)
{
    const glm::vec2 size(c.width, c.height);
    c.paint([](glm::vec2) { return -1e3f; },
        [=](glm::vec2 p) {
            const glm::vec2 uv = p / size;
            const float d = glm::length((uv - sun) * glm::vec2(1.3f, 1.0f));
            glm::vec3 sky = glm::mix(
                glm::vec3(0.30f, 0.17f, 0.20f), glm::vec3(0.03f, 0.05f, 0.10f), glm::smoothstep(0.0f, 0.9f, d));
            sky += glm::vec3(0.95f, 0.50f, 0.16f) * std::exp(-d * 7.0f);
            const float angle = std::atan2(uv.y - sun.y, uv.x - sun.x);
            const float beams = smooth_noise({ angle / tau + 0.5f, 0.3f }, { 48, 4 }, 401);
            sky += glm::vec3(0.20f, 0.12f, 0.06f) * glm::smoothstep(0.5f, 0.9f, beams) * std::exp(-d * 2.2f);
            const float grain = hash_unit(int(p.x * 4), int(p.y * 4), 402) - 0.5f;
            return glm::vec4(glm::clamp(sky + grain * 0.012f, 0.0f, 1.0f), 1.0f);
        });
    for (int i = 0; i < 7; i++) { // columns, near ones wider, rims lit from the sun's side
        const float depth = float(i < 3 ? i : 6 - i);
        const float half = 11.0f - depth * 2.6f;
        const float x = i == 3 ? size.x * 2 : size.x * (0.06f + 0.147f * float(i));
        const float top = depth * 16, bottom = size.y - 18 - depth * 14;
        c.fill(box({ x - half, top }, { x + half, bottom }), ink::plate * (0.55f + 0.25f * depth));
        const float rim = x < sun.x * size.x ? x + half - 0.8f : x - half + 0.8f;
        c.fill(line({ rim, top }, { rim, bottom }, 0.7f), glm::vec4(0.96f, 0.55f, 0.2f, 0.75f));
        c.fill(box({ x - half - 3, bottom - 5 }, { x + half + 3, bottom }, 1), ink::plate * (0.8f + 0.25f * depth));
    }
    c.paint(box({ 0, size.y - 60 }, size), // glossy floor
        [=](glm::vec2 p) {
            const float t = (p.y - (size.y - 60)) / 60;
            const float streak = std::exp(-std::abs(p.x - sun.x * size.x) / (18 + 40 * t));
            return glm::vec4(glm::mix(ink::plate, glm::vec3(0.9f, 0.46f, 0.16f), 0.55f * streak), 0.35f + 0.5f * t);
        });
}

void draw_console_back(Canvas& c)
{
    draw_dusk(c, { 0.5f, 0.46f });
    draw_emblem(c, { 160, 84 }, 24);
    draw_centred(c, "PATH TRACED", 160, 118, 12, 1.8f, ink::pale, ink::amber);
    c.fill(box({ 0, 238.4f }, { 320, 240 }), ink::teal);
}

void draw_quit(Canvas& c)
{
    draw_dusk(c, { 0.5f, 0.34f });
    draw_plate(c, { 50, 84 }, { 270, 168 }, 14, ink::teal);
    draw_centred(c, "LEAVE THE LIGHT?", 160, 102, 15, 2.6f, ink::pale, ink::amber);
    draw_centred(c, "Y  YES      N  NO", 160, 138, 11, 1.9f, ink::teal, ink::teal);
}
}

std::vector<Picture> menu_pictures()
{
    std::vector<Picture> list {
        banner("m_banner_addressbook", "ADDRESS BOOK"),
        banner("m_banner_game", "GAME"),
        banner("m_banner_join_server", "JOIN SERVER"),
        banner("m_banner_load_game", "LOAD GAME"),
        banner("m_banner_save_game", "SAVE GAME"),
        banner("m_banner_multiplayer", "MULTIPLAYER"),
        banner("m_banner_options", "OPTIONS"),
        banner("m_banner_video", "VIDEO"),
        { "m_main_plaque", 44, 152, draw_plaque },
        { "m_main_logo", 44, 44,
            [](Canvas& c) {
                draw_emblem(c, { 22, 22 }, 20);
            } },
        { "conback", 320, 240, draw_console_back, 3, 0.9f },
        { "quit", 320, 240, draw_quit, 3, 0.9f },
    };
    for (const auto& [name, text] : { std::pair { "game", "GAME" }, std::pair { "multiplayer", "MULTIPLAYER" },
             std::pair { "options", "OPTIONS" }, std::pair { "video", "VIDEO" }, std::pair { "quit", "QUIT" } }) {
        list.push_back(menu_entry("m_main_" + std::string(name), text, false));
        list.push_back(menu_entry("m_main_" + std::string(name) + "_sel", text, true));
    }
    for (int i = 0; i < 15; i++)
        list.push_back(cursor(i));
    return list;
}

} // namespace vkpt::tools

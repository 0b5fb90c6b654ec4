// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers, crosshairs, notices and panels.
#include "tools/asset_generator/pictures.hpp"
#include "tools/asset_generator/tau.hpp"

#include <cmath>

namespace vkpt::tools {

namespace {

Picture digit(const std::string& name, std::string_view text, glm::vec3 top, glm::vec3 bottom)
{
    return { name, 16, 24, [=, text = std::string(text)](Canvas& c) {
                constexpr float height = 20, weight = 3.6f;
                const float width = text_width(text, height - weight) + weight;
                const glm::vec2 at(7.6f - width * 0.5f, 2);
                c.fill([shape = text_shape(text, at + 0.8f, height, weight + 0.8f)](glm::vec2 p) { return shape(p); },
                    glm::vec3(0.02f));
                draw_text(c, text, at, height, weight, top, bottom);
            } };
}

void draw_crosshair(Canvas& c, int kind)
{
    const glm::vec2 m(8, 8);
    const auto mark = [&](auto shape) {
        c.fill([=](glm::vec2 p) { return shape(p) - 0.6f; }, glm::vec4(0, 0, 0, 1));
        c.fill(shape, kind == 3 ? ink::amber : ink::pale);
    };
    if (kind == 1) { // four ticks and a dot
        for (int i = 0; i < 4; i++) {
            const glm::vec2 d(std::cos(tau * float(i) / 4), std::sin(tau * float(i) / 4));
            mark(line(m + d * 3.5f, m + d * 6.0f, 1.0f));
        }
        mark(circle(m, 1.0f));
    } else if (kind == 2) { // a ring
        mark(ring(m, 5, 0.8f));
        mark(circle(m, 1.0f));
    } else { // a chevron
        mark(line(m, m + glm::vec2(-4.5f, 4.5f), 0.9f));
        mark(line(m, m + glm::vec2(4.5f, 4.5f), 0.9f));
        mark(circle(m - glm::vec2(0, 3), 1.0f));
    }
}

Picture notice(const std::string& name, const std::string& text, glm::vec3 colour)
{
    return { name, 144, 32, [=](Canvas& c) {
                draw_plate(c, { 0, 0 }, { 144, 32 }, 8, colour);
                c.fill(box({ 12, 26 }, { 132, 27 }), colour * 0.6f);
                draw_centred(c, text, 72, 8, 15, 2.6f, ink::pale, colour);
            } };
}

void draw_panel(Canvas& c, std::string_view title)
{
    const glm::vec2 size(c.width, c.height);
    draw_plate(c, { 0, 0 }, size, 12, ink::teal);
    c.fill(outline(chamfered_box({ 5, 5 }, size - 5.0f, 9), 0.35f), ink::teal_dim);
    for (int i = 0; i < 6; i++) // ruled ground
        c.fill(box({ 8, 28.0f + 26.0f * float(i) }, { size.x - 8, 28.4f + 26.0f * float(i) }),
            glm::vec4(ink::teal_dim, 0.25f));
    c.fill(Polygon { { { 14, 0 }, { 14 + 92, 0 }, { 14 + 84, 6 }, { 22, 6 } } }, ink::teal);
    draw_text(c, title, { 26, 1.2f }, 3.8f, 0.9f, ink::plate, ink::plate);
    for (const float x : { 9.0f, size.x - 9 })
        c.fill(circle({ x, size.y - 9 }, 1.4f), ink::amber);
}

void draw_network(Canvas& c)
{
    draw_plate(c, { 0, 0 }, { 64, 64 }, 10, ink::ember);
    c.fill(line({ 12, 42 }, { 26, 34 }, 3), ink::pale);
    c.fill(line({ 38, 28 }, { 52, 20 }, 3), ink::pale);
    for (int i = 0; i < 3; i++) { // sparks in the gap
        const float a = -1.2f + 0.6f * float(i);
        const glm::vec2 d(std::cos(a - 0.7f), std::sin(a - 0.7f));
        c.fill(line(glm::vec2(32, 31) + d * 5.0f, glm::vec2(32, 31) + d * 11.0f, 1), ink::amber);
    }
    draw_centred(c, "NO LINK", 32, 49, 7, 1.3f, ink::ember, ink::ember);
}

void draw_snail(Canvas& c)
{
    draw_plate(c, { 0, 0 }, { 32, 32 }, 6, ink::amber);
    c.fill(line({ 6, 24 }, { 25, 24 }, 2.2f), ink::green);
    c.fill(line({ 25, 24 }, { 27, 14 }, 1.6f), ink::green);
    c.fill(circle({ 28, 11 }, 1.3f), ink::green);
    c.fill(circle({ 15, 16.5f }, 7.5f), ink::amber * 0.7f);
    c.fill(ring({ 15, 16.5f }, 6.2f, 1), ink::amber);
    c.fill(ring({ 16, 17 }, 2.6f, 0.8f), ink::amber);
}

void draw_back_tile(Canvas& c)
{
    c.fill(box({ -1, -1 }, { 65, 65 }), ink::plate);
    for (int y = 0; y < 2; y++)
        for (int x = 0; x < 2; x++) {
            const glm::vec2 at(32.0f * float(x), 32.0f * float(y));
            const auto plate = chamfered_box(at + 1.0f, at + 31.0f, 6);
            c.fill(plate, glm::mix(ink::plate, ink::plate_light, (x ^ y) ? 0.75f : 0.5f));
            c.fill(outline(plate, 0.4f), glm::vec4(ink::teal_dim, 0.7f));
            c.fill(circle(at + 16.0f, 1.1f), ink::teal_dim);
        }
}
}

std::vector<Picture> hud_pictures()
{
    std::vector<Picture> list;
    const glm::vec3 red_top(1.0f, 0.66f, 0.5f);
    for (int i = 0; i <= 10; i++) {
        const std::string text = i < 10 ? std::to_string(i) : "-", name = i < 10 ? text : "minus";
        list.push_back(digit("num_" + name, text, { 0.92f, 0.98f, 1.0f }, { 0.40f, 0.78f, 0.84f }));
        list.push_back(digit("anum_" + name, text, red_top, { 0.94f, 0.22f, 0.12f }));
    }
    for (int i = 1; i <= 3; i++)
        list.push_back({ "ch" + std::to_string(i), 16, 16, [i](Canvas& c) { draw_crosshair(c, i); } });
    list.push_back({ "field_3", 52, 26, [](Canvas& c) {
                        draw_plate(c, { 0, 0 }, { 52, 26 }, 5, ink::ember);
                        c.fill(chamfered_box({ 2, 2 }, { 50, 24 }, 4), glm::vec4(ink::ember, 0.35f));
                    } });
    list.push_back(notice("pause", "PAUSED", ink::amber));
    list.push_back(notice("loading", "LOADING", ink::teal));
    list.push_back({ "net", 64, 64, draw_network });
    list.push_back({ "turtle", 32, 32, draw_snail });
    list.push_back({ "backtile", 64, 64, draw_back_tile });
    list.push_back({ "inventory", 256, 192, [](Canvas& c) { draw_panel(c, "CARGO"); }, 3 });
    list.push_back({ "help", 256, 192, [](Canvas& c) { draw_panel(c, "FIELD LOG"); }, 3 });
    for (const char* name : { "tag1", "tag2" })
        list.push_back({ name, 256, 32, [name](Canvas& c) {
                            draw_plate(c, { 0, 0 }, { 256, 32 }, 8, name[3] == '1' ? ink::amber : ink::teal);
                        } });
    return list;
}

} // namespace vkpt::tools

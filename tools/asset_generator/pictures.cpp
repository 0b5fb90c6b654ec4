// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/pictures.hpp"

#include "common/parallel.hpp"
#include "tools/asset_generator/output.hpp"
#include "tools/asset_generator/palette.hpp"

#include <cmath>

namespace vkpt::tools {

void draw_plate(Canvas& canvas, glm::vec2 low, glm::vec2 high, float cut, glm::vec3 rim)
{
    const auto shape = chamfered_box(low + 0.5f, high - 0.5f, cut);
    canvas.paint(shape, [=](glm::vec2 p) {
        const float t = (p.y - low.y) / (high.y - low.y);
        return glm::vec4(glm::mix(ink::plate_light, ink::plate, t), 1.0f);
    });
    canvas.fill(outline(shape, 0.5f), rim);
}

void draw_text(Canvas& canvas, std::string_view text, glm::vec2 top_left, float height, float weight, glm::vec3 top,
    glm::vec3 bottom)
{
    const TextShape shape = text_shape(text, top_left, height, weight);
    canvas.paint(shape, [=](glm::vec2 p) {
        return glm::vec4(glm::mix(top, bottom, glm::clamp((p.y - top_left.y) / height, 0.0f, 1.0f)), 1.0f);
    });
}

float draw_centred(Canvas& canvas, std::string_view text, float centre_x, float top, float height, float weight,
    glm::vec3 top_ink, glm::vec3 bottom_ink)
{
    const float width = text_width(text, height - weight) + weight;
    draw_text(canvas, text, { centre_x - width * 0.5f, top }, height, weight, top_ink, bottom_ink);
    return width;
}

void draw_emblem(Canvas& canvas, glm::vec2 centre, float radius)
{
    const auto at = [=](float x, float y) { return centre + glm::vec2(x, y) * radius; };
    const Polygon room { { at(0, -1), at(0.87f, -0.5f), at(0.87f, 0.5f), at(0, 1), at(-0.87f, 0.5f),
        at(-0.87f, -0.5f) } };
    canvas.paint(room, [=](glm::vec2 p) {
        const glm::vec2 q = (p - centre) / radius;
        const bool floor = q.y > 0.58f * std::abs(q.x);
        const glm::vec3 wall = q.x < 0 ? glm::vec3(0.07f, 0.20f, 0.23f) : glm::vec3(0.20f, 0.10f, 0.07f);
        return glm::vec4(floor ? glm::vec3(0.10f, 0.12f, 0.14f) : wall, 1.0f);
    });
    const glm::vec2 path[] = { at(0, -0.62f), at(-0.62f, -0.02f), at(0.18f, 0.62f), at(0.60f, -0.10f) };
    for (int i = 0; i < 3; i++)
        canvas.fill(line(path[i], path[i + 1], radius * 0.05f), glm::mix(ink::amber, ink::teal, float(i) / 2.0f));
    for (int i = 1; i < 4; i++)
        canvas.fill(circle(path[i], radius * 0.11f), i < 3 ? ink::pale : ink::teal);
    canvas.fill(circle(path[0], radius * 0.17f), ink::amber);
    canvas.fill(circle(path[0], radius * 0.09f), glm::vec3(1.0f, 0.95f, 0.8f));
    canvas.fill(outline(room, radius * 0.06f), ink::teal);
}

namespace {
formats::Image full_size(const Canvas& canvas)
{
    formats::Image image { canvas.columns(), canvas.rows(), {} };
    image.pixels.reserve(canvas.pixels.size());
    for (const glm::vec4& p : canvas.pixels) {
        const glm::vec4 c = glm::clamp(p, 0.0f, 1.0f) * 255.0f + 0.5f;
        image.pixels.push_back({ uint8_t(c.x), uint8_t(c.y), uint8_t(c.z), uint8_t(c.w) });
    }
    return image;
}
}

void write_pictures(const Output& out)
{
    std::vector<Picture> all = menu_pictures(); // the large ones first
    for (auto* more : { &hud_pictures, &icon_pictures })
        for (Picture& picture : more())
            all.push_back(std::move(picture));
    nearest_index(glm::vec3(0)); // builds the shared table before the threads start
    parallel_for(all.size(), core_count(), [&](size_t i) {
        const Picture& picture = all[i];
        Canvas canvas(picture.width, picture.height, picture.detail);
        picture.draw(canvas);
        const std::vector<glm::vec4> small = canvas.shrink();
        out.write("pics/" + picture.name + ".pcx",
            formats::write_pcx(quantise(picture.width, picture.height, small, picture.dither, true)));
        out.write("pics/" + picture.name + ".png", formats::write_png(full_size(canvas)));
    });
}

} // namespace vkpt::tools

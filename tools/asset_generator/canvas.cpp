// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/canvas.hpp"

#include <cctype>
#include <map>

namespace vkpt::tools {

std::vector<glm::vec4> Canvas::shrink() const
{
    std::vector<glm::vec4> small(size_t(width) * size_t(height));
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            glm::vec3 colour(0);
            float alpha = 0;
            for (int sy = 0; sy < scale; sy++) {
                for (int sx = 0; sx < scale; sx++) {
                    const glm::vec4& p = pixels[size_t(y * scale + sy) * size_t(columns()) + size_t(x * scale + sx)];
                    colour += glm::vec3(p) * p.w;
                    alpha += p.w;
                }
            }
            if (alpha > 0)
                small[size_t(y) * size_t(width) + size_t(x)] = glm::vec4(colour / alpha, alpha / float(scale * scale));
        }
    }
    return small;
}

float segment_distance(glm::vec2 p, glm::vec2 a, glm::vec2 b)
{
    const glm::vec2 along = b - a;
    const float length_squared = glm::dot(along, along);
    const float t = length_squared > 0 ? glm::clamp(glm::dot(p - a, along) / length_squared, 0.0f, 1.0f) : 0.0f;
    return glm::length(p - a - along * t);
}

float Polygon::operator()(glm::vec2 p) const
{
    float distance = 1e9f;
    bool inside = false;
    for (size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
        const glm::vec2 a = corners[i], b = corners[j];
        distance = std::min(distance, segment_distance(p, a, b));
        if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x)
            inside = !inside;
    }
    return inside ? -distance : distance;
}

namespace {
// Strokes on a 5 x 7 lattice: pairs of digits are points (x, y), runs of points are polylines.
const std::map<char, std::string_view>& stroke_font()
{
    static const std::map<char, std::string_view> font {
        { 'A', "060110304146 0343" },
        { 'B', "00063645443303 3342413000" },
        { 'C', "4130100105163645" },
        { 'D', "00063645413000" },
        { 'E', "40000646 0333" },
        { 'F', "400006 0333" },
        { 'G', "41301001051636454323" },
        { 'H', "0006 4046 0343" },
        { 'I', "0006" },
        { 'J', "404536160504" },
        { 'K', "0006 400346" },
        { 'L', "000646" },
        { 'M', "0600234046" },
        { 'N', "06004640" },
        { 'O', "103041453616050110" },
        { 'P', "06003041423303" },
        { 'Q', "103041453616050110 3446" },
        { 'R', "06003041423303 2346" },
        { 'S', "413010010213334445361605" },
        { 'T', "0040 2026" },
        { 'U', "000516364540" },
        { 'V', "0003264340" },
        { 'W', "0006234640" },
        { 'X', "0046 4006" },
        { 'Y', "002340 2326" },
        { 'Z', "00400646" },
        { '0', "103041453616050110" },
        { '1', "112026 1636" },
        { '2', "01103041420646" },
        { '3', "01103041423313 334445361605" },
        { '4', "36300444" },
        { '5', "400003334445361605" },
        { '6', "4130100105163645443303" },
        { '7', "004026" },
        { '8', "103041423313020110 3344453616050413" },
        { '9', "0516364541301001021343" },
        { '-', "0343" },
        { '+', "0343 2125" },
        { '.', "0606" },
        { ':', "0202 0505" },
        { '/', "0640" },
        { '!', "0004 0606" },
        { '?', "01103041422324 2626" },
        { '%', "0640 0101 4545" },
        { '>', "014305" },
    };
    return font;
}

int glyph_width(std::string_view strokes)
{
    int width = 0;
    for (size_t i = 0; i + 1 < strokes.size(); i += 2) {
        if (strokes[i] == ' ')
            i++;
        width = std::max(width, strokes[i] - '0');
    }
    return width;
}

// Calls visit(strokes, x) for each known letter, x in lattice units; returns the whole width.
template <class Visit> float walk_text(std::string_view text, Visit visit)
{
    constexpr float gap = 2, space = 4;
    float x = 0;
    for (const char letter : text) {
        const auto found = stroke_font().find(char(std::toupper(static_cast<unsigned char>(letter))));
        if (found == stroke_font().end()) {
            x += space;
            continue;
        }
        visit(found->second, x);
        x += float(glyph_width(found->second)) + gap;
    }
    return std::max(x - gap, 0.0f);
}
}

float TextShape::operator()(glm::vec2 p) const
{
    float distance = 1e9f;
    for (const auto& [a, b] : strokes) {
        const glm::vec2 away = glm::max(glm::min(a, b) - p, p - glm::max(a, b));
        if (std::max(away.x, away.y) < distance)
            distance = std::min(distance, segment_distance(p, a, b));
    }
    return distance - half_width;
}

TextShape text_shape(std::string_view text, glm::vec2 top_left, float height, float weight)
{
    TextShape shape { {}, weight * 0.5f };
    const float unit = (height - weight) / 6.0f;
    const glm::vec2 origin = top_left + weight * 0.5f;
    walk_text(text, [&](std::string_view strokes, float x) {
        const glm::vec2* previous = nullptr;
        glm::vec2 last {};
        for (size_t i = 0; i + 1 < strokes.size(); i += 2) {
            if (strokes[i] == ' ') {
                previous = nullptr;
                i++;
            }
            const glm::vec2 point = origin + glm::vec2(x + float(strokes[i] - '0'), float(strokes[i + 1] - '0')) * unit;
            if (previous)
                shape.strokes.emplace_back(last, point);
            last = point;
            previous = &last;
        }
    });
    return shape;
}

float text_width(std::string_view text, float height)
{
    return walk_text(text, [](std::string_view, float) {}) * height / 6.0f;
}

} // namespace vkpt::tools

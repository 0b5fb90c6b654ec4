// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

namespace vkpt::tools {

namespace {
struct Ramp {
    int first, count;
    glm::vec3 from, middle, to;
};

// The engine and game address some entries by number: greys 0-15 (smoke, bubbles), 112-127 rail and blue trails,
// 208-215 green sparks, 216-223 yellow, 224-231 blaster sparks, 232-239 blood, 240-243 laser beams.
constexpr std::array ramps {
    Ramp { 0, 16, { 0, 0, 0 }, { 120, 120, 120 }, { 240, 240, 240 } },
    Ramp { 16, 16, { 16, 10, 6 }, { 118, 82, 54 }, { 226, 192, 154 } }, // brown
    Ramp { 32, 16, { 12, 15, 20 }, { 88, 102, 120 }, { 210, 220, 232 } }, // steel
    Ramp { 48, 16, { 24, 20, 12 }, { 146, 128, 94 }, { 246, 234, 206 } }, // sand
    Ramp { 64, 16, { 8, 14, 6 }, { 76, 98, 48 }, { 180, 198, 124 } }, // moss
    Ramp { 80, 16, { 22, 6, 4 }, { 132, 54, 38 }, { 232, 152, 126 } }, // brick
    Ramp { 96, 16, { 2, 16, 20 }, { 24, 126, 138 }, { 164, 244, 244 } }, // teal
    Ramp { 112, 16, { 220, 238, 255 }, { 64, 132, 250 }, { 8, 14, 62 } }, // blue, bright first
    Ramp { 128, 16, { 16, 14, 13 }, { 98, 92, 86 }, { 198, 191, 182 } }, // concrete
    Ramp { 144, 16, { 6, 8, 12 }, { 48, 57, 74 }, { 130, 150, 178 } }, // gunmetal
    Ramp { 160, 16, { 16, 4, 22 }, { 124, 50, 148 }, { 246, 188, 255 } }, // violet
    Ramp { 176, 16, { 34, 4, 0 }, { 232, 92, 14 }, { 255, 244, 184 } }, // fire
    Ramp { 192, 16, { 18, 10, 6 }, { 150, 98, 70 }, { 252, 212, 184 } }, // skin
    Ramp { 208, 8, { 196, 255, 176 }, { 84, 214, 84 }, { 14, 104, 28 } },
    Ramp { 216, 8, { 255, 240, 144 }, { 240, 182, 60 }, { 184, 104, 16 } },
    Ramp { 224, 8, { 255, 255, 224 }, { 255, 214, 96 }, { 255, 146, 20 } },
    Ramp { 232, 8, { 236, 44, 26 }, { 160, 18, 12 }, { 64, 4, 4 } }, Ramp { 240, 1, { 196, 10, 8 }, {}, {} },
    Ramp { 241, 1, { 10, 60, 214 }, {}, {} }, Ramp { 242, 1, { 255, 54, 36 }, {}, {} },
    Ramp { 243, 1, { 48, 124, 255 }, {}, {} }, Ramp { 244, 1, { 61, 235, 255 }, {}, {} },
    Ramp { 245, 1, { 255, 61, 209 }, {}, {} }, Ramp { 246, 1, { 76, 255, 97 }, {}, {} },
    Ramp { 247, 1, { 56, 107, 255 }, {}, {} }, Ramp { 248, 1, { 255, 143, 31 }, {}, {} },
    Ramp { 249, 1, { 255, 255, 255 }, {}, {} }, Ramp { 250, 1, { 58, 28, 84 }, {}, {} },
    Ramp { 251, 1, { 92, 60, 108 }, {}, {} }, Ramp { 252, 1, { 154, 92, 116 }, {}, {} },
    Ramp { 253, 1, { 214, 128, 104 }, {}, {} }, Ramp { 254, 1, { 246, 178, 120 }, {}, {} },
    Ramp { 255, 1, { 104, 84, 104 }, {}, {} }, // transparent in pictures
};

formats::Palette make_palette()
{
    formats::Palette palette;
    for (const Ramp& ramp : ramps) {
        for (int i = 0; i < ramp.count; i++) {
            const float t = ramp.count > 1 ? float(i) / float(ramp.count - 1) : 0.0f;
            const glm::vec3 c = t < 0.5f ? glm::mix(ramp.from, ramp.middle, t * 2.0f)
                                         : glm::mix(ramp.middle, ramp.to, t * 2.0f - 1.0f);
            palette[size_t(ramp.first + i)]
                = { uint8_t(std::lround(c.x)), uint8_t(std::lround(c.y)), uint8_t(std::lround(c.z)), 255 };
        }
    }
    return palette;
}

glm::vec3 palette_colour(int index)
{
    const formats::Rgba8& c = game_palette()[size_t(index)];
    return glm::vec3(c.r, c.g, c.b) / 255.0f;
}

uint8_t search_nearest(glm::vec3 colour)
{
    const glm::vec3 weights(0.9f, 1.2f, 0.7f); // the eye's, roughly
    float best = 1e9f;
    int best_index = 0;
    for (int i = 0; i < transparent_index; i++) {
        const glm::vec3 d = (palette_colour(i) - colour) * weights;
        const float distance = d.x * d.x + d.y * d.y + d.z * d.z;
        if (distance < best) {
            best = distance;
            best_index = i;
        }
    }
    return uint8_t(best_index);
}

constexpr int table_side = 64;

const std::vector<uint8_t>& nearest_table()
{
    static const std::vector<uint8_t> table = [] {
        std::vector<uint8_t> t(size_t(table_side) * table_side * table_side);
        size_t at = 0;
        for (int r = 0; r < table_side; r++)
            for (int g = 0; g < table_side; g++)
                for (int b = 0; b < table_side; b++)
                    t[at++] = search_nearest(glm::vec3(r, g, b) / float(table_side - 1));
        return t;
    }();
    return table;
}

// Bayer's 8 x 8 matrix, -0.5..0.5.
float ordered_threshold(int x, int y)
{
    int value = 0;
    for (int bit = 0; bit < 3; bit++) {
        const int bx = x >> bit & 1, by = y >> bit & 1;
        value |= ((bx ^ by) << 1 | by) << (2 * (2 - bit));
    }
    return (float(value) + 0.5f) / 64.0f - 0.5f;
}
}

const formats::Palette& game_palette()
{
    static const formats::Palette palette = make_palette();
    return palette;
}

uint8_t nearest_index(glm::vec3 colour)
{
    const glm::ivec3 c(glm::clamp(colour, 0.0f, 1.0f) * float(table_side - 1) + 0.5f);
    return nearest_table()[size_t((c.x * table_side + c.y) * table_side + c.z)];
}

formats::IndexedImage quantise(
    int width, int height, std::span<const glm::vec4> pixels, float dither_strength, bool cut_out)
{
    constexpr float palette_step = 16.0f / 255.0f;
    formats::IndexedImage image { width, height, std::vector<uint8_t>(pixels.size()), game_palette() };
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            const size_t at = size_t(y) * size_t(width) + size_t(x);
            const float shift = ordered_threshold(x, y) * palette_step * dither_strength;
            const bool transparent = cut_out && pixels[at].w < 0.5f;
            image.pixels[at] = transparent ? transparent_index : nearest_index(glm::vec3(pixels[at]) + shift);
        }
    }
    return image;
}

formats::IndexedImage make_colormap()
{
    constexpr int light_rows = 64;
    formats::IndexedImage image { 256, light_rows + 256, {}, game_palette() };
    image.pixels.reserve(size_t(256) * (light_rows + 256));
    for (int row = 0; row < light_rows; row++) {
        const float light = 2.0f * float(light_rows - 1 - row) / float(light_rows - 1); // 2 is overbright
        for (int i = 0; i < 256; i++)
            image.pixels.push_back(
                i == transparent_index ? transparent_index : search_nearest(glm::min(palette_colour(i) * light, 1.0f)));
    }
    for (int below = 0; below < 256; below++)
        for (int above = 0; above < 256; above++)
            image.pixels.push_back(nearest_index(glm::mix(palette_colour(below), palette_colour(above), 1.0f / 3.0f)));
    return image;
}

} // namespace vkpt::tools

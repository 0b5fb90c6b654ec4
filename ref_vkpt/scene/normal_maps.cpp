// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/normal_maps.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace vkpt {

namespace {

using formats::Image;
using formats::Rgba8;

// Sums of unit normals (xyz) and metalness (w) over what a texel stands for, as means.
struct Level {
    int width = 0, height = 0;
    std::vector<glm::vec4> means;
};

glm::vec4 read_texel(const Rgba8& texel)
{
    constexpr float min_z = 1e-3f, min_length = 0.05f;
    const glm::vec3 n = (glm::vec3(texel.r, texel.g, texel.b) - 128.0f) / 127.0f;
    const float length = glm::length(n);
    const bool is_outward = n.z > min_z * length && length > min_length;
    return glm::vec4(is_outward ? n / length : glm::vec3(0, 0, 1), float(texel.a) / 255);
}

uint8_t byte_of(float value) { return uint8_t(std::clamp(std::lround(value), 0l, 255l)); }

Rgba8 write_texel(const glm::vec4& mean)
{
    const glm::vec3 n(mean);
    const float length = std::min(glm::length(n), 1.0f); // above 0, as every z is
    const float variance = (1 - length) / length;
    return { byte_of(n.x / length * 127 + 128), byte_of(n.y / length * 127 + 128), byte_of(std::sqrt(variance) * 255),
        byte_of(mean.w * 255) };
}

// Half as wide and high, rounded down, at least 1.
template <class Fetch> Level halve(int width, int height, const Fetch& fetch)
{
    Level to { std::max(width / 2, 1), std::max(height / 2, 1), {} };
    to.means.reserve(size_t(to.width) * size_t(to.height));
    for (int y = 0; y < to.height; y++)
        for (int x = 0; x < to.width; x++) {
            glm::vec4 sum(0);
            for (int corner = 0; corner < 4; corner++)
                sum += fetch(std::min(2 * x + (corner & 1), width - 1), std::min(2 * y + (corner >> 1), height - 1));
            to.means.push_back(sum / 4.0f);
        }
    return to;
}

Image write_level(const Level& level)
{
    Image image { level.width, level.height, {} };
    image.pixels.reserve(level.means.size());
    for (const glm::vec4& mean : level.means)
        image.pixels.push_back(write_texel(mean));
    return image;
}

} // namespace

std::vector<Image> make_normal_levels(const Image& image)
{
    std::vector<Image> levels { { image.width, image.height, {} } };
    levels[0].pixels.reserve(image.pixels.size());
    for (const Rgba8& texel : image.pixels) {
        // What rounding leaves of a unit normal's length says nothing.
        Rgba8 written = write_texel(read_texel(texel));
        written.b = 0;
        levels[0].pixels.push_back(written);
    }
    if (image.width == 1 && image.height == 1)
        return levels;
    // A quarter of the texels, in four times the room: the file's own are never held as floats.
    Level level = halve(image.width, image.height, [&](int x, int y) { return read_texel(image.at(x, y)); });
    levels.push_back(write_level(level));
    while (level.width > 1 || level.height > 1) {
        level = halve(level.width, level.height,
            [&](int x, int y) { return level.means[size_t(y) * size_t(level.width) + size_t(x)]; });
        levels.push_back(write_level(level));
    }
    return levels;
}

} // namespace vkpt

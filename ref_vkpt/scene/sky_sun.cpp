// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/sky_sun.hpp"

#include "common/colour.hpp"
#include "ref_vkpt/scene/texture_files.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <vector>

namespace vkpt {

namespace {

constexpr float min_luminance = 0.6f; // of a texel of the sun
constexpr float min_contrast = 4; // of its texels with the texture's average
constexpr float share_of_brightest = 0.7f; // texels as bright as this belong to it
constexpr float largest_side = 0.15f; // of the texture's: some 13 degrees

} // namespace

std::optional<PaintedSun> find_painted_sun(const formats::Image& image)
{
    float brightest = 0;
    double sum = 0;
    for (const formats::Rgba8& texel : image.pixels) {
        const float light = luminance(decode_colour(texel));
        brightest = std::max(brightest, light);
        sum += double(light);
    }
    if (image.pixels.empty() || brightest < min_luminance
        || double(brightest) < double(min_contrast) * sum / double(image.pixels.size()))
        return std::nullopt;
    glm::ivec2 mins(image.width, image.height), maxs(-1);
    glm::dvec2 place(0);
    glm::dvec3 colour(0);
    double count = 0;
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            const glm::vec3 light = decode_colour(image.at(x, y));
            if (luminance(light) < share_of_brightest * brightest)
                continue;
            mins = { std::min(mins.x, x), std::min(mins.y, y) };
            maxs = { std::max(maxs.x, x), std::max(maxs.y, y) };
            place += glm::dvec2(x + 0.5, y + 0.5);
            colour += glm::dvec3(light);
            count++;
        }
    if (float(maxs.x - mins.x + 1) > std::max(largest_side * float(image.width), 1.0f)
        || float(maxs.y - mins.y + 1) > std::max(largest_side * float(image.height), 1.0f))
        return std::nullopt;
    place /= count;
    return PaintedSun { glm::vec2(place.x / image.width, place.y / image.height) * 2.0f - 1.0f,
        glm::vec3(colour / count) };
}

glm::vec3 direction_on_sky(size_t side, glm::vec2 place)
{
    const float u = place.x, v = place.y;
    const glm::vec3 directions[]
        = { { 1, -u, -v }, { -1, u, -v }, { u, 1, -v }, { -u, -1, -v }, { v, -u, 1 }, { -v, -u, -1 } };
    return glm::normalize(directions[std::min<size_t>(side, 5)]);
}

} // namespace vkpt

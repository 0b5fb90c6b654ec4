// SPDX-License-Identifier: GPL-2.0-or-later
// textures/: each recipe as a WAL (what compilers read) and as a PNG of twice the size (what players see).
#include "common/parallel.hpp"
#include "tools/asset_generator/output.hpp"
#include "tools/asset_generator/palette.hpp"
#include "tools/asset_generator/surface.hpp"

#include <cmath>

namespace vkpt::tools {

namespace {
formats::Image to_image(const std::vector<glm::vec3>& colours, int size)
{
    formats::Image image { size, size, {} };
    image.pixels.reserve(colours.size());
    for (const glm::vec3& c : colours)
        image.pixels.push_back(
            { uint8_t(std::lround(c.x * 255)), uint8_t(std::lround(c.y * 255)), uint8_t(std::lround(c.z * 255)), 255 });
    return image;
}

std::vector<glm::vec4> halve(const std::vector<glm::vec3>& colours, int size)
{
    std::vector<glm::vec4> half;
    half.reserve(colours.size() / 4);
    for (int y = 0; y < size; y += 2) {
        for (int x = 0; x < size; x += 2) {
            const size_t at = size_t(y) * size_t(size) + size_t(x);
            const glm::vec3 sum
                = colours[at] + colours[at + 1] + colours[at + size_t(size)] + colours[at + size_t(size) + 1];
            half.emplace_back(sum * 0.25f, 1.0f);
        }
    }
    return half;
}

void write_texture(const Output& out, const Texture& texture)
{
    constexpr float wall_dither = 0.45f;
    const int large = texture.size * 2;
    const std::vector<glm::vec3> colours = render_surface(texture.recipe, large);
    out.write("textures/" + texture.name + ".png", formats::write_png(to_image(colours, large)));
    const formats::WallInfo info { texture.name, texture.next_animation, texture.size, texture.size, texture.flags,
        texture.contents, texture.value };
    out.write("textures/" + texture.name + ".wal",
        formats::write_wal(quantise(texture.size, texture.size, halve(colours, large), wall_dither, false), info));
}
}

void write_textures(const Output& out)
{
    std::vector<Texture> all = structural_textures();
    for (auto* more : { &natural_textures, &emissive_textures, &tool_textures })
        for (Texture& texture : more())
            all.push_back(std::move(texture));
    nearest_index(glm::vec3(0)); // builds the shared table before the threads start
    parallel_for(all.size(), core_count(), [&](size_t i) { write_texture(out, all[i]); });
}

} // namespace vkpt::tools

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/module/game_folder.hpp"

#include "common/colour.hpp"
#include "formats/model.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace vkpt::tests {

namespace {

constexpr int picture_size = 16;

formats::IndexedImage make_plain(uint8_t index)
{
    return { picture_size, picture_size, std::vector<uint8_t>(size_t(picture_size * picture_size), index),
        test_palette() };
}

formats::Md2Model make_cube(float half, const std::string& skin)
{
    formats::Md2Model model;
    model.skin_width = model.skin_height = picture_size;
    model.skins = { skin };
    formats::Md2Model::Frame frame;
    frame.name = "cube";
    for (int corner = 0; corner < 8; corner++) {
        const glm::vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        frame.positions.push_back(sign * half);
        frame.normals.push_back(glm::normalize(sign));
        model.texture_coordinates.push_back(glm::vec2(0.5f) + glm::vec2(sign.x, -sign.y) * 0.5f); // v against y
    }
    model.frames.push_back(frame);
    // Each side's corners in order around it; turned where they would face inwards.
    constexpr int sides[6][4]
        = { { 0, 1, 3, 2 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 3, 7, 6 }, { 0, 2, 6, 4 }, { 1, 3, 7, 5 } };
    for (const auto& side : sides)
        for (const auto& [a, b, c] : { std::array { 0, 1, 2 }, std::array { 0, 2, 3 } }) {
            const uint32_t i = uint32_t(side[a]), j = uint32_t(side[b]), k = uint32_t(side[c]);
            const glm::vec3 p = frame.positions[i], q = frame.positions[j], r = frame.positions[k];
            const bool is_outward = glm::dot(glm::cross(q - p, r - p), p + q + r) > 0;
            model.indices.insert(model.indices.end(), { i, is_outward ? j : k, is_outward ? k : j });
        }
    return model;
}

} // namespace

const formats::Palette& test_palette()
{
    static const formats::Palette palette = [] {
        formats::Palette entries;
        for (int i = 0; i < 256; i++)
            entries[size_t(i)] = i < white_index ? formats::Rgba8 { uint8_t(i), uint8_t(i), uint8_t(i), 255 }
                                                 : formats::Rgba8 { uint8_t(i), uint8_t(i * 5), uint8_t(i * 11), 255 };
        entries[white_index] = { 255, 255, 255, 255 };
        entries[red_index] = { 220, 60, 30, 255 };
        entries[green_index] = { 40, 200, 70, 255 };
        entries[blue_index] = { 30, 80, 230, 255 };
        entries[warm_index] = { 230, 200, 150, 255 };
        return entries;
    }();
    return palette;
}

glm::vec3 linear_colour(uint8_t index, float offset)
{
    const auto linear = [offset](uint8_t value) { return float(decode_srgb((value + double(offset)) / 255)); };
    const formats::Rgba8& entry = test_palette()[index];
    return { linear(entry.r), linear(entry.g), linear(entry.b) };
}

GameFolder::GameFolder() { add("pics/colormap.pcx", formats::write_pcx(make_plain(0))); }

void GameFolder::add(const std::string& name, const std::vector<std::byte>& bytes) const
{
    folder_.write("baseq2/" + name, { reinterpret_cast<const char*>(bytes.data()), bytes.size() });
}

void GameFolder::add_text(const std::string& name, std::string_view text) const
{
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    add(name, { bytes, bytes + text.size() });
}

void GameFolder::add_wall(const std::string& name, uint8_t index) const
{
    formats::WallInfo info;
    info.name = name;
    info.width = info.height = picture_size;
    add("textures/" + name + ".wal", formats::write_wal(make_plain(index), info));
}

void GameFolder::add_fence(const std::string& name, uint8_t index) const
{
    add_wall(name, index);
    formats::Image picture = formats::apply_palette(make_plain(index), test_palette(), false);
    for (size_t i = 0; i < picture.pixels.size(); i++)
        if (i % picture_size >= picture_size / 2)
            picture.pixels[i].a = 0;
    add("textures/" + name + ".tga", formats::write_tga(picture));
}

void GameFolder::add_skin(const std::string& path, uint8_t index) const
{
    add(path, formats::write_pcx(make_plain(index)));
}

void GameFolder::add_map(const std::string& name, const formats::Bsp& bsp) const
{
    add("maps/" + name + ".bsp", formats::write_bsp(bsp));
}

std::string GameFolder::add_cube(const std::string& name, float half, uint8_t skin_index) const
{
    const std::string skin = "models/" + name + ".pcx", path = "models/" + name + ".md2";
    add_skin(skin, skin_index);
    add(path, formats::write_md2(make_cube(half, skin)));
    return path;
}

} // namespace vkpt::tests

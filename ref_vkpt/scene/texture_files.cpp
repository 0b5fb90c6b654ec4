// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/texture_files.hpp"

#include "common/colour.hpp"
#include "formats/image_room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace vkpt {

namespace {

constexpr const char* colormap_path = "pics/colormap.pcx";

std::string_view ending_of(std::string_view path)
{
    const size_t dot = path.rfind('.');
    const size_t slash = path.rfind('/');
    if (dot == std::string_view::npos || (slash != std::string_view::npos && dot < slash))
        return {};
    return path.substr(dot);
}

std::string_view without_ending(std::string_view path) { return path.substr(0, path.size() - ending_of(path).size()); }

std::string use_forward_slashes(std::string_view path)
{
    std::string result(path);
    std::ranges::replace(result, '\\', '/');
    return result;
}

bool is_common_ending(std::string_view ending)
{
    return ending == ".tga" || ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

bool is_8_bit_ending(std::string_view ending) { return ending == ".pcx" || ending == ".wal" || ending == ".m8"; }

bool is_readable_ending(std::string_view ending)
{
    return is_common_ending(ending) || is_8_bit_ending(ending) || ending == ".m32";
}

struct Size {
    int width = 0, height = 0;
};

// Width and height of a Quake II texture without decoding its pixels where the format allows.
Size read_size(formats::Bytes bytes, const std::string& path)
{
    const std::string_view ending = ending_of(path);
    const auto of_wall = [](const formats::WallInfo& info) { return Size { info.width, info.height }; };
    if (ending == ".wal")
        return of_wall(formats::read_wal_info(bytes, path));
    if (ending == ".m8")
        return of_wall(formats::read_m8_info(bytes, path));
    if (ending == ".m32")
        return of_wall(formats::read_m32_info(bytes, path));
    if (ending == ".pcx") {
        const formats::Image image = formats::read_image(bytes, path, {});
        return { image.width, image.height };
    }
    return {};
}

std::string describe(const formats::FormatError& error)
{
    return fmt::format("{} is damaged at byte {}: {}", error.file(), error.offset(), error.reason());
}

const std::array<float, 256>& linear_table()
{
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values;
        for (size_t i = 0; i < values.size(); i++)
            values[i] = decode_srgb(float(i) / 255.0f);
        return values;
    }();
    return table;
}

uint8_t encoded_of(float linear) { return uint8_t(std::lround(std::clamp(encode_srgb(linear), 0.0f, 1.0f) * 255.0f)); }

} // namespace

glm::vec3 decode_colour(formats::Rgba8 pixel)
{
    const std::array<float, 256>& table = linear_table();
    return { table[pixel.r], table[pixel.g], table[pixel.b] };
}

TextureFiles::TextureFiles(LoadFile load_file, Report report)
    : load_file_(std::move(load_file))
    , report_(std::move(report))
    , palette_(make_neutral_palette())
{
}

void TextureFiles::load_palette()
{
    palette_ = make_neutral_palette();
    constexpr const char* consequence = "8-bit textures use a substitute palette and have wrong colours";
    const std::optional<std::vector<std::byte>> file = load_file_(colormap_path);
    if (!file) {
        report_(fmt::format("{} is missing: {}; add the game's data", colormap_path, consequence));
        return;
    }
    try {
        palette_ = formats::read_pcx_palette(*file, colormap_path);
        for (formats::Rgba8& entry : palette_)
            entry.a = 255;
        palette_[255].a = 0;
    } catch (const formats::FormatError& error) {
        report_(fmt::format("{}; {}", describe(error), consequence));
    }
}

std::vector<std::string> TextureFiles::original_paths(std::string_view name, TextureUse use)
{
    const std::string path = use_forward_slashes(name);
    switch (use) {
    case TextureUse::wall:
        return { "textures/" + path + ".wal", "textures/" + path + ".m32", "textures/" + path + ".m8" };
    case TextureUse::image:
        if (path.starts_with('/'))
            return { path.substr(1) };
        return { "pics/" + path + ".pcx", "pics/misc/" + path + ".m32", "pics/misc/" + path + ".m8" };
    case TextureUse::sky:
        return { "env/" + path + ".tga", "env/" + path + ".pcx", "env/" + path + ".png", "env/" + path + ".jpg",
            "pics/Skies/" + path + ".m32", "pics/Skies/" + path + ".m8" };
    case TextureUse::skin:
    case TextureUse::sprite:
    case TextureUse::normals:
    case TextureUse::emissive:
        break;
    }
    return { path };
}

std::string TextureFiles::map_path(std::string_view name, TextureUse use, TextureUse map)
{
    return fmt::format(
        "{}{}.tga", without_ending(original_paths(name, use).front()), map == TextureUse::normals ? "_n" : "_light");
}

std::optional<LoadedTexture> TextureFiles::load(std::string_view name, TextureUse use, const TextureWish& wish)
{
    if (name.empty())
        return std::nullopt;
    PixelBudget& budget = use == TextureUse::image ? flat_budget_ : level_budget_;
    if (use == TextureUse::normals || use == TextureUse::emissive)
        return wish.retexturing ? load_replacement(use_forward_slashes(name), {}, budget) : std::nullopt;
    for (const std::string& path : original_paths(name, use)) {
        if (!is_readable_ending(ending_of(path)))
            continue;
        std::optional<LoadedTexture> texture;
        if (wish.retexturing && !wish.file.empty())
            texture = load_replacement(use_forward_slashes(wish.file), path, budget);
        const bool misses_file = wish.retexturing && !wish.file.empty() && !texture;
        if (wish.retexturing && !texture)
            texture = load_replacement(path, path, budget);
        if (!texture)
            texture = load_original(path, wish.doubled, budget);
        if (!texture)
            continue;
        if (misses_file)
            report_(fmt::format("texture_base {} of {} is missing or unusable", wish.file, texture->path));
        // The engine's own renderers ignore the alpha of these; hi-res packs keep other things in it.
        if ((use == TextureUse::skin && wish.alpha == AlphaMeaning::opacity) || use == TextureUse::sky)
            for (formats::Rgba8& pixel : texture->image.pixels)
                pixel.a = 255;
        if (use == TextureUse::wall && wish.retexturing && !wish.mask.empty())
            cut_holes(*texture, wish.mask, budget);
        return texture;
    }
    return std::nullopt;
}

std::optional<LoadedTexture> TextureFiles::load_replacement(
    const std::string& file_path, const std::string& path, PixelBudget& budget) const
{
    for (const char* ending : { ".tga", ".png", ".jpg", ".jpeg" }) {
        LoadedTexture texture;
        texture.path = path;
        texture.file = std::string(without_ending(file_path)) + ending;
        const std::optional<std::vector<std::byte>> file = load_file_(texture.file);
        if (!file)
            continue;
        try {
            texture.image = formats::read_common_image(*file, texture.file, budget.room(file->size()));
            budget.spend(texture.image, file->size());
        } catch (const formats::FormatError& error) {
            report_(describe(error));
            continue;
        }
        Size original;
        try {
            if (const auto original_file = path.empty() ? std::nullopt : load_file_(path))
                original = read_size(*original_file, path);
        } catch (const formats::FormatError&) {
            // The replacement stands in for the damaged original, too.
        }
        if (texture.image.width < original.width || texture.image.height < original.height) {
            report_(fmt::format("{} is not used: its {} x {} pixels are fewer than the {} x {} of {}", texture.file,
                texture.image.width, texture.image.height, original.width, original.height, path));
            continue;
        }
        texture.width = original.width > 0 ? original.width : texture.image.width;
        texture.height = original.height > 0 ? original.height : texture.image.height;
        return texture;
    }
    return std::nullopt;
}

std::optional<LoadedTexture> TextureFiles::load_original(
    const std::string& path, bool doubled, PixelBudget& budget) const
{
    const std::optional<std::vector<std::byte>> file = load_file_(path);
    if (!file)
        return std::nullopt;
    try {
        LoadedTexture texture;
        texture.path = texture.file = path;
        texture.image = is_common_ending(ending_of(path))
            ? formats::read_common_image(*file, path, budget.room(file->size()))
            : formats::read_image(*file, path, palette_);
        texture.width = texture.image.width;
        texture.height = texture.image.height;
        if (doubled && is_8_bit_ending(ending_of(path)) && 4 * texture.image.pixels.size() <= budget.room(file->size()))
            texture.image = double_texture(texture.image);
        budget.spend(texture.image, file->size());
        return texture;
    } catch (const formats::FormatError& error) {
        report_(describe(error));
        return std::nullopt;
    }
}

void TextureFiles::cut_holes(LoadedTexture& texture, const std::string& mask, PixelBudget& budget) const
{
    const std::optional<LoadedTexture> loaded = load_replacement(use_forward_slashes(mask), {}, budget);
    if (!loaded)
        return report_(fmt::format("texture_mask {} of {} is missing or unusable", mask, texture.path));
    constexpr uint8_t least_solid = 128;
    const formats::Image& holes = loaded->image;
    formats::Image& image = texture.image;
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            const int column = int(int64_t(x) * holes.width / image.width),
                      row = int(int64_t(y) * holes.height / image.height);
            image.pixels[size_t(y) * size_t(image.width) + size_t(x)].a
                = holes.at(column, row).r >= least_solid ? 255 : 0;
        }
    texture.has_holes = true;
}

formats::Palette make_neutral_palette()
{
    formats::Palette palette;
    for (int i = 0; i < 256; i++) {
        const int row = i / 16;
        const float value = (float(i % 16) + 1) / 16;
        // Row 0 has no saturation; the others walk around the colour wheel.
        const float saturation = row == 0 ? 0.0f : 0.6f;
        const float hue = float(row - 1) / 15 * 6;
        const auto channel = [&](float centre) {
            const float distance = std::abs(std::remainder(hue - centre, 6.0f));
            const float amount = std::clamp(2.0f - distance, 0.0f, 1.0f);
            return uint8_t(std::lround(255 * value * (1 - saturation + saturation * amount)));
        };
        palette[size_t(i)] = { channel(0), channel(2), channel(4), uint8_t(i == 255 ? 0 : 255) };
    }
    palette[0] = { 0, 0, 0, 255 };
    return palette;
}

TextureMeasure measure_texture(const formats::Image& image, AlphaMeaning meaning)
{
    TextureMeasure measure;
    glm::dvec3 sum(0);
    double weight = 0;
    size_t opaque = 0;
    for (const formats::Rgba8& pixel : image.pixels) {
        const double alpha = meaning == AlphaMeaning::opacity ? pixel.a / 255.0 : 1;
        sum += glm::dvec3(decode_colour(pixel)) * alpha;
        weight += alpha;
        opaque += pixel.a >= 128;
        measure.has_alpha |= pixel.a < 255;
        measure.brightest = std::max({ measure.brightest, pixel.r, pixel.g, pixel.b });
    }
    if (weight > 0)
        measure.average = glm::vec3(sum / weight);
    if (!image.pixels.empty())
        measure.opaque_fraction = float(double(opaque) / double(image.pixels.size()));
    return measure;
}

formats::Image halve_texture(const formats::Image& from)
{
    formats::Image to;
    to.width = std::max(from.width / 2, 1);
    to.height = std::max(from.height / 2, 1);
    to.pixels.resize(size_t(to.width) * size_t(to.height));
    for (int y = 0; y < to.height; y++)
        for (int x = 0; x < to.width; x++) {
            glm::vec3 color(0);
            float alpha = 0;
            for (int corner = 0; corner < 4; corner++) {
                const int from_x = std::min(2 * x + (corner & 1), from.width - 1);
                const int from_y = std::min(2 * y + (corner >> 1), from.height - 1);
                const formats::Rgba8 pixel = from.at(from_x, from_y);
                color += decode_colour(pixel) / 4.0f;
                alpha += float(pixel.a) / 4.0f;
            }
            to.pixels[size_t(y) * size_t(to.width) + size_t(x)]
                = { encoded_of(color.x), encoded_of(color.y), encoded_of(color.z), uint8_t(std::lround(alpha)) };
        }
    return to;
}

formats::Image double_texture(const formats::Image& from)
{
    const int width = 2 * from.width;
    formats::Image to { width, 2 * from.height, std::vector<formats::Rgba8>(4 * from.pixels.size()) };
    for (int y = 0; y < from.height; y++)
        for (int x = 0; x < from.width; x++) {
            const formats::Rgba8 own = from.at(x, y), above = from.at(x, std::max(y - 1, 0)),
                                 below = from.at(x, std::min(y + 1, from.height - 1)),
                                 left = from.at(std::max(x - 1, 0), y),
                                 right = from.at(std::min(x + 1, from.width - 1), y);
            const bool is_edge = above != below && left != right;
            formats::Rgba8* const upper = &to.pixels[size_t(2 * y) * size_t(width) + size_t(2 * x)];
            formats::Rgba8* const lower = upper + width;
            upper[0] = is_edge && left == above ? left : own;
            upper[1] = is_edge && right == above ? right : own;
            lower[0] = is_edge && left == below ? left : own;
            lower[1] = is_edge && right == below ? right : own;
        }
    return to;
}

formats::Image shrink_texture(formats::Image image, int limit)
{
    while (image.width > limit || image.height > limit)
        image = halve_texture(image);
    return image;
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// Finds and decodes the game's textures by the engine's naming rules. No engine, no GPU: files come from a callback.
#pragma once

#include "formats/image.hpp"

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

// What a texture is asked for; decides where it is searched and how it is stored.
//   wall     "e1u1/floor": textures/e1u1/floor.wal
//   skin     full path with ending, always opaque
//   sprite   full path with ending
//   image    "inven": pics/inven.pcx; "/players/male/a_i.pcx": the path behind the slash, as it stands
//   sky      "unit1_rt": env/unit1_rt.tga
//   normals, emissive  full path; any of the usual endings
enum class TextureUse : uint8_t { wall, skin, sprite, image, sky, normals, emissive };
inline constexpr size_t texture_use_count = 7;

// What a texture's alpha says: how much covers what is behind, or something else, as roughness where a normal map is.
enum class AlphaMeaning : uint8_t { opacity, other };

struct TextureWish {
    bool retexturing = false; // replacements are preferred
    std::string file; // full path of the replacement, with any of the usual endings; empty: beside the original
    std::string mask; // of walls: path of a picture that is dark where the texture has holes; empty: it has none
    AlphaMeaning alpha = AlphaMeaning::opacity;
    bool doubled = false; // 8-bit originals come at twice their size
};

struct LoadedTexture {
    std::string path; // the original, whether or not a replacement was loaded: "pics/conchars.pcx"
    std::string file; // what was read
    formats::Image image;
    int width = 0, height = 0; // of the original: texture coordinates and 2D sizes refer to these
    bool has_holes = false; // by a mask: alpha is 0 there, else 255
};

// How many pixels the textures of a level may have together, because an archive of a megabyte can ask for gigabytes: so
// many from any files, and more by the files' size. (Packs for Quake II have a byte for each ten pixels or fewer.)
class PixelBudget {
public:
    static constexpr size_t pixels_of_any_files = size_t(1) << 25, pixels_per_byte = 32;

    // For a texture in a file of so many bytes.
    size_t room(size_t file_bytes) const
    {
        const size_t most = pixels_of_any_files + (bytes_ + file_bytes) * pixels_per_byte;
        return most > pixels_ ? most - pixels_ : 0;
    }
    void spend(const formats::Image& image, size_t file_bytes)
    {
        pixels_ += image.pixels.size();
        bytes_ += file_bytes;
    }

private:
    size_t pixels_ = 0, bytes_ = 0;
};

class TextureFiles {
public:
    using LoadFile = std::function<std::optional<std::vector<std::byte>>(const std::string& path)>;
    using Report = std::function<void(std::string_view line)>;

    // `report` gets one line for every file that is there but cannot be used.
    TextureFiles(LoadFile load_file, Report report);

    // From pics/colormap.pcx; without a usable one, a palette of even steps in grey and hue, and a line that says so.
    void load_palette();
    const formats::Palette& palette() const { return palette_; }

    // Replacements: TGA, PNG, JPG beside the original, not smaller than it.
    // Nothing: no usable file.
    std::optional<LoadedTexture> load(std::string_view name, TextureUse use, const TextureWish& wish);
    // The next level's textures have a budget of their own. Those of 2D are kept from level to level, and so is theirs.
    void begin_level() { level_budget_ = {}; }

    // Where the original may lie, in the order of the search.
    static std::vector<std::string> original_paths(std::string_view name, TextureUse use);
    // Of the map of this use beside a texture: "textures/e1u1/floor_n.tga", "textures/e1u1/floor_light.tga".
    static std::string map_path(std::string_view name, TextureUse use, TextureUse map);

private:
    // `file_path`: of the replacement, whatever its ending; `path`: of the original, empty: there is none.
    std::optional<LoadedTexture> load_replacement(
        const std::string& file_path, const std::string& path, PixelBudget& budget) const;
    std::optional<LoadedTexture> load_original(const std::string& path, bool doubled, PixelBudget& budget) const;
    void cut_holes(LoadedTexture& texture, const std::string& mask, PixelBudget& budget) const;

    LoadFile load_file_;
    Report report_;
    formats::Palette palette_;
    PixelBudget level_budget_, flat_budget_;
};

// Entries that stand in for a missing game palette: row 0 is grey, the others hues, dark to light.
formats::Palette make_neutral_palette();

// Radiance for an sRGB colour, 0..1.
glm::vec3 decode_colour(formats::Rgba8 pixel);

struct TextureMeasure {
    glm::vec3 average { 0 }; // linear RGB, weighted by opacity; black where nothing is opaque
    float opaque_fraction = 1; // share of pixels that pass an alpha test at one half
    bool has_alpha = false; // some pixel is not fully opaque
    uint8_t brightest = 0; // component of all pixels
};
TextureMeasure measure_texture(const formats::Image& image, AlphaMeaning alpha = AlphaMeaning::opacity);

// The next mip level: half as wide and high, rounded down, at least 1; averages linear light.
formats::Image halve_texture(const formats::Image& from);

// Twice as wide and high, by Scale2x (Mazzoleni 2001): a pixel's quarter takes the colour of the two neighbours at its
// corner where these are alike and the other two differ from them, so that diagonal edges get steps half as large. No
// colour is new.
formats::Image double_texture(const formats::Image& from);

// Halves (averaging linear light) until neither side exceeds `limit`.
formats::Image shrink_texture(formats::Image image, int limit);

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/map_compiler/textures.hpp"

#include "common/colour.hpp"
#include "formats/bsp.hpp"
#include "tools/map_compiler/map_source.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace vkpt::tools {

namespace fs = std::filesystem;

namespace {

struct ToolTexture {
    std::string_view name;
    uint32_t flags, contents;
};

// The names under which editors' texture sets carry them.
constexpr ToolTexture tool_textures[] = {
    { "clip", 0, formats::CONTENTS_PLAYERCLIP | formats::CONTENTS_MONSTERCLIP },
    { "trigger", formats::SURF_NODRAW, 0 },
    { "origin", 0, contents_origin },
    { "hint", formats::SURF_HINT, 0 },
    { "skip", formats::SURF_SKIP, 0 },
    { "nodraw", formats::SURF_NODRAW, 0 },
    { "caulk", formats::SURF_NODRAW, 0 },
    { "sky", formats::SURF_SKY, 0 },
    { "areaportal", 0, formats::CONTENTS_AREAPORTAL },
};

std::string lower(std::string text)
{
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

} // namespace

std::vector<std::byte> read_file(const fs::path& path)
{
    std::ifstream stream(path, std::ios::binary | std::ios::ate);
    const auto size = stream ? std::streamoff(stream.tellg()) : std::streamoff(-1);
    std::error_code error;
    if (size < 0 || !fs::is_regular_file(path, error))
        throw MapError(path.string(), 0, "cannot be read; check the name and the permissions");
    std::vector<std::byte> bytes(static_cast<size_t>(size));
    stream.seekg(0);
    stream.read(reinterpret_cast<char*>(bytes.data()), size);
    if (!stream)
        throw MapError(path.string(), 0, "reading failed before the file's end");
    return bytes;
}

TextureLibrary::TextureLibrary(fs::path folder)
    : folder_(std::move(folder))
{
    if (folder_.empty())
        return;
    if (!fs::is_directory(folder_))
        throw MapError(folder_.string(), 0, "is not a folder; give --textures the folder that holds the .wal files");
    const fs::path colormap = folder_ / ".." / "pics" / "colormap.pcx";
    if (fs::exists(colormap))
        palette_ = formats::read_pcx_palette(read_file(colormap), colormap.string());
}

const TextureInfo& TextureLibrary::find(const std::string& name)
{
    const auto [it, is_new] = textures_.try_emplace(name);
    if (is_new)
        it->second = load(name);
    return it->second;
}

TextureInfo TextureLibrary::load(const std::string& name)
{
    TextureInfo info;
    const std::string base = lower(name.substr(name.find_last_of('/') + 1));
    const auto tool = std::ranges::find(tool_textures, std::string_view(base), &ToolTexture::name);
    if (tool != std::end(tool_textures)) {
        info.tool_flags = tool->flags;
        info.tool_contents = tool->contents;
    }
    if (folder_.empty())
        return info;
    fs::path path = folder_ / (name + ".wal");
    if (!fs::exists(path))
        path = folder_ / (lower(name) + ".wal");
    if (!fs::exists(path)) {
        if (tool == std::end(tool_textures))
            missing_.push_back(name);
        return info;
    }
    const std::vector<std::byte> file = read_file(path);
    const formats::WallInfo wall = formats::read_wal_info(file, path.string());
    info.found = true;
    info.flags = wall.flags;
    info.contents = wall.contents;
    info.value = wall.value;
    info.next_animation = wall.next_animation;
    if (palette_)
        read_colours(file, path.string(), info);
    return info;
}

// Emitted light takes the picture's mean colour as stored (not linearised), scaled until its largest part is 1, or, for
// dark pictures, until it is 2 m (m: the largest part before): so the classic tool reads light values. It reflects by
// the same colour, which makes every wall nearly white; we reflect by the picture's linear mean, as the path tracer
// does.
void TextureLibrary::read_colours(formats::Bytes file, const std::string& name, TextureInfo& info) const
{
    const formats::Image image = formats::read_wal(file, name, *palette_);
    glm::dvec3 stored(0), linear(0);
    for (const formats::Rgba8& pixel : image.pixels) {
        const glm::dvec3 colour = glm::dvec3(pixel.r, pixel.g, pixel.b) / 255.0;
        stored += colour;
        for (int i = 0; i < 3; i++)
            linear[i] += decode_srgb(colour[i]);
    }
    const double count = double(std::max<size_t>(1, image.pixels.size()));
    info.reflectivity = linear / count;
    const glm::dvec3 mean = stored / count;
    const double largest = std::max({ mean.x, mean.y, mean.z });
    info.light_colour = largest > 0 ? mean / largest * (largest < 0.5 ? 2 * largest : 1.0) : glm::dvec3(0);
}

} // namespace vkpt::tools

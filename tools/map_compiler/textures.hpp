// SPDX-License-Identifier: GPL-2.0-or-later
// What the compiler wants to know of a texture: flags from its .wal, or from its name where it is one of the editors'
// tool textures, and its colour for the light.
#pragma once

#include "formats/image.hpp"

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vkpt::tools {

// Never in the compiled map: marks the point about which a brush entity turns.
inline constexpr uint32_t contents_origin = 0x1000000;

struct TextureInfo {
    uint32_t flags = 0, contents = 0;
    int value = 0;
    std::string next_animation;
    glm::dvec3 light_colour { 0.5 }; // 0..1, of the light that it emits; see read_colours
    glm::dvec3 reflectivity { 0.5 }; // 0..1, linear: the share of light that a surface sends back
    bool found = false;
    // By the name: or-ed in even where the map or the .wal gives its own.
    uint32_t tool_flags = 0, tool_contents = 0;
};

class TextureLibrary {
public:
    // An empty folder: no pictures; only the tool names mean anything.
    explicit TextureLibrary(std::filesystem::path folder = {});

    const TextureInfo& find(const std::string& name);
    // Names that were asked for and are not in the folder.
    const std::vector<std::string>& missing() const { return missing_; }

private:
    TextureInfo load(const std::string& name);
    void read_colours(formats::Bytes file, const std::string& name, TextureInfo& info) const;

    std::filesystem::path folder_;
    std::optional<formats::Palette> palette_;
    std::map<std::string, TextureInfo> textures_;
    std::vector<std::string> missing_;
};

// The whole file; throws MapError naming it when it cannot be read.
std::vector<std::byte> read_file(const std::filesystem::path& path);

} // namespace vkpt::tools

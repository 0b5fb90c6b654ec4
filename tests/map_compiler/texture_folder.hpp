// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "formats/image.hpp"

#include <cstdint>
#include <filesystem>

namespace vkpt::tests {

// A game folder of its own for one test: pics/colormap.pcx and textures/*.wal. Removed at the end.
// Palette: index 0 black, 1 white, 2 grey (137, 188, 188): in linear light, and so as a reflectivity, (0.25, 0.5, 0.5).
class TextureFolder {
public:
    TextureFolder();
    ~TextureFolder();
    TextureFolder(const TextureFolder&) = delete;
    TextureFolder& operator=(const TextureFolder&) = delete;

    // A plain picture of one palette index.
    void add(const formats::WallInfo& info, uint8_t index) const;
    const std::filesystem::path& root() const { return root_; }
    std::filesystem::path textures() const { return root_ / "textures"; }

private:
    std::filesystem::path root_;
};

} // namespace vkpt::tests

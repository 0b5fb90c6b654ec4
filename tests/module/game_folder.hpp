// SPDX-License-Identifier: GPL-2.0-or-later
// A game's data made for one test, in a folder that vanishes afterwards.
#pragma once

#include "formats/bsp.hpp"
#include "formats/image.hpp"
#include "tests/client/run_program.hpp"

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>

namespace vkpt::tests {

// The palette: entries below 224 are greys of that value, the named ones as they say, the rest are all different.
inline constexpr uint8_t white_index = 224, red_index = 225, green_index = 226, blue_index = 227, warm_index = 228;
const formats::Palette& test_palette();
// Linear colour of a palette entry; `offset` is added to its bytes. Drivers may be wrong by half a byte when they
// decode.
glm::vec3 linear_colour(uint8_t index, float offset = 0);

class GameFolder {
public:
    GameFolder(); // with pics/colormap.pcx
    const std::filesystem::path& path() const { return folder_.path(); }

    // `name` is a path below baseq2.
    void add(const std::string& name, const std::vector<std::byte>& bytes) const;
    void add_text(const std::string& name, std::string_view text) const;
    void add_wall(const std::string& name, uint8_t index) const; // textures/NAME.wal, one colour
    // textures/NAME.wal and, with alpha, NAME.tga: columns of 8 texels, by turns of this colour and holes.
    void add_fence(const std::string& name, uint8_t index) const;
    void add_skin(const std::string& path, uint8_t index) const; // a PCX of one colour
    void add_map(const std::string& name, const formats::Bsp& bsp) const; // maps/NAME.bsp
    // models/NAME.md2: a cube of side 2 * half around its origin, its only skin in one colour.
    std::string add_cube(const std::string& name, float half, uint8_t skin_index) const;

private:
    ScratchFolder folder_;
};

} // namespace vkpt::tests

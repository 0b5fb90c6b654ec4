// SPDX-License-Identifier: GPL-2.0-or-later
// Lights as players write them: in the console, and in the files lights/NAME.txt.
#pragma once

#include "formats/light_code.hpp"

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt::game {

// Says which word of which line is wrong, and what would be right.
class TextError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct Light {
    glm::vec3 origin { 0 }, angles { 0 }; // pitch and yaw of a spot
    glm::vec3 colour { 1 }; // 0..1, as pictures have it (sRGB)
    float value = 300; // as of a map's light entity: lights a room of about so many units
    float radius = 4; // units
    formats::LightStyle style = formats::LightStyle::steady;
    int cone = 0; // degrees; 0: shines to all sides
    float orbit_radius = 0, orbit_seconds = 4; // about `origin`, level; radius 0: stands still
    bool operator==(const Light&) const = default;
};

inline constexpr size_t max_lights = 96;
inline constexpr std::string_view light_file_mark = "# vkpt lights";

// [COLOUR] [VALUE] [RADIUS] [pulse|flicker|sputter] [spot DEGREES] [orbit RADIUS [SECONDS]]; what is not given stays as
// in `light`. COLOUR: a name, or #rrggbb. Throws TextError.
void parse_light_words(std::span<const std::string> words, Light& light);
// The inverse.
std::string describe_light(const Light& light);

// A line a light: `light X Y Z PITCH YAW` and the words above; # begins a comment. Throws TextError with `name` and
// line.
std::vector<Light> parse_light_file(std::string_view text, std::string_view name);
std::string write_light_file(std::span<const Light> lights, std::string_view map);

// As the renderer gets it. `phase`: lights of one style differ by it.
formats::CodedLight code_light(const Light& light, uint32_t phase);

// Words between blanks, up to a comment.
std::vector<std::string> split_words(std::string_view line);
// Hands on the words of each line that has any. A TextError of `read` gets `name` and the line's number in front.
void read_lines(std::string_view text, std::string_view name,
    const std::function<void(const std::vector<std::string>& words)>& read);
// The whole word, finite; otherwise TextError, which calls it `what`.
float parse_number(const std::string& word, std::string_view what, float least, float most);

} // namespace vkpt::game

// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/light_text.hpp"

#include "common/colour.hpp"
#include "common/numbers.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace vkpt::game {

namespace {

using formats::LightStyle;

struct NamedColour {
    std::string_view name;
    uint32_t rgb;
};
constexpr std::array colours {
    NamedColour { "white", 0xffffff },
    NamedColour { "warm", 0xffd2a1 },
    NamedColour { "cold", 0xc9e2ff },
    NamedColour { "red", 0xff2010 },
    NamedColour { "orange", 0xff8020 },
    NamedColour { "yellow", 0xffe030 },
    NamedColour { "green", 0x30ff40 },
    NamedColour { "teal", 0x20e0c0 },
    NamedColour { "blue", 0x3060ff },
    NamedColour { "purple", 0xa040ff },
    NamedColour { "pink", 0xff60b0 },
};
constexpr std::array<std::string_view, 4> style_names { "steady", "pulse", "flicker", "sputter" };

glm::vec3 unpack(uint32_t rgb) { return glm::vec3(rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255) / 255.0f; }

uint32_t pack(glm::vec3 colour)
{
    const auto byte = [](float share) { return uint32_t(std::lround(std::clamp(share, 0.0f, 1.0f) * 255)); };
    return byte(colour.x) << 16 | byte(colour.y) << 8 | byte(colour.z);
}

bool parse_colour(const std::string& word, glm::vec3& colour)
{
    for (const NamedColour& named : colours)
        if (named.name == word) {
            colour = unpack(named.rgb);
            return true;
        }
    if (!word.starts_with('#'))
        return false;
    uint32_t rgb = 0;
    const char* end = word.data() + word.size();
    const auto result = std::from_chars(word.data() + 1, end, rgb, 16);
    if (word.size() != 7 || result.ec != std::errc() || result.ptr != end)
        throw TextError(fmt::format("'{}' is no colour: #rrggbb, such as #ff8000", word));
    colour = unpack(rgb);
    return true;
}

bool is_number(const std::string& word) { return word.find_first_of("0123456789") == 0 || word.starts_with('.'); }

// One word after another.
class Words {
public:
    explicit Words(std::span<const std::string> words)
        : words_(words)
    {
    }
    bool empty() const { return words_.empty(); }
    bool number_follows() const { return !empty() && is_number(words_.front()); }
    std::string take(std::string_view what)
    {
        if (empty())
            throw TextError(fmt::format("{} is missing at the end", what));
        const std::string word = words_.front();
        words_ = words_.subspan(1);
        return word;
    }
    float take_number(std::string_view what, float least, float most)
    {
        return parse_number(take(what), what, least, most);
    }

private:
    std::span<const std::string> words_;
};

void parse_word(const std::string& word, Words& rest, Light& light)
{
    if (const auto style = std::ranges::find(style_names, word); style != style_names.end()) {
        light.style = LightStyle(style - style_names.begin());
    } else if (word == "spot") {
        light.cone = int(rest.take_number("the cone's width in degrees", 0, 180));
    } else if (word == "orbit") {
        light.orbit_radius = rest.take_number("the orbit's radius", 0, 1024);
        if (rest.number_follows())
            light.orbit_seconds = rest.take_number("the orbit's seconds", 0.5f, 600);
    } else if (!parse_colour(word, light.colour)) {
        throw TextError(
            fmt::format("'{}' says nothing about a light: [COLOUR] [VALUE] [RADIUS] [pulse|flicker|sputter] "
                        "[spot DEGREES] [orbit RADIUS [SECONDS]]",
                word));
    }
}

Light parse_light_line(std::span<const std::string> words)
{
    Words rest(words);
    if (const std::string first = rest.take("'light'"); first != "light")
        throw TextError(fmt::format("a line begins with 'light', not with '{}'", first));
    Light light;
    constexpr float farthest = 32768;
    for (int i = 0; i < 3; i++)
        light.origin[i] = rest.take_number("the place (x y z)", -farthest, farthest);
    for (int i = 0; i < 2; i++)
        light.angles[i] = rest.take_number("the direction (pitch yaw)", -360, 360);
    parse_light_words(words.subspan(6), light);
    return light;
}

} // namespace

float parse_number(const std::string& word, std::string_view what, float least, float most)
{
    const std::optional<float> value = vkpt::parse_number<float>(word);
    if (!value)
        throw TextError(fmt::format("{} is a number, not '{}'", what, word));
    if (*value < least || *value > most)
        throw TextError(fmt::format("{} is {}, but has to be from {} to {}", what, word, least, most));
    return *value;
}

std::vector<std::string> split_words(std::string_view line)
{
    std::vector<std::string> words;
    constexpr std::string_view blanks = " \t\r";
    for (size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;
         at = line.find_first_not_of(blanks, at)) {
        const size_t end = std::min(line.find_first_of(blanks, at), line.size());
        const std::string_view word = line.substr(at, end - at);
        // A comment is a # with a blank behind it, or in front of the whole line: #ff8000 is a colour.
        if (word == "#" || (words.empty() && word.starts_with('#')))
            break;
        words.emplace_back(word);
        at = end;
    }
    return words;
}

void parse_light_words(std::span<const std::string> words, Light& light)
{
    Words rest(words);
    int numbers = 0;
    while (!rest.empty()) {
        if (!rest.number_follows()) {
            const std::string word = rest.take("a word");
            parse_word(word, rest, light);
        } else if (numbers++ == 0) {
            light.value = rest.take_number("the value", formats::min_light_value, 1900);
        } else if (numbers == 2) {
            light.radius = rest.take_number("the radius", formats::light_radii.front(), formats::light_radii.back());
        } else {
            throw TextError(
                fmt::format("'{}' is one number too many: a light has a value and a radius", rest.take("")));
        }
    }
}

std::string describe_light(const Light& light)
{
    std::string text = fmt::format("#{:06x} {} {}", pack(light.colour), light.value, light.radius);
    if (light.style != LightStyle::steady)
        text += fmt::format(" {}", style_names[size_t(light.style)]);
    if (light.cone > 0)
        text += fmt::format(" spot {}", light.cone);
    if (light.orbit_radius > 0)
        text += fmt::format(" orbit {} {}", light.orbit_radius, light.orbit_seconds);
    return text;
}

void read_lines(std::string_view text, std::string_view name,
    const std::function<void(const std::vector<std::string>& words)>& read)
{
    for (size_t at = 0, number = 1; at < text.size(); number++) {
        const size_t end = std::min(text.find('\n', at), text.size());
        const std::vector<std::string> words = split_words(text.substr(at, end - at));
        at = end + 1;
        if (words.empty())
            continue;
        try {
            read(words);
        } catch (const TextError& error) {
            throw TextError(fmt::format("{}, line {}: {}", name, number, error.what()));
        }
    }
}

std::vector<Light> parse_light_file(std::string_view text, std::string_view name)
{
    std::vector<Light> lights;
    read_lines(text, name, [&](const std::vector<std::string>& words) {
        lights.push_back(parse_light_line(words));
        if (lights.size() > max_lights)
            throw TextError(fmt::format("more than {} lights", max_lights));
    });
    return lights;
}

std::string write_light_file(std::span<const Light> lights, std::string_view map)
{
    std::string text = fmt::format(
        "{} of {}: light X Y Z PITCH YAW #rrggbb VALUE RADIUS ... (docs/game.md)\n", light_file_mark, map);
    for (const Light& light : lights)
        text += fmt::format("light {} {} {} {} {} {}\n", light.origin.x, light.origin.y, light.origin.z, light.angles.x,
            light.angles.y, describe_light(light));
    return text;
}

formats::CodedLight code_light(const Light& light, uint32_t phase)
{
    formats::CodedLight coded;
    coded.colour = { decode_srgb(light.colour.x), decode_srgb(light.colour.y), decode_srgb(light.colour.z) };
    coded.value = light.value;
    coded.radius = light.radius;
    coded.style = light.style;
    coded.phase = phase;
    return coded;
}

} // namespace vkpt::game

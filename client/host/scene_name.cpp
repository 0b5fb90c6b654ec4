// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/scene_name.hpp"

#include "client/host/errors.hpp"
#include "common/numbers.hpp"

#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace vkpt::client {

namespace {

std::vector<float> parse_numbers(std::string_view text, std::string_view whole)
{
    std::vector<float> numbers;
    while (true) {
        const std::string_view part = text.substr(0, text.find(','));
        const std::optional<float> number = parse_number<float>(part);
        if (!number)
            throw WrongUse(
                fmt::format("\"{}\": \"{}\" in the camera is not a number; write @x,y,z,pitch,yaw", whole, part));
        numbers.push_back(*number);
        if (part.size() == text.size())
            return numbers;
        text.remove_prefix(part.size() + 1);
    }
}

Camera parse_camera(std::string_view text, std::string_view whole)
{
    const std::vector<float> n = parse_numbers(text, whole);
    if (n.size() != 3 && n.size() != 5)
        throw WrongUse(
            fmt::format("\"{}\": a camera has 3 or 5 numbers, not {}; write @x,y,z,pitch,yaw", whole, n.size()));
    return { { n[0], n[1], n[2] }, n.size() == 5 ? n[3] : 0, n.size() == 5 ? n[4] : 0 };
}

} // namespace

SceneName parse_scene_name(std::string_view text)
{
    const size_t at = text.rfind('@');
    SceneName scene;
    scene.map = text.substr(0, at);
    if (!scene.map.ends_with(".bsp"))
        throw WrongUse(
            fmt::format("\"{}\" is not a scene: write maps/NAME.bsp or maps/NAME.bsp@x,y,z,pitch,yaw", text));
    if (at != std::string_view::npos)
        scene.camera = parse_camera(text.substr(at + 1), text);
    std::error_code ignored;
    const std::filesystem::path path(scene.map);
    if (!scene.map.starts_with("maps/") && std::filesystem::is_regular_file(path, ignored)) {
        scene.file = path;
        scene.map = "maps/" + path.filename().string();
    }
    return scene;
}

} // namespace vkpt::client

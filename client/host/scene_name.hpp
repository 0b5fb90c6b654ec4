// SPDX-License-Identifier: GPL-2.0-or-later
// SCENE on the command line, where it is a map.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace vkpt::client {

struct Camera {
    glm::vec3 position { 0 }; // the eye
    float pitch = 0, yaw = 0; // degrees, positive pitch looks down
};

// SCENE of the command line: "maps/NAME.bsp[@x,y,z[,pitch,yaw]]".
struct SceneName {
    std::string map; // "maps/NAME.bsp"
    std::filesystem::path file; // a map outside the game's folders, empty: none
    std::optional<Camera> camera;
};

// Throws WrongUse.
SceneName parse_scene_name(std::string_view text);

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// Photographs: vkpt/photos/NAME.png, as shown, and NAME.exr, linear radiance, in the game's own folder.
#pragma once

#include "formats/image.hpp"

#include <filesystem>
#include <span>
#include <string>

namespace vkpt {

struct Photograph {
    formats::Image shown;
    int width = 0, height = 0; // of the radiance
    std::vector<float> radiance; // red, green, blue
};

// Under `name`, or, where that is empty, under the first of photo0001, photo0002, ... that is free. Never over a file
// that is there. All photographs together take at most `max_bytes`. The paths that were written. Throws FileError.
std::vector<std::filesystem::path> save_photograph(
    const std::filesystem::path& game_folder, const std::string& name, const Photograph& photo, uint64_t max_bytes);

} // namespace vkpt

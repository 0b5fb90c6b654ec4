// SPDX-License-Identifier: GPL-2.0-or-later
// Files that players ask the module to write, in the engine's writable game folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace vkpt {

// Servers can set cvars: nothing may be written outside of the game's folder.
bool stays_in_game_directory(const std::string& path);

// Under its final name there is either all of it or nothing. Makes the folders on the way. Returns the reason of a
// failure, "": none.
std::string write_game_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

} // namespace vkpt

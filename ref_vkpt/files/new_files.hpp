// SPDX-License-Identifier: GPL-2.0-or-later
// Files that the player asks for one by one, under new names: photographs, replays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

struct NewFile {
    std::string ending; // ".png"
    std::vector<std::byte> bytes;
};

struct NewFiles {
    std::string_view folder; // vkpt/FOLDER in the game's own folder
    std::string_view stem; // of the names that are counted up
    std::string name; // empty: the first of stem0001, stem0002, ... that is free
    std::span<const NewFile> files; // one for each ending
    uint64_t max_bytes = 0; // of all files in the folder
};

// Why no file may have this name; empty: it may.
std::string check_new_name(std::string_view name);
// Never over a file that is there. The paths that were written. Throws FileError.
std::vector<std::filesystem::path> save_new_files(const std::filesystem::path& game_folder, const NewFiles& wanted);

} // namespace vkpt

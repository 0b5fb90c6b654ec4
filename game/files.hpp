// SPDX-License-Identifier: GPL-2.0-or-later
// The text files of this module, in folders of their own below the engine's writable game folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt::game {

// Where the engine writes for `game` (empty: baseq2). It tells its game library of no folder, so this follows its
// rules: `command_line` for -portable and -cfgdir, else $HOME/.yq2, or with newer engines $XDG_DATA_HOME/YamagiQ2,
// whichever is there. nullopt: none is.
struct Surroundings {
    std::vector<std::string> command_line;
    std::filesystem::path engine_folder, home, data_home; // data_home: $XDG_DATA_HOME, may be empty
};
Surroundings read_surroundings();
std::optional<std::filesystem::path> find_write_folder(const Surroundings& surroundings, std::string_view game);

// `folder` (such as "lights") below `base`; files are called NAME.txt, NAME being letters, digits, _ and -. Links are
// not followed. Files of other people's, which do not begin with `mark`, are not written over.
class TextFiles {
public:
    TextFiles(std::filesystem::path base, std::string folder, std::string mark);

    // Throw FileError.
    void write(std::string_view name, std::string_view text) const;
    std::string read(std::string_view name) const;
    bool exists(std::string_view name) const;
    // For messages: "lights/NAME.txt".
    std::string describe(std::string_view name) const;

    static constexpr size_t max_bytes = 1 << 20;

private:
    std::filesystem::path base_;
    std::string folder_, mark_;
};

} // namespace vkpt::game

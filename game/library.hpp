// SPDX-License-Identifier: GPL-2.0-or-later
// Finds and loads the game library that does the playing.
#pragma once

#include "game/contract.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt::game {

// A loaded game library; unloaded at the end of life.
class GameLibrary {
public:
    GameLibrary() = default;
    GameLibrary(GameLibrary&& other) noexcept;
    GameLibrary& operator=(GameLibrary&& other) noexcept;
    ~GameLibrary();

    Exports* exports() const { return exports_; }
    const std::filesystem::path& path() const { return path_; }

    // Calls the library's GetGameAPI with `imports`, which it keeps. nullopt: `reason` tells why.
    static std::optional<GameLibrary> load(const std::filesystem::path& path, Imports& imports, std::string& reason);

private:
    void* handle_ = nullptr;
    Exports* exports_ = nullptr;
    std::filesystem::path path_;
};

// Where the stock game's library may be, the likeliest place first. `engine_folder`: of the engine's executable.
std::vector<std::filesystem::path> list_stock_libraries(const std::filesystem::path& engine_folder);

// What `vkpt_game_library` names: a mod's folder beside the engine's executable, or the path of a file. Servers and
// demos can set console variables: so a path counts only if the engine's command line (its words) has it, too.
// nullopt: `reason` tells why.
std::optional<std::filesystem::path> resolve_library_name(std::string_view name,
    const std::filesystem::path& engine_folder, const std::vector<std::string>& command_line, std::string& reason);

// Of this process.
std::filesystem::path find_engine_folder();
std::vector<std::string> read_command_line();

} // namespace vkpt::game

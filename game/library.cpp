// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/library.hpp"

#include "ref_vkpt/files/output_folder.hpp"

#include <algorithm>
#include <dlfcn.h>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <utility>

namespace vkpt::game {

GameLibrary::GameLibrary(GameLibrary&& other) noexcept
    : handle_(std::exchange(other.handle_, nullptr))
    , exports_(std::exchange(other.exports_, nullptr))
    , path_(std::move(other.path_))
{
}

GameLibrary& GameLibrary::operator=(GameLibrary&& other) noexcept
{
    std::swap(handle_, other.handle_);
    std::swap(exports_, other.exports_);
    std::swap(path_, other.path_);
    return *this;
}

GameLibrary::~GameLibrary()
{
    if (handle_)
        dlclose(handle_);
}

std::optional<GameLibrary> GameLibrary::load(const std::filesystem::path& path, Imports& imports, std::string& reason)
{
    GameLibrary library;
    library.path_ = path;
    library.handle_ = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library.handle_) {
        reason = dlerror();
        return std::nullopt;
    }
    if (dlsym(library.handle_, "vkpt_game_module")) {
        reason = fmt::format("{} is this module itself, not a game to wrap", path.string());
        return std::nullopt;
    }
    const auto get_api = reinterpret_cast<GetGameApi>(dlsym(library.handle_, "GetGameAPI"));
    if (!get_api) {
        reason = fmt::format("{} is no game library: it has no GetGameAPI", path.string());
        return std::nullopt;
    }
    library.exports_ = get_api(&imports);
    if (!library.exports_) {
        reason = fmt::format("{}: its GetGameAPI returned nothing", path.string());
        return std::nullopt;
    }
    if (library.exports_->api_version != game_api_version) {
        reason = fmt::format("{} has game interface version {}, not {}: it was built for another engine", path.string(),
            library.exports_->api_version, game_api_version);
        return std::nullopt;
    }
    return library;
}

std::vector<std::filesystem::path> list_stock_libraries(const std::filesystem::path& engine_folder)
{
    std::vector<std::filesystem::path> paths;
    for (const std::filesystem::path& folder : { engine_folder, std::filesystem::path("/usr/lib/yamagi-quake2"),
             std::filesystem::path("/usr/lib/games/quake2"), std::filesystem::path("/usr/lib/yquake2") })
        paths.push_back(folder / "baseq2" / "game.so");
    return paths;
}

std::optional<std::filesystem::path> resolve_library_name(std::string_view name,
    const std::filesystem::path& engine_folder, const std::vector<std::string>& command_line, std::string& reason)
{
    if (is_plain_name(name))
        return engine_folder / name / "game.so";
    if (std::ranges::find(command_line, name) != command_line.end())
        return std::filesystem::path(name);
    reason
        = fmt::format("'{}' is neither the name of a folder beside the engine nor, as a path has to be, given on the "
                      "command line: +set vkpt_game_library PATH",
            name);
    return std::nullopt;
}

std::filesystem::path find_engine_folder()
{
    std::error_code error;
    return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

std::vector<std::string> read_command_line()
{
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::vector<std::string> words;
    for (std::string word; std::getline(file, word, '\0');)
        words.push_back(word);
    return words;
}

} // namespace vkpt::game

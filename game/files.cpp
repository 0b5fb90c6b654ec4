// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/files.hpp"

#include "game/library.hpp"
#include "ref_vkpt/files/output_folder.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>

namespace vkpt::game {

namespace {

std::filesystem::path read_variable(const char* name)
{
    const char* value = std::getenv(name);
    return value ? value : "";
}

void check_name(std::string_view name)
{
    if (!is_plain_name(name))
        throw FileError("'" + std::string(name) + "' is no name for a file: letters, digits, _ and - only, at most 64");
}

} // namespace

Surroundings read_surroundings()
{
    return { read_command_line(), find_engine_folder(), read_variable("HOME"), read_variable("XDG_DATA_HOME") };
}

std::optional<std::filesystem::path> find_write_folder(const Surroundings& surroundings, std::string_view game)
{
    const std::vector<std::string>& words = surroundings.command_line;
    const std::string folder(game.empty() ? "baseq2" : game);
    std::vector<std::filesystem::path> places;
    if (std::ranges::find(words, "-portable") != words.end())
        places = { surroundings.engine_folder };
    else if (const auto word = std::ranges::find(words, "-cfgdir"); word != words.end() && word + 1 != words.end())
        places = { surroundings.home / word[1], surroundings.data_home / word[1],
            surroundings.home / ".local/share" / word[1] };
    else
        places = { surroundings.home / ".yq2", surroundings.data_home / "YamagiQ2",
            surroundings.home / ".local/share/YamagiQ2" };
    for (const std::filesystem::path& place : places) {
        std::error_code error;
        if (place.is_absolute() && std::filesystem::is_directory(place / folder, error))
            return place / folder;
    }
    return std::nullopt;
}

TextFiles::TextFiles(std::filesystem::path base, std::string folder, std::string mark)
    : base_(std::move(base))
    , folder_(std::move(folder))
    , mark_(std::move(mark))
{
}

void TextFiles::write(std::string_view name, std::string_view text) const
{
    check_name(name);
    const OutputFolder folder(base_, { folder_ });
    folder.write(std::string(name) + ".txt", std::as_bytes(std::span(text)), mark_);
}

std::string TextFiles::read(std::string_view name) const
{
    check_name(name);
    std::error_code error;
    if (!std::filesystem::exists(std::filesystem::symlink_status(base_ / folder_, error)))
        throw FileError("cannot read " + describe(name) + ": there is no folder " + (base_ / folder_).string());
    return OutputFolder(base_, { folder_ }).read(std::string(name) + ".txt", max_bytes);
}

bool TextFiles::exists(std::string_view name) const
{
    std::error_code error;
    return is_plain_name(name)
        && std::filesystem::exists(
            std::filesystem::symlink_status(base_ / folder_ / (std::string(name) + ".txt"), error));
}

std::string TextFiles::describe(std::string_view name) const { return folder_ + "/" + std::string(name) + ".txt"; }

} // namespace vkpt::game

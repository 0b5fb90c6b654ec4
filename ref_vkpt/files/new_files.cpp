// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/files/new_files.hpp"

#include "ref_vkpt/files/output_folder.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace vkpt {

namespace {

bool is_free(const OutputFolder& folder, const std::string& name, std::span<const NewFile> files)
{
    return std::ranges::none_of(files, [&](const NewFile& file) { return folder.has(name + file.ending); });
}

std::string find_free_name(const OutputFolder& folder, const NewFiles& wanted)
{
    constexpr int most = 9999;
    for (int number = 1; number <= most; number++)
        if (const std::string name = fmt::format("{}{:04}", wanted.stem, number); is_free(folder, name, wanted.files))
            return name;
    throw FileError(fmt::format("{} has {} {}: move some away", folder.path().string(), most, wanted.folder));
}

void check_room(const OutputFolder& folder, const NewFiles& wanted)
{
    uint64_t bytes = 0;
    for (const NewFile& file : wanted.files)
        bytes += file.bytes.size();
    folder.check_room(bytes, { wanted.folder, folder.path(), folder.bytes(), wanted.max_bytes });
}

} // namespace

std::string check_new_name(std::string_view name)
{
    if (is_plain_name(name))
        return {};
    return fmt::format("\"{}\" may have only letters, digits, _ and -, at most 64 of them: the ending, and the folder, "
                       "are added",
        name);
}

std::vector<std::filesystem::path> save_new_files(const std::filesystem::path& game_folder, const NewFiles& wanted)
{
    if (const std::string wrong = wanted.name.empty() ? "" : check_new_name(wanted.name); !wrong.empty())
        throw FileError(wrong);
    const OutputFolder folder(game_folder, { "vkpt", wanted.folder });
    const std::string name = wanted.name.empty() ? find_free_name(folder, wanted) : wanted.name;
    if (!is_free(folder, name, wanted.files)) {
        std::string endings;
        for (const NewFile& file : wanted.files)
            endings += (endings.empty() ? "" : " or ") + file.ending;
        throw FileError(
            fmt::format("{} is there already, as {}: choose another name", (folder.path() / name).string(), endings));
    }
    check_room(folder, wanted);
    std::vector<std::filesystem::path> paths;
    for (const NewFile& file : wanted.files) {
        folder.write(name + file.ending, file.bytes);
        paths.push_back(folder.path() / (name + file.ending));
    }
    return paths;
}

} // namespace vkpt

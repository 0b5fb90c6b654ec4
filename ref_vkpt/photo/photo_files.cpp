// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/photo/photo_files.hpp"

#include "ref_vkpt/files/output_folder.hpp"

#include <fmt/format.h>

namespace vkpt {

namespace {

constexpr uint64_t mebibyte = 1 << 20;
constexpr uint64_t left_on_disk = 256 * mebibyte; // for everybody else

bool is_free(const OutputFolder& folder, const std::string& name)
{
    return !folder.has(name + ".png") && !folder.has(name + ".exr");
}

std::string find_free_name(const OutputFolder& folder)
{
    constexpr int max_photos = 9999;
    for (int number = 1; number <= max_photos; number++)
        if (const std::string name = fmt::format("photo{:04}", number); is_free(folder, name))
            return name;
    throw FileError(fmt::format("{} has {} photographs: move some away", folder.path().string(), max_photos));
}

void check_room(const OutputFolder& folder, uint64_t bytes, uint64_t max_bytes)
{
    if (folder.bytes() + bytes > max_bytes)
        throw FileError(fmt::format("all photographs in {} may take {} MiB: move some away, or start with +set "
                                    "pt_capture_mib and a larger number",
            folder.path().string(), max_bytes / mebibyte));
    if (folder.free_bytes() < left_on_disk + bytes)
        throw FileError(fmt::format("the disk that holds {} is nearly full", folder.path().string()));
}

} // namespace

std::string check_photo_name(std::string_view name)
{
    if (is_plain_name(name))
        return {};
    return fmt::format("\"{}\" may have only letters, digits, _ and -, at most 64 of them: the endings .png and .exr, "
                       "and the folder, are added",
        name);
}

std::vector<std::filesystem::path> save_photograph(
    const std::filesystem::path& game_folder, const std::string& wanted, const Photograph& photo, uint64_t max_bytes)
{
    if (const std::string wrong = wanted.empty() ? "" : check_photo_name(wanted); !wrong.empty())
        throw FileError(wrong);
    const OutputFolder folder(game_folder, { "vkpt", "photos" });
    const std::string name = wanted.empty() ? find_free_name(folder) : wanted;
    if (!is_free(folder, name))
        throw FileError(
            fmt::format("{} is there already, as .png or .exr: choose another name", (folder.path() / name).string()));
    const std::vector<std::byte> shown = formats::write_png(photo.shown);
    const std::vector<std::byte> linear = formats::write_exr(photo.width, photo.height, photo.radiance);
    check_room(folder, shown.size() + linear.size(), max_bytes);
    folder.write(name + ".png", shown);
    folder.write(name + ".exr", linear);
    return { folder.path() / (name + ".png"), folder.path() / (name + ".exr") };
}

} // namespace vkpt

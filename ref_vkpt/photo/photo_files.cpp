// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/photo/photo_files.hpp"

#include "ref_vkpt/files/new_files.hpp"

namespace vkpt {

std::vector<std::filesystem::path> save_photograph(
    const std::filesystem::path& game_folder, const std::string& name, const Photograph& photo, uint64_t max_bytes)
{
    const NewFile files[] = { { ".png", formats::write_png(photo.shown) },
        { ".exr", formats::write_exr(photo.width, photo.height, photo.radiance) } };
    return save_new_files(game_folder, { "photos", "photo", name, files, max_bytes });
}

} // namespace vkpt

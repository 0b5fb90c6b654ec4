// SPDX-License-Identifier: GPL-2.0-or-later
// Where the generated files go.
#pragma once

#include "formats/byte_reader.hpp"

#include <filesystem>
#include <string_view>

namespace vkpt::tools {

class Output {
public:
    explicit Output(std::filesystem::path root)
        : root_(std::move(root))
    {
    }
    // Creates folders as needed. Throws std::runtime_error naming the file that cannot be written.
    void write(std::string_view path, formats::Bytes bytes) const;

private:
    std::filesystem::path root_;
};

// The subjects, each a list of files below the game folder.
void write_palette_and_font(const Output& out);
void write_pictures(const Output& out);
void write_textures(const Output& out);
void write_sky(const Output& out);
void write_weapon_models(const Output& out);
void write_item_models(const Output& out);
void write_player_models(const Output& out);
void write_effect_models(const Output& out);
void write_light_models(const Output& out);
void write_sounds(const Output& out);

} // namespace vkpt::tools

// SPDX-License-Identifier: GPL-2.0-or-later
// Names that servers, maps and models give: of pictures to find, of surfaces to guess, of files to write.
#include "fuzz/support/harness.hpp"
#include "ref_vkpt/files/output_folder.hpp"
#include "ref_vkpt/scene/material_guess.hpp"
#include "ref_vkpt/scene/texture_files.hpp"
#include "ref_vkpt/scene/world.hpp"
#include "tests/formats/samples.hpp"

#include <algorithm>

namespace {

using namespace vkpt;

// Written files stay where they belong: a plain name is one file right in the module's folder.
void check_written(const std::string& name)
{
    if (!is_plain_name(name))
        return;
    const std::filesystem::path folder = "/home/player/.yq2/baseq2/vkpt/bench",
                                path = (folder / name).lexically_normal();
    fuzz::require(
        path.parent_path() == folder && path.filename() == name, "what is written stays in the module's folder");
}

// A few of the names that a picture is searched under are there: what the input's first byte chooses.
void find_pictures(const std::string& name, unsigned present)
{
    static const auto wal = formats::write_wal(samples::make_indexed_image(16, 16), { "wall", "", 16, 16, 0, 0, 0 });
    static const auto pcx = formats::write_pcx(samples::make_indexed_image(8, 8));
    static const auto tga = formats::write_tga(samples::make_image(16, 16));
    unsigned asked = 0;
    const auto load = [&](const std::string& path) -> std::optional<std::vector<std::byte>> {
        if (!(present >> (asked++ % 8) & 1))
            return std::nullopt;
        return path.ends_with(".wal") ? wal : path.ends_with(".pcx") ? pcx : tga;
    };
    TextureFiles files(load, [](std::string_view) {});
    for (size_t use = 0; use < texture_use_count; use++) {
        fuzz::require(!TextureFiles::original_paths(name, TextureUse(use)).empty(), "every picture has a path");
        fuzz::use(files.load(
            name, TextureUse(use), { .retexturing = (present & 1) != 0, .mask = (present & 2) ? "masks/a" : "" }));
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    if (size == 0)
        return 0;
    const std::string name(fuzz::text_of(data + 1, size - 1));
    check_written(name);
    find_pictures(name, data[0]);
    const SurfaceGuess guess = guess_surface(name, {});
    fuzz::require(guess.roughness >= 0 && guess.roughness <= 1 && guess.metallic >= 0 && guess.metallic <= 1,
        "guessed materials are in range");
    return 0;
}

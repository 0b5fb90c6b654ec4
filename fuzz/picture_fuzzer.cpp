// SPDX-License-Identifier: GPL-2.0-or-later
// A picture of one kind: read as the module reads a file with that ending, measured, halved and searched for bright
// parts as a wall's picture is. One program for each kind is built from this, with picture_kind.cpp.
#include "formats/image.hpp"
#include "fuzz/support/harness.hpp"
#include "ref_vkpt/scene/bright_parts.hpp"
#include "ref_vkpt/scene/texture_files.hpp"

extern const char* const picture_kind; // "png", "wal" ...

namespace {

using namespace vkpt;

// Larger ones cost time and show nothing new.
constexpr int largest_measured = 256;

void use_picture(const formats::Image& image)
{
    fuzz::require(
        image.width > 0 && image.height > 0 && image.pixels.size() == size_t(image.width) * size_t(image.height),
        "a picture has as many pixels as its size says");
    if (image.width > largest_measured || image.height > largest_measured)
        return;
    fuzz::use(measure_texture(image));
    fuzz::use(halve_texture(image));
    for (const BrightPart& part : find_bright_parts(image))
        fuzz::require(part.mins.x < part.maxs.x && part.mins.y < part.maxs.y, "bright parts have an area");
}

template <class Read> void try_to(Read read)
{
    try {
        read();
    } catch (const formats::FormatError&) {
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    static const formats::Palette palette = make_neutral_palette();
    const std::string kind = picture_kind, name = "input." + kind;
    const formats::Bytes file = fuzz::bytes_of(data, size);
    try_to([&] { use_picture(formats::read_image(file, name, palette)); });
    if (kind == "pcx")
        try_to([&] { fuzz::use(formats::read_pcx_palette(file, name)); });
    if (kind == "wal")
        try_to([&] { fuzz::use(formats::read_wal_info(file, name)); });
    if (kind == "m8")
        try_to([&] { fuzz::use(formats::read_m8_info(file, name)); });
    if (kind == "m32")
        try_to([&] { fuzz::use(formats::read_m32_info(file, name)); });
    return 0;
}

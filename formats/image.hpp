// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures: Quake II's own (PCX, WAL, M8, M32) and the usual ones (TGA, PNG, JPG), all to RGBA8.
#pragma once

#include "formats/byte_reader.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace formats {

struct Rgba8 {
    uint8_t r = 0, g = 0, b = 0, a = 255;
    bool operator==(const Rgba8&) const = default;
};

using Palette = std::array<Rgba8, 256>; // entry 255 is transparent in pictures (alpha 0), not in walls

struct Image {
    int width = 0, height = 0;
    std::vector<Rgba8> pixels; // row by row from the top left
    const Rgba8& at(int x, int y) const { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
};

// An 8-bit picture before its palette is applied.
struct IndexedImage {
    int width = 0, height = 0;
    std::vector<uint8_t> pixels;
    Palette palette; // PCX: the file's own
};

// What a WAL (or M8/M32) says beside its pixels: compilers copy these into the texinfo.
struct WallInfo {
    std::string name, next_animation;
    int width = 0, height = 0;
    uint32_t flags = 0, contents = 0;
    int32_t value = 0;
};

// Nothing larger than this is accepted: width and height each.
inline constexpr int max_image_size = 16384;
// How many pixels a picture may have, because a file of a few kilobytes can ask for gigabytes. Any file: 4096 x 4096,
// the largest texture or side of a sky in packs for Quake II; decoded, with its mip levels and copies, about 300 MB.
inline constexpr size_t max_pixels_of_any_file = size_t(1) << 24;
// More only in a file that has a byte for each 16 of them, which captures and photographs have by far,
inline constexpr size_t max_pixels_per_byte = 16;
// and never more than 8192 x 8192.
inline constexpr size_t max_pixels = size_t(1) << 26;

IndexedImage read_pcx(Bytes file, std::string_view name);
// The palette of a PCX (pics/colormap.pcx carries the game's).
Palette read_pcx_palette(Bytes file, std::string_view name);
WallInfo read_wal_info(Bytes file, std::string_view name);
Image read_wal(Bytes file, std::string_view name, const Palette& palette);
WallInfo read_m8_info(Bytes file, std::string_view name);
Image read_m8(Bytes file, std::string_view name);
WallInfo read_m32_info(Bytes file, std::string_view name);
Image read_m32(Bytes file, std::string_view name);
// TGA, PNG, JPG by content.
Image read_common_image(Bytes file, std::string_view name);
// By the name's ending; `palette` serves WAL. PCX: index 255 becomes transparent, with the colour of a neighbour.
Image read_image(Bytes file, std::string_view name, const Palette& palette);

// Colours by palette. transparent_255: see Palette.
Image apply_palette(const IndexedImage& indexed, const Palette& palette, bool transparent_255);

std::vector<std::byte> write_pcx(const IndexedImage& image);
std::vector<std::byte> write_wal(const IndexedImage& image, const WallInfo& info); // writes 4 mip levels
std::vector<std::byte> write_png(const Image& image);
std::vector<std::byte> write_tga(const Image& image);
// Portable float map, RGB, linear; rows given top to bottom.
std::vector<std::byte> write_pfm(int width, int height, std::span<const float> rgb);
// The same as OpenEXR, three float32 channels.
std::vector<std::byte> write_exr(int width, int height, std::span<const float> rgb);

} // namespace formats

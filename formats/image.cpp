// SPDX-License-Identifier: GPL-2.0-or-later
// PCX, palettes, and the choice of a reader by a file's name.
#include "formats/image.hpp"
#include "formats/byte_writer.hpp"
#include "formats/image_size.hpp"

#include <algorithm>

namespace formats {

namespace {

constexpr uint8_t pcx_manufacturer = 10, pcx_version = 5, pcx_run_length = 1, pcx_palette_marker = 12;
constexpr uint8_t pcx_run_bits = 0xc0;
constexpr size_t pcx_max_run = 0x3f;
constexpr size_t pcx_palette_size = 256 * 3;

struct PcxHeader {
    uint8_t manufacturer, version, encoding, bits_per_pixel;
    uint16_t x_min, y_min, x_max, y_max, x_dpi, y_dpi;
    std::array<uint8_t, 48> ega_palette;
    uint8_t reserved, planes;
    uint16_t bytes_per_line, palette_type;
    std::array<uint8_t, 58> unused;
};
static_assert(sizeof(PcxHeader) == 128);

PcxHeader read_pcx_header(ByteReader& reader)
{
    const auto header = reader.read<PcxHeader>();
    if (header.manufacturer != pcx_manufacturer || header.encoding != pcx_run_length)
        reader.fail_at(0, "not a run-length encoded PCX file");
    return header;
}

PcxHeader read_indexed_header(ByteReader& reader)
{
    const PcxHeader header = read_pcx_header(reader);
    if (header.bits_per_pixel != 8 || header.planes > 1)
        reader.fail_at(3, "only PCX pictures with 256 colours, or with 24 bits a pixel, are supported");
    return header;
}

void read_pcx_size(ByteReader& reader, const PcxHeader& header, int& width, int& height)
{
    width = header.x_max - header.x_min + 1;
    height = header.y_max - header.y_min + 1;
    check_image_size(reader, 4, width, height);
    check_pixel_budget(reader, width, height);
}

Palette read_trailing_palette(ByteReader& reader)
{
    if (reader.size() < sizeof(PcxHeader) + 1 + pcx_palette_size)
        reader.fail_at(reader.size(), "the file is too short to hold a 256 colour palette");
    reader.seek(reader.size() - pcx_palette_size - 1);
    if (reader.read<uint8_t>() != pcx_palette_marker)
        reader.fail_at(reader.position() - 1, "no 256 colour palette at the file's end");
    Palette palette;
    for (Rgba8& colour : palette) {
        const auto rgb = reader.read<std::array<uint8_t, 3>>();
        colour = { rgb[0], rgb[1], rgb[2], 255 };
    }
    return palette;
}

// `data` ends before the palette. Runs may go on from one line into the next.
std::vector<uint8_t> unpack_pcx(ByteReader& data, size_t size)
{
    if (size > data.remaining() * pcx_max_run)
        data.fail("too little data for a picture of this size");
    std::vector<uint8_t> pixels;
    pixels.reserve(size);
    while (pixels.size() < size) {
        const auto first = data.read<uint8_t>();
        if ((first & pcx_run_bits) != pcx_run_bits) {
            pixels.push_back(first);
            continue;
        }
        const auto value = data.read<uint8_t>();
        pixels.insert(pixels.end(), std::min<size_t>(first & pcx_max_run, size - pixels.size()), value);
    }
    return pixels;
}

bool ends_with(std::string_view name, std::string_view ending)
{
    const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? char(a - 'A' + 'a') : a) == b; };
    return name.size() >= ending.size()
        && std::equal(ending.rbegin(), ending.rend(), name.rbegin(), [&](char b, char a) { return same(a, b); });
}

// The colour of an opaque neighbour, so that filtering at a cut-out's rim does not bleed.
Rgba8 rim_colour(const IndexedImage& indexed, const Palette& palette, int x, int y)
{
    constexpr int steps[8][2]
        = { { 0, -1 }, { 0, 1 }, { -1, 0 }, { 1, 0 }, { -1, -1 }, { 1, -1 }, { -1, 1 }, { 1, 1 } };
    for (const auto& [dx, dy] : steps) {
        const int nx = x + dx, ny = y + dy;
        if (nx < 0 || ny < 0 || nx >= indexed.width || ny >= indexed.height)
            continue;
        const uint8_t index = indexed.pixels[size_t(ny) * size_t(indexed.width) + size_t(nx)];
        if (index != 255)
            return { palette[index].r, palette[index].g, palette[index].b, 0 };
    }
    return { 0, 0, 0, 0 };
}

constexpr uint8_t true_colour_planes = 3;

// Each line holds all its red, then its green, then its blue. There is no palette.
Image read_true_colour(ByteReader& reader, const PcxHeader& header)
{
    Image image;
    read_pcx_size(reader, header, image.width, image.height);
    const size_t width = size_t(image.width), height = size_t(image.height);
    const size_t plane = std::max<size_t>(header.bytes_per_line, width), line = true_colour_planes * plane;
    const std::vector<uint8_t> bytes = unpack_pcx(reader, line * height);
    image.pixels.reserve(width * height);
    for (size_t y = 0; y < height; y++)
        for (size_t at = y * line; at < y * line + width; at++)
            image.pixels.push_back({ bytes[at], bytes[at + plane], bytes[at + 2 * plane], 255 });
    return image;
}

Image read_pcx_image(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    const PcxHeader header = read_pcx_header(reader);
    if (header.bits_per_pixel == 8 && header.planes == true_colour_planes)
        return read_true_colour(reader, header);
    const IndexedImage indexed = read_pcx(file, name);
    return apply_palette(indexed, indexed.palette, true);
}

} // namespace

Palette read_pcx_palette(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    read_indexed_header(reader);
    return read_trailing_palette(reader);
}

IndexedImage read_pcx(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    const PcxHeader header = read_indexed_header(reader);
    IndexedImage image;
    read_pcx_size(reader, header, image.width, image.height);
    image.palette = read_trailing_palette(reader);

    ByteReader data(file.first(file.size() - pcx_palette_size - 1), name);
    data.seek(sizeof(PcxHeader));
    const size_t width = size_t(image.width), height = size_t(image.height);
    const size_t stride = std::max<size_t>(header.bytes_per_line, width);
    image.pixels = unpack_pcx(data, stride * height);
    if (stride > width)
        for (size_t y = 1; y < height; y++)
            std::copy_n(
                image.pixels.begin() + ptrdiff_t(y * stride), width, image.pixels.begin() + ptrdiff_t(y * width));
    image.pixels.resize(width * height);
    return image;
}

std::vector<std::byte> write_pcx(const IndexedImage& image)
{
    check_written_image(image.width, image.height, image.pixels.size());
    PcxHeader header {};
    header.manufacturer = pcx_manufacturer;
    header.version = pcx_version;
    header.encoding = pcx_run_length;
    header.bits_per_pixel = 8;
    header.x_max = uint16_t(image.width - 1);
    header.y_max = uint16_t(image.height - 1);
    header.planes = 1;
    header.bytes_per_line = uint16_t(image.width); // odd widths stay odd: Quake II's own reader knows no padding
    header.palette_type = 1;
    ByteWriter writer;
    writer.write(header);
    for (size_t row = 0; row < image.pixels.size(); row += size_t(image.width)) {
        const auto begin = image.pixels.begin() + ptrdiff_t(row), end = begin + image.width;
        for (auto at = begin; at != end;) {
            const auto limit = end - at > ptrdiff_t(pcx_max_run) ? at + ptrdiff_t(pcx_max_run) : end;
            const auto stop = std::find_if(at, limit, [&](uint8_t pixel) { return pixel != *at; });
            if (stop - at > 1 || (*at & pcx_run_bits) == pcx_run_bits)
                writer.write(uint8_t(pcx_run_bits | (stop - at)));
            writer.write(*at);
            at = stop;
        }
    }
    writer.write(pcx_palette_marker);
    for (const Rgba8& colour : image.palette)
        writer.write(std::array<uint8_t, 3> { colour.r, colour.g, colour.b });
    return writer.take();
}

Image apply_palette(const IndexedImage& indexed, const Palette& palette, bool transparent_255)
{
    Image image { indexed.width, indexed.height, std::vector<Rgba8>(indexed.pixels.size()) };
    for (size_t i = 0; i < indexed.pixels.size(); i++) {
        const uint8_t index = indexed.pixels[i];
        image.pixels[i] = { palette[index].r, palette[index].g, palette[index].b, 255 };
        if (transparent_255 && index == 255)
            image.pixels[i]
                = rim_colour(indexed, palette, int(i % size_t(indexed.width)), int(i / size_t(indexed.width)));
    }
    return image;
}

Image read_image(Bytes file, std::string_view name, const Palette& palette)
{
    if (ends_with(name, ".pcx"))
        return read_pcx_image(file, name);
    if (ends_with(name, ".wal"))
        return read_wal(file, name, palette);
    if (ends_with(name, ".m8"))
        return read_m8(file, name);
    if (ends_with(name, ".m32"))
        return read_m32(file, name);
    return read_common_image(file, name);
}

} // namespace formats

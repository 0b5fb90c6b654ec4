// SPDX-License-Identifier: GPL-2.0-or-later
// Wall pictures: WAL (Quake II), M8 and M32 (later games on its engine).
#include "formats/byte_writer.hpp"
#include "formats/image_size.hpp"

#include <algorithm>
#include <limits>

namespace formats {

namespace {

constexpr size_t wal_mips = 4, wal_name_size = 32;
constexpr size_t m8_mips = 16, m8_name_size = 32;
constexpr size_t m32_mips = 16, m32_name_size = 128;
constexpr int32_t m8_version = 2, m32_version = 4;

struct WallHeader {
    WallInfo info;
    size_t first_level = 0; // byte offset
    Palette palette; // M8 only
};

void read_size(ByteReader& reader, WallInfo& info, uint32_t width, uint32_t height)
{
    check_image_size(reader, reader.position(), width, height);
    check_pixel_budget(reader, width, height);
    info.width = int(width);
    info.height = int(height);
}

WallHeader read_wal_header(ByteReader& reader)
{
    WallHeader header;
    header.info.name = reader.read_string(wal_name_size);
    const auto width = reader.read<uint32_t>(), height = reader.read<uint32_t>();
    read_size(reader, header.info, width, height);
    header.first_level = reader.read<std::array<uint32_t, wal_mips>>()[0];
    header.info.next_animation = reader.read_string(wal_name_size);
    header.info.flags = reader.read<uint32_t>();
    header.info.contents = reader.read<uint32_t>();
    header.info.value = reader.read<int32_t>();
    return header;
}

void check_version(ByteReader& reader, int32_t version, const char* format)
{
    if (const auto found = reader.read<int32_t>(); found != version)
        reader.fail_at(0, std::string("not an ") + format + " picture (version " + std::to_string(found) + ")");
}

WallHeader read_m8_header(ByteReader& reader)
{
    check_version(reader, m8_version, "M8");
    WallHeader header;
    header.info.name = reader.read_string(m8_name_size);
    const auto widths = reader.read<std::array<uint32_t, m8_mips>>(),
               heights = reader.read<std::array<uint32_t, m8_mips>>();
    read_size(reader, header.info, widths[0], heights[0]);
    header.first_level = reader.read<std::array<uint32_t, m8_mips>>()[0];
    header.info.next_animation = reader.read_string(m8_name_size);
    for (Rgba8& colour : header.palette) {
        const auto rgb = reader.read<std::array<uint8_t, 3>>();
        colour = { rgb[0], rgb[1], rgb[2], 255 };
    }
    header.info.flags = reader.read<uint32_t>();
    header.info.contents = reader.read<uint32_t>();
    header.info.value = reader.read<int32_t>();
    return header;
}

WallHeader read_m32_header(ByteReader& reader)
{
    check_version(reader, m32_version, "M32");
    WallHeader header;
    header.info.name = reader.read_string(m32_name_size);
    reader.take(m32_name_size); // a substitute picture
    header.info.next_animation = reader.read_string(m32_name_size);
    reader.take(m32_name_size); // the damaged picture
    const auto widths = reader.read<std::array<uint32_t, m32_mips>>(),
               heights = reader.read<std::array<uint32_t, m32_mips>>();
    read_size(reader, header.info, widths[0], heights[0]);
    header.first_level = reader.read<std::array<uint32_t, m32_mips>>()[0];
    header.info.flags = reader.read<uint32_t>();
    header.info.contents = reader.read<uint32_t>();
    header.info.value = reader.read<int32_t>();
    return header;
}

Image read_indexed_level(ByteReader& reader, const WallHeader& header, const Palette& palette)
{
    const size_t count = size_t(header.info.width) * size_t(header.info.height);
    return apply_palette({ header.info.width, header.info.height,
                             reader.read_array<uint8_t>(header.first_level, count, "pixels"), palette },
        palette, false);
}

uint8_t nearest_index(const Palette& palette, std::array<int, 3> rgb)
{
    int best = 0, best_distance = std::numeric_limits<int>::max();
    for (int i = 0; i < 256; i++) {
        const Rgba8& c = palette[size_t(i)];
        const int r = c.r - rgb[0], g = c.g - rgb[1], b = c.b - rgb[2];
        if (const int distance = r * r + g * g + b * b; distance < best_distance) {
            best = i;
            best_distance = distance;
        }
    }
    return uint8_t(best);
}

// Half the size: each pixel is the palette's entry nearest to the average of four.
IndexedImage halve(const IndexedImage& image)
{
    IndexedImage half { std::max(image.width / 2, 1), std::max(image.height / 2, 1), {}, image.palette };
    half.pixels.reserve(size_t(half.width) * size_t(half.height));
    for (int y = 0; y < half.height; y++) {
        for (int x = 0; x < half.width; x++) {
            std::array<int, 3> sum { 2, 2, 2 }; // rounds
            for (int corner = 0; corner < 4; corner++) {
                const int sx = std::min(2 * x + (corner & 1), image.width - 1);
                const int sy = std::min(2 * y + (corner >> 1), image.height - 1);
                const Rgba8& c = image.palette[image.pixels[size_t(sy) * size_t(image.width) + size_t(sx)]];
                sum = { sum[0] + c.r, sum[1] + c.g, sum[2] + c.b };
            }
            half.pixels.push_back(nearest_index(image.palette, { sum[0] / 4, sum[1] / 4, sum[2] / 4 }));
        }
    }
    return half;
}

} // namespace

WallInfo read_wal_info(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    return read_wal_header(reader).info;
}

Image read_wal(Bytes file, std::string_view name, const Palette& palette)
{
    ByteReader reader(file, name);
    return read_indexed_level(reader, read_wal_header(reader), palette);
}

WallInfo read_m8_info(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    return read_m8_header(reader).info;
}

Image read_m8(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    const WallHeader header = read_m8_header(reader);
    return read_indexed_level(reader, header, header.palette);
}

WallInfo read_m32_info(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    return read_m32_header(reader).info;
}

Image read_m32(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    const WallHeader header = read_m32_header(reader);
    const size_t count = size_t(header.info.width) * size_t(header.info.height);
    return { header.info.width, header.info.height, reader.read_array<Rgba8>(header.first_level, count, "pixels") };
}

std::vector<std::byte> write_wal(const IndexedImage& image, const WallInfo& info)
{
    check_written_image(image.width, image.height, image.pixels.size());
    ByteWriter writer;
    writer.write_string(info.name, wal_name_size);
    writer.write(uint32_t(image.width));
    writer.write(uint32_t(image.height));
    const size_t offsets = writer.position();
    writer.write(std::array<uint32_t, wal_mips> {});
    writer.write_string(info.next_animation, wal_name_size);
    writer.write(info.flags);
    writer.write(info.contents);
    writer.write(info.value);
    IndexedImage level = image;
    for (size_t mip = 0; mip < wal_mips; mip++) {
        if (mip > 0)
            level = halve(level);
        writer.patch(offsets + mip * sizeof(uint32_t), uint32_t(writer.position()));
        writer.write_array(std::span<const uint8_t>(level.pixels));
    }
    return writer.take();
}

} // namespace formats

// SPDX-License-Identifier: GPL-2.0-or-later
// TGA: grey, true-colour and colour-mapped pictures, plain or run-length encoded.
#include "formats/image_tga.hpp"
#include "formats/byte_writer.hpp"
#include "formats/image_size.hpp"

#include <algorithm>

namespace formats {

namespace {

constexpr uint8_t type_run_length = 8; // added to the kinds below
enum Kind : uint8_t { ColourMapped = 1, TrueColour = 2, Grey = 3 };
constexpr uint8_t from_right = 0x10, from_top = 0x20;

struct Header {
    uint8_t id_size = 0, has_map = 0, type = 0;
    std::array<uint8_t, 2> map_first {}, map_count {}; // unaligned 16-bit numbers
    uint8_t map_bits = 0;
    std::array<uint8_t, 2> x {}, y {}, width {}, height {};
    uint8_t bits = 0, descriptor = 0;
};
static_assert(sizeof(Header) == 18);

int number(std::array<uint8_t, 2> bytes) { return bytes[0] | bytes[1] << 8; }
std::array<uint8_t, 2> to_bytes(int value) { return { uint8_t(value & 0xff), uint8_t(value >> 8) }; }

Rgba8 read_colour(ByteReader& reader, int bits)
{
    if (bits == 8) {
        const auto grey = reader.read<uint8_t>();
        return { grey, grey, grey, 255 };
    }
    if (bits == 15 || bits == 16) {
        const auto packed = reader.read<uint16_t>();
        const auto widen = [&](int shift) { return uint8_t((packed >> shift & 31) * 255 / 31); };
        return { widen(10), widen(5), widen(0), 255 };
    }
    const auto bgr = reader.read<std::array<uint8_t, 3>>();
    return { bgr[2], bgr[1], bgr[0], bits == 32 ? reader.read<uint8_t>() : uint8_t(255) };
}

class Decoder {
public:
    Decoder(Bytes file, std::string_view name, size_t room)
        : reader_(file, name)
        , header_(reader_.read<Header>())
    {
        kind_ = Kind(header_.type & ~type_run_length);
        if (!is_known())
            reader_.fail_at(2,
                "not a picture that can be read (neither PNG nor JPG; as TGA: type " + std::to_string(header_.type)
                    + ", " + std::to_string(header_.bits) + " bits)");
        check_image_size(reader_, 12, number(header_.width), number(header_.height));
        check_pixel_budget(reader_, number(header_.width), number(header_.height), room);
        reader_.take(header_.id_size);
        read_map();
    }

    Image decode()
    {
        Image image;
        image.width = number(header_.width);
        image.height = number(header_.height);
        const size_t count = size_t(image.width) * size_t(image.height);
        const size_t pixel_size = size_t(header_.bits + 7) / 8;
        const bool packed = header_.type & type_run_length;
        // A run of 128 pixels takes one byte and the pixel: nothing is allocated for a picture that cannot be there.
        if (packed ? count / 128 > reader_.remaining() / (1 + pixel_size) : count > reader_.remaining() / pixel_size)
            reader_.fail("too little data for a picture of this size");
        image.pixels.reserve(count);
        while (image.pixels.size() < count)
            packed ? read_packet(image.pixels, count) : image.pixels.push_back(read_pixel());
        turn_upright(image);
        return image;
    }

private:
    bool is_known() const
    {
        const int bits = kind_ == ColourMapped ? header_.map_bits : header_.bits;
        if (header_.type & ~(type_run_length | 3))
            return false;
        if (kind_ == Grey)
            return bits == 8;
        if (kind_ == ColourMapped && (header_.bits != 8 || header_.has_map != 1))
            return false;
        return (kind_ == TrueColour || kind_ == ColourMapped) && (bits == 15 || bits == 16 || bits == 24 || bits == 32);
    }

    void read_map()
    {
        if (!header_.has_map)
            return;
        const size_t entry_size = size_t(header_.map_bits + 7) / 8;
        if (kind_ != ColourMapped) {
            reader_.take(entry_size * size_t(number(header_.map_count)));
            return;
        }
        for (int i = 0; i < number(header_.map_count); i++) {
            const Rgba8 colour = read_colour(reader_, header_.map_bits);
            if (const int index = i + number(header_.map_first); index < int(map_.size()))
                map_[size_t(index)] = colour;
        }
    }

    Rgba8 read_pixel()
    {
        return kind_ == ColourMapped ? map_[reader_.read<uint8_t>()] : read_colour(reader_, header_.bits);
    }

    void read_packet(std::vector<Rgba8>& pixels, size_t count)
    {
        const auto head = reader_.read<uint8_t>();
        const size_t length = std::min<size_t>((head & 0x7f) + 1u, count - pixels.size());
        if (head & 0x80)
            pixels.insert(pixels.end(), length, read_pixel());
        else
            for (size_t i = 0; i < length; i++)
                pixels.push_back(read_pixel());
    }

    void turn_upright(Image& image) const
    {
        const auto row = [&](int y) { return image.pixels.begin() + ptrdiff_t(y) * image.width; };
        if (!(header_.descriptor & from_top))
            for (int y = 0; y < image.height / 2; y++)
                std::swap_ranges(row(y), row(y + 1), row(image.height - 1 - y));
        if (header_.descriptor & from_right)
            for (int y = 0; y < image.height; y++)
                std::reverse(row(y), row(y + 1));
    }

    ByteReader reader_;
    Header header_;
    Kind kind_;
    Palette map_ {};
};

} // namespace

Image read_tga(Bytes file, std::string_view name, size_t room) { return Decoder(file, name, room).decode(); }

std::vector<std::byte> write_tga(const Image& image)
{
    check_written_image(image.width, image.height, image.pixels.size());
    Header header;
    header.type = TrueColour;
    header.width = to_bytes(image.width);
    header.height = to_bytes(image.height);
    header.bits = 32;
    header.descriptor = from_top | 8; // 8 bits of alpha
    ByteWriter writer;
    writer.write(header);
    for (const Rgba8& pixel : image.pixels)
        writer.write(std::array<uint8_t, 4> { pixel.b, pixel.g, pixel.r, pixel.a });
    return writer.take();
}

} // namespace formats

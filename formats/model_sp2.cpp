// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/byte_writer.hpp"
#include "formats/model.hpp"

#include <array>

namespace formats {

namespace {

constexpr std::array<char, 4> ident { 'I', 'D', 'S', '2' };
constexpr int32_t version = 2;
constexpr size_t picture_name_size = 64;
constexpr uint32_t max_frames = 32; // what the engine accepts; each costs a picture

struct FrameRecord {
    int32_t width, height, origin_x, origin_y;
    std::array<char, picture_name_size> picture;
};
static_assert(sizeof(FrameRecord) == 80);

} // namespace

Sp2Sprite read_sp2(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    if (reader.read<std::array<char, 4>>() != ident)
        reader.fail_at(0, "not an SP2 sprite (no \"IDS2\")");
    if (const auto found = reader.read<int32_t>(); found != version)
        reader.fail_at(4, "SP2 version " + std::to_string(found) + "; Quake II's sprites have version 2");
    const auto count = reader.read<uint32_t>();
    if (count == 0 || count > reader.remaining() / sizeof(FrameRecord))
        reader.fail_at(8, std::to_string(count) + " frames are not in the file");
    if (count > max_frames)
        reader.fail_at(
            8, std::to_string(count) + " frames, more than the engine's limit of " + std::to_string(max_frames));
    Sp2Sprite sprite;
    for (uint32_t i = 0; i < count; i++) {
        Sp2Sprite::Frame frame;
        const size_t start = reader.position();
        frame.width = reader.read<int32_t>();
        frame.height = reader.read<int32_t>();
        frame.origin_x = reader.read<int32_t>();
        frame.origin_y = reader.read<int32_t>();
        frame.picture = reader.read_string(picture_name_size);
        for (const int size : { frame.width, frame.height, frame.origin_x, frame.origin_y })
            if (size < -32768 || size > 32768)
                reader.fail_at(start, "frame " + std::to_string(i) + " has an invalid size or origin");
        if (frame.width < 0 || frame.height < 0)
            reader.fail_at(start, "frame " + std::to_string(i) + " has a negative size");
        sprite.frames.push_back(std::move(frame));
    }
    return sprite;
}

std::vector<std::byte> write_sp2(const Sp2Sprite& sprite)
{
    if (sprite.frames.empty())
        throw std::invalid_argument("cannot write a sprite without frames");
    ByteWriter writer;
    writer.write(ident);
    writer.write(version);
    writer.write(uint32_t(sprite.frames.size()));
    for (const Sp2Sprite::Frame& frame : sprite.frames) {
        for (const int32_t number : { frame.width, frame.height, frame.origin_x, frame.origin_y })
            writer.write(number);
        writer.write_string(frame.picture, picture_name_size);
    }
    return writer.take();
}

} // namespace formats

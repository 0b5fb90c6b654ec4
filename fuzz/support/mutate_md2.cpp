// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/md2_disk.hpp"
#include "fuzz/support/records.hpp"

namespace vkpt::fuzz {

namespace {

using namespace formats::md2_disk;

enum Part { skins, coordinates, triangles, frames, commands, part_count };
constexpr size_t header_at = sizeof(ident) + sizeof(version);
constexpr size_t largest_frame = sizeof(FrameHeader) + max_vertices * sizeof(Vertex);

bool is_model(const File& file)
{
    return file.size() >= header_at + sizeof(Header) && get<std::array<char, 4>>(file, 0) == ident
        && get<int32_t>(file, 4) == version;
}

std::vector<Table> take_parts(const File& file, const Header& header)
{
    const size_t frame_size = std::clamp<size_t>(header.frame_size, sizeof(FrameHeader), largest_frame);
    const auto part = [&](uint32_t at, uint64_t count, size_t size) {
        return Table { cut(file, at, count * size), size };
    };
    return { part(header.skins, header.skin_count, skin_name_size),
        part(header.coordinates, header.coordinate_count, sizeof(Coordinate)),
        part(header.triangles, header.triangle_count, sizeof(Triangle)),
        part(header.frames, header.frame_count, frame_size), part(header.commands, header.command_count, 4) };
}

// Counts and offsets follow from the parts.
File join_parts(Header header, const std::vector<Table>& parts)
{
    File file;
    append(file, ident);
    append(file, version);
    append(file, header);
    const auto place = [&](Part part, uint32_t& offset, uint32_t* count) {
        offset = uint32_t(file.size());
        if (count)
            *count = uint32_t(parts[part].bytes.size() / parts[part].record_size);
        file.insert(file.end(), parts[part].bytes.begin(), parts[part].bytes.end());
    };
    place(skins, header.skins, &header.skin_count);
    place(coordinates, header.coordinates, &header.coordinate_count);
    place(triangles, header.triangles, &header.triangle_count);
    place(frames, header.frames, &header.frame_count);
    place(commands, header.commands, &header.command_count);
    header.end = uint32_t(file.size());
    put(file, header_at, header);
    return file;
}

// All frames get one vertex more or less.
void resize_frames(Header& header, Table& table, Random& random)
{
    const size_t old_size = table.record_size;
    const size_t size
        = pick(random, 2) == 0 ? old_size + sizeof(Vertex) : std::max(old_size - sizeof(Vertex), sizeof(FrameHeader));
    File bytes;
    for (size_t at = 0; at + old_size <= table.bytes.size(); at += old_size) {
        File frame = cut(table.bytes, at, old_size);
        frame.resize(size);
        bytes.insert(bytes.end(), frame.begin(), frame.end());
    }
    table = { std::move(bytes), size };
    header.frame_size = uint32_t(size);
    header.vertex_count = uint32_t((size - sizeof(FrameHeader)) / sizeof(Vertex));
}

} // namespace

File mutate_md2(const File& file, size_t limit, Random& random)
{
    if (!is_model(file) || pick(random, 10) == 0)
        return mutate_bytes(file, limit, random);
    auto header = get<Header>(file, header_at);
    std::vector<Table> parts = take_parts(file, header);
    const size_t room = limit > file.size() ? limit - file.size() : 0;
    for (size_t changes = 1 + pick(random, 4); changes > 0; changes--) {
        const size_t choice = pick(random, 12);
        if (choice == 0)
            resize_frames(header, parts[frames], random);
        else if (choice == 1)
            header.skin_width = int32_t(random());
        else if (choice == 2)
            header.vertex_count = uint32_t(pick(random, 16));
        else
            mutate_tables(parts, room / 4 + 64, random);
    }
    File result = join_parts(header, parts);
    if (pick(random, 10) == 0) // a number of the header that does not fit the rest
        mutate_field(result, header_at, sizeof(Header), random);
    result.resize(std::min(result.size(), limit));
    return result;
}

} // namespace vkpt::fuzz

// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/bsp_disk.hpp"
#include "fuzz/support/records.hpp"

#include <optional>

namespace vkpt::fuzz {

namespace {

using namespace formats;
using namespace formats::bsp_disk;

std::optional<BspFormat> format_of(const File& file)
{
    if (file.size() < header_size || get<int32_t>(file, sizeof(Ident)) != version)
        return {};
    const auto found = get<Ident>(file, 0);
    return found == ident         ? std::optional(BspFormat::ibsp)
        : found == extended_ident ? std::optional(BspFormat::qbsp)
                                  : std::nullopt;
}

std::vector<Table> take_lumps(const File& file, BspFormat format)
{
    const auto directory = get<Directory>(file, directory_at);
    const RecordSizes sizes = record_sizes(format);
    std::vector<Table> lumps(LumpCount);
    for (size_t i = 0; i < lumps.size(); i++)
        lumps[i] = { cut(file, directory[i].offset, directory[i].size), sizes[i] };
    return lumps;
}

File join_lumps(const std::vector<Table>& lumps, BspFormat format)
{
    Directory directory {};
    File file;
    append(file, format == BspFormat::qbsp ? extended_ident : ident);
    append(file, version);
    append(file, directory);
    for (size_t i = 0; i < lumps.size(); i++) {
        directory[i] = { uint32_t(file.size()), uint32_t(lumps[i].bytes.size()) };
        file.insert(file.end(), lumps[i].bytes.begin(), lumps[i].bytes.end());
        file.resize((file.size() + 3) & ~size_t(3));
    }
    put(file, directory_at, directory);
    return file;
}

// Maps of faces with many corners are rare in what chance makes: a face takes over all edges behind its first.
template <class Face> void widen_face(std::vector<Table>& lumps, Random& random)
{
    File& faces = lumps[Faces].bytes;
    const size_t edges = lumps[SurfaceEdges].bytes.size() / sizeof(int32_t);
    if (faces.size() < sizeof(Face) || edges < 3)
        return;
    const size_t at = pick(random, faces.size() / sizeof(Face)) * sizeof(Face);
    auto face = get<Face>(faces, at);
    face.first_edge = int32_t(pick(random, edges - 2));
    face.edge_count = decltype(face.edge_count)(3 + pick(random, edges - size_t(face.first_edge) - 2));
    put(faces, at, face);
}

} // namespace

File mutate_bsp(const File& file, size_t limit, Random& random)
{
    const std::optional<BspFormat> format = format_of(file);
    if (!format || pick(random, 10) == 0)
        return mutate_bytes(file, limit, random);
    std::vector<Table> lumps = take_lumps(file, *format);
    const size_t room = limit > file.size() ? limit - file.size() : 0;
    for (size_t changes = 1 + pick(random, 4); changes > 0; changes--) {
        if (pick(random, 20) == 0) {
            with_format(*format,
                [&](auto constant) { widen_face<typename OnDisk<constant.value, BspFace>::Record>(lumps, random); });
            continue;
        }
        Table& lump = lumps[pick(random, lumps.size())];
        if (lump.bytes.empty() || pick(random, 30) == 0)
            mutate_tables(lumps, room / 4 + 64, random);
        else
            mutate_table(lump, lump.bytes.size() + room / 8, random);
    }
    File result = join_lumps(lumps, *format);
    result.resize(std::min(result.size(), limit));
    return result;
}

} // namespace vkpt::fuzz

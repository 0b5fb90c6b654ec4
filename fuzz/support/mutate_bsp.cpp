// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/bsp_disk.hpp"
#include "fuzz/support/records.hpp"

namespace vkpt::fuzz {

namespace {

using namespace formats;
using namespace formats::bsp_disk;

constexpr std::array<size_t, LumpCount> record_sizes { 1, sizeof(BspPlane), sizeof(glm::vec3), 1, sizeof(BspNode),
    sizeof(TexinfoRecord), sizeof(BspFace), 1, sizeof(BspLeaf), sizeof(uint16_t), sizeof(uint16_t), sizeof(BspEdge),
    sizeof(int32_t), sizeof(BspModel), sizeof(BspBrush), sizeof(BspBrushSide), 1, sizeof(BspArea),
    sizeof(BspAreaPortal) };
constexpr size_t directory_at = sizeof(ident) + sizeof(version);

bool is_map(const File& file)
{
    return file.size() >= header_size && get<std::array<char, 4>>(file, 0) == ident && get<int32_t>(file, 4) == version;
}

std::vector<Table> take_lumps(const File& file)
{
    const auto directory = get<Directory>(file, directory_at);
    std::vector<Table> lumps(LumpCount);
    for (size_t i = 0; i < lumps.size(); i++)
        lumps[i] = { cut(file, directory[i].offset, directory[i].size), record_sizes[i] };
    return lumps;
}

File join_lumps(const std::vector<Table>& lumps)
{
    Directory directory {};
    File file;
    append(file, ident);
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
void widen_face(std::vector<Table>& lumps, Random& random)
{
    File& faces = lumps[Faces].bytes;
    const size_t edges = lumps[SurfaceEdges].bytes.size() / sizeof(int32_t);
    if (faces.size() < sizeof(BspFace) || edges < 3)
        return;
    const size_t at = pick(random, faces.size() / sizeof(BspFace)) * sizeof(BspFace);
    auto face = get<BspFace>(faces, at);
    face.first_edge = int32_t(pick(random, edges - 2));
    face.edge_count = uint16_t(3 + pick(random, edges - size_t(face.first_edge) - 2));
    put(faces, at, face);
}

} // namespace

File mutate_bsp(const File& file, size_t limit, Random& random)
{
    if (!is_map(file) || pick(random, 10) == 0)
        return mutate_bytes(file, limit, random);
    std::vector<Table> lumps = take_lumps(file);
    const size_t room = limit > file.size() ? limit - file.size() : 0;
    for (size_t changes = 1 + pick(random, 4); changes > 0; changes--) {
        if (pick(random, 20) == 0) {
            widen_face(lumps, random);
            continue;
        }
        Table& lump = lumps[pick(random, lumps.size())];
        if (lump.bytes.empty() || pick(random, 30) == 0)
            mutate_tables(lumps, room / 4 + 64, random);
        else
            mutate_table(lump, lump.bytes.size() + room / 8, random);
    }
    File result = join_lumps(lumps);
    result.resize(std::min(result.size(), limit));
    return result;
}

} // namespace vkpt::fuzz

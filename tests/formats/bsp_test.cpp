// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/bsp.hpp"
#include "formats/byte_writer.hpp"
#include "formats/entities.hpp"
#include "tests/formats/samples.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <tuple>
#include <utility>
#include <vector>

namespace formats {

namespace {

using vkpt::samples::make_bsp;

template <class T> bool same_bytes(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expect_same(const Bsp& a, const Bsp& b)
{
    EXPECT_EQ(a.entity_text, b.entity_text);
    EXPECT_TRUE(same_bytes(a.planes, b.planes));
    EXPECT_TRUE(same_bytes(a.vertices, b.vertices));
    EXPECT_TRUE(same_bytes(a.visibility, b.visibility));
    EXPECT_TRUE(same_bytes(a.nodes, b.nodes));
    EXPECT_TRUE(same_bytes(a.faces, b.faces));
    EXPECT_TRUE(same_bytes(a.lighting, b.lighting));
    EXPECT_TRUE(same_bytes(a.leaves, b.leaves));
    EXPECT_TRUE(same_bytes(a.leaf_faces, b.leaf_faces));
    EXPECT_TRUE(same_bytes(a.leaf_brushes, b.leaf_brushes));
    EXPECT_TRUE(same_bytes(a.edges, b.edges));
    EXPECT_TRUE(same_bytes(a.surface_edges, b.surface_edges));
    EXPECT_TRUE(same_bytes(a.models, b.models));
    EXPECT_TRUE(same_bytes(a.brushes, b.brushes));
    EXPECT_TRUE(same_bytes(a.brush_sides, b.brush_sides));
    EXPECT_TRUE(same_bytes(a.areas, b.areas));
    EXPECT_TRUE(same_bytes(a.area_portals, b.area_portals));
    EXPECT_EQ(a.cluster_count, b.cluster_count);
    ASSERT_EQ(a.texinfos.size(), b.texinfos.size());
    for (size_t i = 0; i < a.texinfos.size(); i++) {
        EXPECT_EQ(a.texinfos[i].texture, b.texinfos[i].texture);
        EXPECT_EQ(a.texinfos[i].s_axis, b.texinfos[i].s_axis);
        EXPECT_EQ(a.texinfos[i].t_offset, b.texinfos[i].t_offset);
        EXPECT_EQ(a.texinfos[i].flags, b.texinfos[i].flags);
        EXPECT_EQ(a.texinfos[i].value, b.texinfos[i].value);
        EXPECT_EQ(a.texinfos[i].next, b.texinfos[i].next);
    }
}

constexpr BspFormat both_formats[] { BspFormat::ibsp, BspFormat::qbsp };

TEST(Bsp, RoundTrip)
{
    for (const BspFormat format : both_formats) {
        Bsp bsp = make_bsp();
        bsp.format = format;
        const auto file = write_bsp(bsp);
        const Bsp again = read_bsp(file, bsp.name);
        EXPECT_EQ(again.name, bsp.name);
        EXPECT_EQ(again.format, format);
        expect_same(bsp, again);
        EXPECT_EQ(write_bsp(again), file);
    }
}

size_t lump_offset(const std::vector<std::byte>& file, size_t lump)
{
    uint32_t offset;
    std::memcpy(&offset, file.data() + 8 + 8 * lump, sizeof offset);
    return offset;
}

// What lies at `at` bytes from a lump's start.
template <class T> T number_in(const std::vector<std::byte>& file, size_t lump, size_t at)
{
    T value;
    std::memcpy(&value, file.data() + lump_offset(file, lump) + at, sizeof value);
    return value;
}

template <class T>
void expect_numbers(const std::vector<std::byte>& file, size_t lump, size_t at, std::vector<T> numbers)
{
    for (size_t i = 0; i < numbers.size(); i++)
        EXPECT_EQ(number_in<T>(file, lump, at + i * sizeof(T)), numbers[i]) << "lump " << lump << ", number " << i;
}

// The second record of each lump whose records are wider than in an IBSP; lumps by their numbers in the directory.
TEST(Bsp, WideFieldsLieWhereQbspHasThem)
{
    Bsp bsp = make_bsp();
    bsp.format = BspFormat::qbsp;
    bsp.brush_sides = { { 0, -1 }, { 2, 1 } };
    const auto file = write_bsp(bsp);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(file.data()), 4), "QBSP");
    EXPECT_EQ(number_in<int32_t>(file, 4, 44 + 0), 1); // node: plane, children
    expect_numbers<int32_t>(file, 4, 44 + 4, { -3, -2 });
    expect_numbers<float>(file, 4, 44 + 12, { -64, -64, 0, 64, 64, 64 });
    expect_numbers<uint32_t>(file, 4, 36, { 0, 2 }); // of the first node
    expect_numbers<int32_t>(file, 6, 28, { 2, 1, 4, 4, 1 }); // face: plane, side, edges, texinfo
    expect_numbers<uint8_t>(file, 6, 28 + 20, { 0, 255, 255, 255 });
    EXPECT_EQ(number_in<int32_t>(file, 6, 28 + 24), -1);
    expect_numbers<int32_t>(file, 8, 104, { 0, 1, 1 }); // leaf: contents, cluster, area
    expect_numbers<float>(file, 8, 104 + 12, { 0, -64, 0, 64, 64, 64 });
    expect_numbers<uint32_t>(file, 8, 104 + 36, { 1, 1, 0, 0 });
    EXPECT_EQ(number_in<int32_t>(file, 8, 4), -1); // the first leaf's cluster
    expect_numbers<uint32_t>(file, 9, 0, { 0, 1 });
    expect_numbers<uint32_t>(file, 11, 8, { 0, 5, 5, 4 });
    expect_numbers<int32_t>(file, 15, 0, { 0, -1, 2, 1 });
}

// One square 70,000 times, with vertices, edges and a place in leaves of its own each time.
Bsp make_large_bsp()
{
    constexpr uint32_t more = 70'000;
    Bsp bsp = make_bsp();
    for (uint32_t i = 0; i < more; i++) {
        const uint32_t first = uint32_t(bsp.vertices.size());
        const int32_t edge = int32_t(bsp.edges.size());
        BspFace face = bsp.faces[1];
        face.first_edge = int32_t(bsp.surface_edges.size());
        bsp.leaf_faces.push_back(uint32_t(bsp.faces.size()));
        bsp.faces.push_back(face);
        for (uint32_t corner = 0; corner < 4; corner++) {
            bsp.vertices.push_back(bsp.vertices[std::array { 1, 4, 3, 2 }[corner]] + glm::vec3(0, 0, float(i)));
            bsp.edges.push_back({ { first + corner, first + (corner + 1) % 4 } });
            bsp.surface_edges.push_back(edge + int32_t(corner));
        }
    }
    bsp.leaves[2].leaf_face_count += more;
    return bsp;
}

TEST(Bsp, QbspHoldsMoreThan16BitsCount)
{
    Bsp bsp = make_large_bsp();
    bsp.format = BspFormat::qbsp;
    const Bsp again = read_bsp(write_bsp(bsp), bsp.name);
    expect_same(bsp, again);
    EXPECT_EQ(again.face_polygon(70'001)[0], glm::vec3(64, -64, 69'999));
    EXPECT_EQ(again.leaf_faces.back(), 70'001u);
}

TEST(Bsp, WriterRefusesWhatDoesNotFitInto16Bits)
{
    const auto refusal = [](const Bsp& bsp) {
        try {
            write_bsp(bsp);
        } catch (const std::invalid_argument& error) {
            return std::string(error.what());
        }
        return std::string("written");
    };
    EXPECT_EQ(refusal(make_bsp()), "written");
    EXPECT_EQ(
        refusal(make_large_bsp()), "lump leaves, record 2: 70001 does not fit into 16 bits; write the map as QBSP");
    Bsp bsp = make_bsp();
    bsp.edges[3].vertices[1] = 65'536;
    EXPECT_EQ(refusal(bsp), "lump edges, record 3: 65536 does not fit into 16 bits; write the map as QBSP");
    bsp = make_bsp();
    bsp.leaves[1].cluster = 32'768;
    EXPECT_EQ(refusal(bsp), "lump leaves, record 1: 32768 does not fit into 16 bits; write the map as QBSP");
    for (const float bound : { 0.5f, 40'000.0f, -INFINITY, NAN }) {
        bsp = make_bsp();
        bsp.nodes[1].mins[2] = bound;
        EXPECT_TRUE(refusal(bsp).starts_with("lump nodes, record 1: ")) << refusal(bsp);
        bsp.format = BspFormat::qbsp;
        EXPECT_EQ(refusal(bsp), "written");
    }
}

// Compilers put more lumps behind those of the directory: decoupled lightmaps, normals. They are not read.
TEST(Bsp, LumpsOfBspxAreLeftAlone)
{
    for (const BspFormat format : both_formats) {
        Bsp bsp = make_bsp();
        bsp.format = format;
        auto file = write_bsp(bsp);
        ByteWriter more;
        more.write_bytes(file);
        more.write_bytes(std::as_bytes(std::span("BSPX", 4)));
        more.write(uint32_t(1));
        more.write_string("DECOUPLED_LM", 24);
        more.write(uint32_t(file.size() + 40));
        more.write(uint32_t(80));
        more.write_string("", 80);
        expect_same(read_bsp(more.take(), bsp.name), bsp);
    }
}

TEST(Bsp, FacesAreCounterClockwiseAndHaveTheirNormals)
{
    const Bsp bsp = make_bsp();
    for (size_t face = 0; face < bsp.faces.size(); face++) {
        const auto polygon = bsp.face_polygon(face);
        ASSERT_EQ(polygon.size(), 4u);
        const glm::vec3 normal = bsp.face_normal(face);
        EXPECT_EQ(normal, glm::vec3(0, 0, 1));
        EXPECT_GT(glm::dot(glm::cross(polygon[1] - polygon[0], polygon[2] - polygon[0]), normal), 0);
    }
}

// The second square goes back along an edge of the first.
TEST(Bsp, FacesFollowEdgesInBothDirections)
{
    const Bsp bsp = make_bsp();
    const auto& v = bsp.vertices;
    EXPECT_EQ(bsp.face_polygon(0), (std::vector<glm::vec3> { v[1], v[4], v[5], v[0] }));
    EXPECT_EQ(bsp.face_polygon(1), (std::vector<glm::vec3> { v[2], v[3], v[4], v[1] }));
}

TEST(Bsp, TextureCoordinatesAndLightmaps)
{
    const Bsp bsp = make_bsp();
    EXPECT_EQ(bsp.texture_coordinates(bsp.texinfos[0], { 3, 5, 7 }), glm::vec2(3, 3));
    const auto lamp = bsp.lightmap_extent(0); // s -64..0, t -56..72
    EXPECT_EQ(lamp.size, glm::ivec2(5, 10));
    EXPECT_EQ(lamp.min_st, glm::vec2(-64, -64));
    const auto floor = bsp.lightmap_extent(1); // s 0..32, t -32..32
    EXPECT_EQ(floor.size, glm::ivec2(3, 5));
    Bsp sky = bsp;
    sky.texinfos[0].flags = SURF_SKY;
    EXPECT_EQ(sky.lightmap_extent(0).size, glm::ivec2(0));
    sky.texinfos[1].s_axis = { 1e30f, 0, 0 };
    EXPECT_EQ(sky.lightmap_extent(1).size, glm::ivec2(0));
}

TEST(Bsp, FindsLeavesAndClusters)
{
    const Bsp bsp = make_bsp();
    EXPECT_EQ(bsp.find_leaf({ 5, 5, -1 }), 0u);
    EXPECT_EQ(bsp.find_cluster({ 5, 5, -1 }), -1);
    EXPECT_EQ(bsp.find_cluster({ -5, 5, 1 }), 0);
    EXPECT_EQ(bsp.find_cluster({ 5, 5, 1 }), 1);
    EXPECT_EQ(bsp.find_leaf({ 5, 5, 1 }, -1), 0u); // a model that is one leaf
}

TEST(Bsp, PvsOfTheSample)
{
    const Bsp bsp = make_bsp();
    EXPECT_TRUE(bsp.pvs(0).contains(0));
    EXPECT_FALSE(bsp.pvs(0).contains(1));
    EXPECT_TRUE(bsp.pvs(1).contains(1));
    EXPECT_FALSE(bsp.pvs(1).contains(0));
    EXPECT_EQ(bsp.pvs(-1).size(), 2u);
    for (const int cluster : { -1, 2, 1000 })
        EXPECT_FALSE(bsp.pvs(cluster).contains(0) || bsp.pvs(cluster).contains(1));
}

// 100 clusters (13 bytes) whose only row is `packed`.
Bsp with_row(const std::vector<uint8_t>& packed)
{
    Bsp bsp = make_bsp();
    bsp.cluster_count = 100;
    bsp.visibility.assign(4 + 800, 0);
    bsp.visibility[0] = 100;
    for (size_t i = 0; i < 200; i++) {
        bsp.visibility[4 + 4 * i] = 804 & 0xff;
        bsp.visibility[5 + 4 * i] = 804 >> 8;
    }
    bsp.visibility.insert(bsp.visibility.end(), packed.begin(), packed.end());
    return bsp;
}

TEST(Bsp, PvsUnpacksRunsOfZeros)
{
    const ClusterSet set = with_row({ 0x81, 0, 10, 0x02, 0xff }).pvs(3);
    for (int cluster = 0; cluster < 100; cluster++)
        EXPECT_EQ(set.contains(cluster), cluster == 0 || cluster == 7 || cluster == 89 || cluster == 3 || cluster >= 96)
            << cluster;
    EXPECT_EQ(set.bytes().back(), 0x0f); // no bits beyond the last cluster
}

TEST(Bsp, PvsOfBrokenRowsEndsInTime)
{
    for (const auto& row :
        std::vector<std::vector<uint8_t>> { { 0x01 }, { 0 }, { 0, 0, 0xff }, { 0, 255, 1 }, { 1, 0, 200 } }) {
        const ClusterSet set = with_row(row).pvs(50);
        EXPECT_EQ(set.size(), 100u);
        EXPECT_TRUE(set.contains(50));
        EXPECT_FALSE(set.contains(99));
    }
    Bsp cut = with_row({});
    cut.visibility.resize(6);
    EXPECT_TRUE(cut.pvs(99).contains(99));
}

TEST(Bsp, WithoutVisibilityEverythingIsSeen)
{
    Bsp bsp = make_bsp();
    bsp.visibility.clear();
    bsp.cluster_count = 0;
    const Bsp again = read_bsp(write_bsp(bsp), "unvised");
    EXPECT_EQ(again.cluster_count, 0);
    EXPECT_TRUE(again.pvs(0).contains(0) && again.pvs(0).contains(1));
    EXPECT_FALSE(again.pvs(-1).contains(0));
}

TEST(Bsp, LightOutsideOfTheFileIsDropped)
{
    Bsp bsp = make_bsp();
    bsp.faces[0].light_offset = 1;
    EXPECT_EQ(read_bsp(write_bsp(bsp), "dark").faces[0].light_offset, -1);
    bsp.faces[0].light_offset = INT32_MIN;
    EXPECT_EQ(read_bsp(write_bsp(bsp), "dark").faces[0].light_offset, -1);
}

TEST(Bsp, AnimationsThatNeverReturnAreCut)
{
    const auto chain = [](std::vector<int32_t> next) {
        Bsp bsp = make_bsp();
        bsp.texinfos.resize(next.size(), bsp.texinfos[0]);
        for (size_t i = 0; i < next.size(); i++)
            bsp.texinfos[i].next = next[i];
        const Bsp again = read_bsp(write_bsp(bsp), "chain");
        for (size_t i = 0; i < next.size(); i++)
            next[i] = again.texinfos[i].next;
        return next;
    };
    using Chain = std::vector<int32_t>;
    EXPECT_EQ(chain({ 1, 2, 0 }), (Chain { 1, 2, 0 }));
    EXPECT_EQ(chain({ 1, 2, -1 }), (Chain { 1, 2, -1 }));
    EXPECT_EQ(chain({ 1, 2, 3, 2 }), (Chain { 1, -1, 3, 2 }));
    EXPECT_EQ(chain({ 0, 0, 0 }), (Chain { 0, -1, -1 }));
    EXPECT_EQ(chain({ 3, 2, 1, 1 }), (Chain { 3, 2, 1, -1 }));
    EXPECT_EQ(chain({ -1, 0, 1 }), (Chain { -1, 0, 1 }));
}

// One animation of all texinfos.
void make_ring(Bsp& bsp, size_t length)
{
    bsp.texinfos.resize(length, bsp.texinfos[0]);
    for (size_t i = 0; i < length; i++)
        bsp.texinfos[i].next = int32_t((i + 1) % length);
}

// A face of nine edges in every place of many leaves.
void fill_with_leaf_faces(Bsp& bsp, size_t count)
{
    bsp.surface_edges.resize(100);
    bsp.faces[1].edge_count = 9;
    bsp.leaf_faces.assign(count, 1);
    bsp.leaves[1].first_leaf_face = 0;
    bsp.leaves[1].leaf_face_count = uint32_t(count / 2);
    bsp.leaves[2].first_leaf_face = uint32_t(count / 2);
    bsp.leaves[2].leaf_face_count = uint32_t(count / 2);
}

TEST(Bsp, LongAnimationsAndLargeFacesAreRead)
{
    Bsp bsp = make_bsp();
    make_ring(bsp, 256);
    bsp.surface_edges.resize(100);
    bsp.faces[1].edge_count = 64;
    fill_with_leaf_faces(bsp, 110000);
    EXPECT_EQ(read_bsp(write_bsp(bsp), "large").texinfos[255].next, 0);
}

TEST(Bsp, RefusesLumpsThatOverlap)
{
    std::vector<std::byte> file = write_bsp(make_bsp());
    constexpr size_t entities = 8; // the directory's first entry
    EXPECT_NO_THROW(read_bsp(file, "m.bsp"));
    const uint32_t whole[] = { 160, uint32_t(file.size() - 160) };
    std::memcpy(file.data() + entities, whole, 8);
    EXPECT_THROW(read_bsp(file, "m.bsp"), FormatError);
}

// A lump, and what is wrong there.
const std::vector<std::pair<const char*, std::function<void(Bsp&)>>> faults {
    { "vertices", [](Bsp& b) { b.vertices[3].y = NAN; } },
    { "vertices", [](Bsp& b) { b.vertices[0].x = INFINITY; } },
    { "planes",
        [](Bsp& b) {
            b.planes[1].normal = { 0, 0, 0 };
        } },
    { "planes", [](Bsp& b) { b.planes[1].dist = NAN; } },
    { "edges", [](Bsp& b) { b.edges[2].vertices[1] = 6; } },
    { "surface edges", [](Bsp& b) { b.surface_edges[1] = -8; } },
    { "surface edges", [](Bsp& b) { b.surface_edges[1] = INT32_MIN; } },
    { "faces", [](Bsp& b) { b.faces[0].plane = 3; } },
    { "faces", [](Bsp& b) { b.faces[0].texinfo = 3; } },
    { "faces", [](Bsp& b) { b.faces[1].first_edge = 5; } },
    { "faces", [](Bsp& b) { b.faces[1].first_edge = -1; } },
    { "faces", [](Bsp& b) { b.faces[1].edge_count = 2; } },
    { "texinfos", [](Bsp& b) { b.texinfos[1].next = 3; } },
    { "texinfos", [](Bsp& b) { b.texinfos[1].t_axis.z = NAN; } },
    { "leaf faces", [](Bsp& b) { b.leaf_faces[1] = 2; } },
    { "leaf brushes", [](Bsp& b) { b.leaf_brushes[0] = 1; } },
    { "leaves", [](Bsp& b) { b.leaves[1].leaf_face_count = 3; } },
    { "leaves", [](Bsp& b) { b.leaves[1].cluster = 2; } },
    { "leaves", [](Bsp& b) { b.leaves[1].cluster = -2; } },
    { "leaves", [](Bsp& b) { b.leaves[1].area = 2; } },
    { "leaves", [](Bsp& b) { b.leaves.clear(); } },
    { "nodes", [](Bsp& b) { b.nodes[0].plane = -1; } },
    { "nodes", [](Bsp& b) { b.nodes[0].children[1] = -4; } },
    { "nodes", [](Bsp& b) { b.nodes[0].children[1] = INT32_MIN; } },
    { "nodes", [](Bsp& b) { b.nodes[1].children[1] = 0; } }, // a ring
    { "nodes", [](Bsp& b) { b.nodes[0].children[1] = 1; } }, // two parents
    { "nodes",
        [](Bsp& b) {
            b.nodes[1].first_face = 3;
            b.nodes[1].face_count = 0xffff;
        } },
    { "models", [](Bsp& b) { b.models[0].head_node = 2; } },
    { "models", [](Bsp& b) { b.models[0].face_count = INT32_MAX; } },
    { "models", [](Bsp& b) { b.models.clear(); } },
    { "brushes", [](Bsp& b) { b.brushes[0].first_side = INT32_MAX; } },
    { "brush sides", [](Bsp& b) { b.brush_sides[0].texinfo = 3; } },
    { "areas", [](Bsp& b) { b.areas[1].area_portal_count = 2; } },
    { "area portals", [](Bsp& b) { b.area_portals[0].other_area = 2; } },
    // What costs far more than it takes in the file:
    { "faces",
        [](Bsp& b) {
            b.faces[1].first_edge = b.faces[0].first_edge;
            b.surface_edges.resize(7);
        } },
    { "faces",
        [](Bsp& b) {
            b.surface_edges.resize(100);
            b.faces[1].edge_count = 65;
        } },
    { "leaves",
        [](Bsp& b) {
            for (BspLeaf& leaf : b.leaves)
                std::tie(leaf.first_leaf_face, leaf.leaf_face_count) = std::pair(0, 2);
        } },
    { "leaves", [](Bsp& b) { fill_with_leaf_faces(b, 130000); } },
    { "models", [](Bsp& b) { b.models.push_back(b.models[0]); } },
    { "texinfos", [](Bsp& b) { make_ring(b, 257); } },
    { "visibility", [](Bsp& b) { b.visibility[0] = 3; } },
    { "visibility", [](Bsp& b) { b.visibility[4] = 22; } },
    { "visibility", [](Bsp& b) { b.visibility.resize(3); } },
};

// What only 32 bits can say.
const std::vector<std::pair<const char*, std::function<void(Bsp&)>>> wide_faults {
    { "edges", [](Bsp& b) { b.edges[2].vertices[1] = 0x10001; } },
    { "faces", [](Bsp& b) { b.faces[0].plane = UINT32_MAX; } },
    { "faces", [](Bsp& b) { b.faces[0].texinfo = 0x10000; } },
    { "faces", [](Bsp& b) { b.faces[1].edge_count = UINT32_MAX; } },
    { "leaf faces", [](Bsp& b) { b.leaf_faces[1] = 0x10000; } },
    { "leaf brushes", [](Bsp& b) { b.leaf_brushes[0] = UINT32_MAX; } },
    { "leaves", [](Bsp& b) { b.leaves[1].cluster = 0x10000; } },
    { "leaves", [](Bsp& b) { b.leaves[1].cluster = INT32_MIN; } },
    { "leaves", [](Bsp& b) { b.leaves[1].area = 0x10001; } },
    { "leaves",
        [](Bsp& b) {
            std::tie(b.leaves[1].first_leaf_face, b.leaves[1].leaf_face_count) = std::pair(2u, UINT32_MAX);
        } },
    { "leaves", [](Bsp& b) { b.leaves[1].leaf_brush_count = UINT32_MAX; } },
    { "leaves", [](Bsp& b) { b.leaves[2].mins[1] = NAN; } },
    { "leaves", [](Bsp& b) { b.leaves[2].maxs[0] = INFINITY; } },
    { "nodes", [](Bsp& b) { b.nodes[1].mins[2] = NAN; } },
    { "nodes", [](Bsp& b) { b.nodes[1].face_count = UINT32_MAX; } },
    { "brush sides", [](Bsp& b) { b.brush_sides[0].plane = 0x10000; } },
    { "brush sides", [](Bsp& b) { b.brush_sides[0].texinfo = -2; } },
    { "visibility",
        [](Bsp& b) {
            b.visibility.assign(4 + 8 * 32'769 + 1, 0);
            b.visibility[1] = 0x80;
            b.visibility[0] = 1;
        } },
};

void expect_faults_found(const std::vector<std::pair<const char*, std::function<void(Bsp&)>>>& list, BspFormat format)
{
    for (size_t i = 0; i < list.size(); i++) {
        Bsp bsp = make_bsp();
        bsp.format = format;
        list[i].second(bsp);
        try {
            read_bsp(write_bsp(bsp), "maps/broken.bsp");
            ADD_FAILURE() << "fault " << i << " in " << list[i].first << " was not found";
        } catch (const FormatError& error) {
            EXPECT_NE(error.reason().find(std::string("lump ") + list[i].first), std::string::npos)
                << i << ": " << error.what();
        }
    }
}

TEST(Bsp, RefusesIndicesOutOfRange)
{
    for (const BspFormat format : both_formats)
        expect_faults_found(faults, format);
    expect_faults_found(wide_faults, BspFormat::qbsp);
}

TEST(Bsp, RefusalsSayWhereTheRecordLies)
{
    for (const BspFormat format : both_formats) {
        Bsp bsp = make_bsp();
        bsp.format = format;
        bsp.leaves[2].area = 7;
        const auto file = write_bsp(bsp);
        const size_t start = lump_offset(file, 8);
        try {
            read_bsp(file, "maps/broken.bsp");
            ADD_FAILURE();
        } catch (const FormatError& error) {
            EXPECT_EQ(error.offset(), start + 2 * (format == BspFormat::qbsp ? 52 : 28));
            EXPECT_EQ(error.reason(), "lump leaves, record 2: area 7 of 2");
        }
    }
}

TEST(Bsp, RefusesOtherFiles)
{
    auto file = write_bsp(make_bsp());
    Bsp extended = make_bsp();
    extended.format = BspFormat::qbsp;
    const auto wide_file = write_bsp(extended);
    EXPECT_THROW(read_bsp(Bytes(wide_file).first(wide_file.size() - 64), "cut"), FormatError);
    file[0] = std::byte { 'Q' }; // an IBSP that says it is a QBSP
    EXPECT_THROW(read_bsp(file, "narrow records"), FormatError);
    file[0] = std::byte { 'I' };
    EXPECT_THROW(read_bsp({}, "empty"), FormatError);
    EXPECT_THROW(read_bsp(Bytes(file).first(100), "cut"), FormatError);
    EXPECT_THROW(read_bsp(Bytes(file).first(file.size() - 64), "cut"), FormatError);
    file[4] = std::byte { 46 };
    EXPECT_THROW(read_bsp(file, "other version"), FormatError);
    file[0] = std::byte { 'X' };
    EXPECT_THROW(read_bsp(file, "not a map"), FormatError);
}

std::vector<std::byte> load_file(const std::filesystem::path& path)
{
    std::ifstream stream(path, std::ios::binary);
    std::vector<std::byte> bytes(std::filesystem::file_size(path));
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    return bytes;
}

// Compilers leave a few slivers whose corners lie on one line: their area vanishes, but it never points backwards.
void expect_sound_geometry(const Bsp& bsp)
{
    size_t slivers = 0;
    for (size_t face = 0; face < bsp.faces.size(); face++) {
        const auto polygon = bsp.face_polygon(face);
        glm::vec3 area(0);
        for (size_t i = 2; i < polygon.size(); i++)
            area += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
        EXPECT_GE(glm::dot(area, bsp.face_normal(face)), -0.01f) << "face " << face;
        slivers += glm::dot(area, bsp.face_normal(face)) < 0.01f;
    }
    EXPECT_LT(slivers, bsp.faces.size() / 20);
}

void expect_sound_visibility(const Bsp& bsp)
{
    ASSERT_GT(bsp.cluster_count, 0);
    size_t one_way = 0, pairs = 0;
    std::vector<ClusterSet> rows;
    for (int cluster = 0; cluster < bsp.cluster_count; cluster++)
        rows.push_back(bsp.pvs(cluster));
    for (int a = 0; a < bsp.cluster_count; a++) {
        EXPECT_TRUE(rows[size_t(a)].contains(a));
        for (int b = 0; b < a; b++) {
            pairs += rows[size_t(a)].contains(b);
            one_way += rows[size_t(a)].contains(b) != rows[size_t(b)].contains(a);
        }
    }
    EXPECT_GT(pairs, 0u);
    EXPECT_LE(one_way, pairs / 10); // compilers make it nearly symmetric
}

TEST(Bsp, ReadsRealMaps)
{
    const char* folder = std::getenv("VKPT_TEST_MAPS");
    if (!folder)
        GTEST_SKIP() << "set VKPT_TEST_MAPS to a folder of BSP files to read them too";
    size_t maps = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".bsp")
            continue;
        SCOPED_TRACE(entry.path().string());
        maps++;
        const Bsp bsp = read_bsp(load_file(entry.path()), entry.path().filename().string());
        expect_same(bsp, read_bsp(write_bsp(bsp), bsp.name));
        expect_sound_geometry(bsp);
        expect_sound_visibility(bsp);
        const auto entities = parse_entities(bsp.entity_text, bsp.name);
        ASSERT_FALSE(entities.empty());
        EXPECT_EQ(entities[0].class_name(), "worldspawn");
        for (const EntityText& entity : entities) {
            if (entity.class_name() == "info_player_deathmatch") {
                EXPECT_GE(bsp.find_cluster(*entity.vector("origin")), 0);
            }
        }
        size_t lit = 0;
        for (const BspFace& face : bsp.faces)
            lit += face.light_offset >= 0;
        EXPECT_GT(lit, bsp.faces.size() / 2);
    }
    EXPECT_GT(maps, 0u) << "no .bsp file in " << folder;
}

} // namespace

} // namespace formats

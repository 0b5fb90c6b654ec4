// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/bsp.hpp"
#include "formats/entities.hpp"
#include "tests/formats/samples.hpp"

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

TEST(Bsp, RoundTrip)
{
    const Bsp bsp = make_bsp();
    const auto file = write_bsp(bsp);
    const Bsp again = read_bsp(file, bsp.name);
    EXPECT_EQ(again.name, bsp.name);
    expect_same(bsp, again);
    EXPECT_EQ(write_bsp(again), file);
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
    bsp.leaves[1].leaf_face_count = uint16_t(count / 2);
    bsp.leaves[2].first_leaf_face = uint16_t(count / 2);
    bsp.leaves[2].leaf_face_count = uint16_t(count / 2);
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

TEST(Bsp, RefusesIndicesOutOfRange)
{
    for (size_t i = 0; i < faults.size(); i++) {
        Bsp bsp = make_bsp();
        faults[i].second(bsp);
        try {
            read_bsp(write_bsp(bsp), "maps/broken.bsp");
            ADD_FAILURE() << "fault " << i << " in " << faults[i].first << " was not found";
        } catch (const FormatError& error) {
            EXPECT_NE(error.reason().find(std::string("lump ") + faults[i].first), std::string::npos)
                << i << ": " << error.what();
        }
    }
}

TEST(Bsp, RefusesOtherFiles)
{
    auto file = write_bsp(make_bsp());
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

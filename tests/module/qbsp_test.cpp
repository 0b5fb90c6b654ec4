// SPDX-License-Identifier: GPL-2.0-or-later
// Maps in the extended format: the same map gives the same picture, bit for bit, and one that is too large for IBSP is
// seen whole.
#include "tests/lights/synthetic_bsp.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cstring>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

// What a session shows of a map, and the scene that it is made of.
struct Shown {
    Radiance picture;
    std::vector<SceneTriangle> triangles;
    std::vector<SceneEmitter> emitters;
};

template <class T> bool same_bytes(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

Shown show(Session& session, const std::string& map, glm::vec3 eye, glm::vec3 target)
{
    session.load_map(map);
    session.look(eye, target);
    Shown shown;
    shown.picture = session.accumulate(8);
    SceneContents contents;
    EXPECT_TRUE(session.extension().read_scene(&contents));
    shown.triangles.assign(contents.triangles, contents.triangles + contents.triangle_count);
    shown.emitters.assign(contents.emitters, contents.emitters + contents.emitter_count);
    return shown;
}

void add_in_both_formats(const GameFolder& folder, const std::string& name, formats::Bsp bsp)
{
    bsp.format = formats::BspFormat::ibsp;
    folder.add_map(name, bsp);
    bsp.format = formats::BspFormat::qbsp;
    folder.add_map(name + "_wide", bsp);
}

TEST(Qbsp, ShowsWhatTheSameMapShowsAsIbsp)
{
    GameFolder folder;
    folder.add_wall("wall", 180);
    folder.add_wall("lamp", warm_index);
    MapBuilder room;
    room.add_lit_room("wall");
    room.add_point_light({ -60, 40, 30 }, 200);
    add_in_both_formats(folder, "room", room.finish());
    // Rooms of many clusters, nodes and leaves; their textures are not there and shown grey.
    add_in_both_formats(folder, "cells", test::make_cell_map(5, test::make_random_cells(5, 0.7, 3)));
    Session session(folder);
    const auto expect_same = [&](const std::string& name, glm::vec3 eye, glm::vec3 target) {
        const Shown narrow = show(session, name, eye, target), wide = show(session, name + "_wide", eye, target);
        EXPECT_FALSE(is_black(narrow.picture)) << name;
        EXPECT_TRUE(narrow.picture == wide.picture) << name;
        EXPECT_GT(narrow.emitters.size(), 0u) << name;
        EXPECT_TRUE(same_bytes(narrow.emitters, wide.emitters)) << name;
        EXPECT_TRUE(same_bytes(narrow.triangles, wide.triangles)) << name;
    };
    expect_same("room", { -100, -100, 40 }, { 20, 20, 0 });
    const formats::Bsp cells = test::make_cell_map(5, test::make_random_cells(5, 0.7, 3));
    const formats::BspLeaf& leaf = cells.leaves.back();
    const glm::vec3 low(leaf.mins[0], leaf.mins[1], leaf.mins[2]), high(leaf.maxs[0], leaf.maxs[1], leaf.maxs[2]);
    expect_same("cells", glm::mix(low, high, 0.5f), glm::mix(low, high, 0.2f));
}

constexpr int tiles_across = 280; // 78,400 faces, with a plane and four vertices and edges each

// A floor of squares with a side of 1: the last ones, which 16 bits cannot count to, are red.
formats::Bsp make_tiled_floor()
{
    MapBuilder map;
    const uint16_t wall = map.add_material("wall"), red = map.add_material("red");
    map.add(rectangle({ 0, 0, 200 }, { 0, 64, 0 }, { 64, 0, 0 }), map.add_material("lamp", 0, 1000));
    for (int tile = 0; tile < tiles_across * tiles_across; tile++) {
        const glm::vec3 centre(tile % tiles_across - tiles_across / 2, tile / tiles_across - tiles_across / 2, 0);
        map.add(rectangle(centre, { 0.5f, 0, 0 }, { 0, 0.5f, 0 }), tile > 65'536 ? red : wall);
    }
    formats::Bsp bsp = map.finish();
    bsp.format = formats::BspFormat::qbsp;
    return bsp;
}

TEST(Qbsp, MapsBeyondTheLimitsOf16BitsAreSeenWhole)
{
    GameFolder folder;
    folder.add_wall("wall", green_index);
    folder.add_wall("red", red_index);
    folder.add_wall("lamp", white_index);
    const formats::Bsp bsp = make_tiled_floor();
    EXPECT_GT(bsp.faces.size(), 70'000u);
    EXPECT_GT(bsp.vertices.size(), 300'000u);
    folder.add_map("tiles", bsp);
    Session session(folder, { { "pt_bounces", "0" } });
    session.load_map("tiles");
    constexpr int first_red_row = 65'537 / tiles_across + 1;
    const auto colour_at = [&](int row) {
        const glm::vec3 place(0, row - tiles_across / 2, 0);
        session.look(place + glm::vec3(0, -2, 6), place);
        return session.accumulate(8).mean({ 28, 20 }, { 36, 28 });
    };
    for (const int row : { first_red_row + 3, tiles_across - 8 }) {
        const glm::vec3 seen = colour_at(row);
        EXPECT_GT(seen.x, 5 * seen.y) << row;
        EXPECT_GT(seen.x, 0.01f) << row;
    }
    for (const int row : { 8, first_red_row - 4 }) {
        const glm::vec3 seen = colour_at(row);
        EXPECT_GT(seen.y, 5 * seen.x) << row;
        EXPECT_GT(seen.y, 0.01f) << row;
    }
}

TEST(Qbsp, DamagedOnesAreNamedAndTheNextMapWorks)
{
    GameFolder folder;
    folder.add_wall("wall", 180);
    folder.add_wall("lamp", white_index);
    MapBuilder room;
    room.add_lit_room("wall");
    add_in_both_formats(folder, "room", room.finish());
    formats::Bsp bad = room.finish();
    bad.format = formats::BspFormat::qbsp;
    bad.leaf_faces[2] = 0x10002; // face 2, if the upper half were ignored
    folder.add_map("bad", bad);
    Session session(folder);
    try {
        session.load_map("bad");
        ADD_FAILURE() << "loaded";
    } catch (const std::exception& failure) {
        const std::string message = failure.what();
        EXPECT_NE(message.find("maps/bad.bsp: at byte "), std::string::npos) << message;
        EXPECT_NE(message.find("lump leaf faces, record 2: face 65538 of "), std::string::npos) << message;
    }
    EXPECT_FALSE(is_black(show(session, "room_wide", { -100, -100, 40 }, { 20, 20, 0 }).picture));
}

} // namespace
} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// Map after map in one run: nothing is left behind.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <array>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace vkpt::tests {
namespace {

using Counters = std::array<uint64_t, 9>;

Counters read_counters(Session& session)
{
    const ModuleInfo info = session.extension().info();
    return { info.triangles, info.emitters, info.light_list_entries, info.textures, info.texture_bytes,
        info.geometry_bytes, info.acceleration_bytes, info.light_bytes, info.staging_bytes + info.image_bytes };
}

size_t resident_bytes()
{
    std::ifstream stream("/proc/self/statm");
    size_t whole = 0, resident = 0;
    stream >> whole >> resident;
    return resident * size_t(sysconf(_SC_PAGESIZE));
}

void add_small_map(GameFolder& folder)
{
    folder.add_wall("small_wall", 150);
    folder.add_wall("lamp", white_index);
    MapBuilder map;
    map.add_lit_room("small_wall");
    folder.add_map("small", map.finish());
}

void add_large_map(GameFolder& folder)
{
    MapBuilder map;
    map.add_room({ -1024, -1024, 0 }, { 1024, 1024, 256 }, map.add_material("missing"));
    for (int i = 0; i < 100; i++) {
        const std::string name = fmt::format("block{}", i % 10);
        if (i < 10)
            folder.add_wall(name, uint8_t(100 + i));
        const glm::vec3 corner(float(i % 10) * 180 - 900, float(i / 10) * 180 - 900, 0);
        map.add_block(corner, corner + glm::vec3(40, 40, 60), map.add_material(name));
        map.add_point_light(corner + glm::vec3(20, 20, 150), 150);
    }
    map.begin_brush_model();
    map.add_block({ 0, 0, 100 }, { 32, 32, 120 }, map.add_material("block0"));
    folder.add_map("large", map.finish());
}

TEST(MapChange, FiftyInARowLeaveNothingBehind)
{
    constexpr int changes = 50, warm_up = 10;
    constexpr double max_growth = 4 << 20; // bytes
    GameFolder folder;
    add_small_map(folder);
    add_large_map(folder);
    const std::string cube = folder.add_cube("cube", 8, red_index);
    Session::end_idle(); // buffers that others let grow would hide growth
    Session session(folder);
    session.look({ -100, -100, 80 }, { 0, 0, 20 });
    Counters first[2] {};
    size_t resident = 0;
    for (int change = 0; change < changes; change++) {
        const bool is_large = change % 2;
        session.load_map(is_large ? "large" : "small");
        // The large map's model goes with it.
        const engine::Entity entity
            = make_entity(is_large ? session.module().register_model(cube.c_str()) : nullptr, { 0, 0, 40 });
        session.view.entities = &entity;
        session.view.entity_count = 1;
        session.draw(2);
        EXPECT_FALSE(is_black(session.capture()));
        const Counters counters = read_counters(session);
        // Buffers that grew once stay as large as they were needed.
        if (change < 2)
            continue;
        if (change < 4)
            first[change % 2] = counters;
        EXPECT_EQ(counters, first[change % 2]) << "change " << change;
        if (change == warm_up)
            resident = resident_bytes();
    }
    EXPECT_NE(first[0], first[1]);
    EXPECT_LT(double(resident_bytes()) - double(resident), max_growth);
}

// A new start of the renderer in the same process, as after vid_restart.
TEST(MapChange, StartingAgainGivesTheSamePicture)
{
    GameFolder folder;
    add_small_map(folder);
    Radiance first;
    Counters counters {};
    for (int start = 0; start < 3; start++) {
        Session::end_idle();
        Session session(folder);
        session.load_map("small");
        session.look({ -100, -100, 80 }, { 0, 0, 20 });
        session.draw();
        if (start == 0) {
            first = session.capture();
            counters = read_counters(session);
            EXPECT_FALSE(is_black(first));
        }
        EXPECT_TRUE(session.capture() == first) << "start " << start;
        EXPECT_EQ(read_counters(session), counters) << "start " << start;
    }
}

} // namespace
} // namespace vkpt::tests

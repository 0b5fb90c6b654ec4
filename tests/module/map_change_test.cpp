// SPDX-License-Identifier: GPL-2.0-or-later
// Map after map in one run: nothing is left behind.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <malloc.h>
#include <memory>
#include <thread>
#include <unistd.h>
#include <vector>

namespace vkpt::tests {
namespace {

using namespace std::chrono_literals;
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

// Memory that a thread has freed and the C library keeps, as drivers' compilers leave it: a page here and there is
// still in use.
class FreedHeap {
public:
    FreedHeap()
    {
        std::thread([this] {
            std::vector<std::unique_ptr<std::byte[]>> pages;
            for (size_t i = 0; i < bytes / page_bytes; i++) {
                pages.push_back(std::make_unique<std::byte[]>(page_bytes));
                if (i % 1000 == 999)
                    used_.push_back(std::move(pages.back()));
            }
        }).join();
    }
    static constexpr size_t bytes = 48 << 20;

private:
    static constexpr size_t page_bytes = 4000;
    std::vector<std::unique_ptr<std::byte[]>> used_;
};

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

// Compilers free most of it after the map has been loaded: with the first frames.
TEST(MapChange, GivesBackWhatTheFirstFramesFreed)
{
#if defined(__SANITIZE_ADDRESS__) || !defined(__GLIBC__)
    GTEST_SKIP() << "only glibc keeps what is freed";
#else
    using Clock = std::chrono::steady_clock;
    constexpr size_t most = FreedHeap::bytes / 2;
    GameFolder folder;
    add_small_map(folder);
    Session session(folder);
    session.load_map("small");
    session.look({ -100, -100, 80 }, { 0, 0, 20 });
    session.draw(3);
    malloc_trim(0); // what earlier tests have freed
    const size_t before = resident_bytes();
    const FreedHeap heap;
    ASSERT_GT(resident_bytes(), before + most) << "the C library keeps nothing";
    for (const auto start = Clock::now(); resident_bytes() > before + most && Clock::now() - start < 10s;) {
        session.draw();
        std::this_thread::sleep_for(50ms);
    }
    EXPECT_LT(resident_bytes(), before + most);
#endif
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

// SPDX-License-Identifier: GPL-2.0-or-later
#include "glsl_libraries.hpp"
#include "ref_vkpt/lights/emitters.hpp"
#include "ref_vkpt/lights/light_lists.hpp"
#include "synthetic_bsp.hpp"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>

namespace vkpt::test {
namespace {

using shared::Emitter;

std::vector<uint32_t> collect_list(const LightLists& lists, size_t cluster)
{
    const shared::LightList& list = lists.lists()[cluster];
    const auto first = lists.static_indices().begin() + list.first_static;
    std::vector<uint32_t> all(first, first + list.static_count);
    const auto second = lists.dynamic_indices().begin() + list.first_dynamic;
    all.insert(all.end(), second, second + list.dynamic_count);
    return all;
}

bool is_strictly_ascending(const std::vector<uint32_t>& list)
{
    return std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) == list.end();
}

class CellWorld {
public:
    CellWorld(int size, double open_share, uint32_t seed)
        : bsp(make_cell_map(size, make_random_cells(size, open_share, seed)))
        , rng(seed)
        , extent(float(size) * cell_size)
    {
    }

    glm::vec3 point_in_the_open()
    {
        for (;;) {
            const glm::vec3 p(extent * unit(rng), extent * unit(rng), cell_size * unit(rng));
            if (bsp.find_cluster(p) >= 0)
                return p;
        }
    }

    Emitter random_emitter(float reach)
    {
        Emitter e {};
        e.p0 = point_in_the_open();
        e.reach = reach;
        e.radiance = glm::vec3(1);
        if (rng() % 2) {
            e.type = shared::EMITTER_SPHERE;
            e.p1 = glm::vec3(1 + 7 * unit(rng), 0, 0);
            return e;
        }
        e.p1 = e.p0 + 60.0f * glm::vec3(unit(rng) - 0.5f, unit(rng) - 0.5f, unit(rng) - 0.5f);
        e.p2 = e.p0 + 60.0f * glm::vec3(unit(rng) - 0.5f, unit(rng) - 0.5f, unit(rng) - 0.5f);
        return e;
    }

    glm::vec3 point_on(const Emitter& e)
    {
        if (e.type == shared::EMITTER_SPHERE)
            return e.p0;
        const float a = unit(rng), b = (1 - a) * unit(rng);
        return e.p0 + (e.p1 - e.p0) * a + (e.p2 - e.p0) * b;
    }

    formats::Bsp bsp;
    std::mt19937 rng;
    std::uniform_real_distribution<float> unit { 0, 1 };
    float extent;
};

bool is_in_front(const Emitter& e, glm::vec3 p)
{
    return e.type == shared::EMITTER_SPHERE || glm::dot(glm::cross(e.p1 - e.p0, e.p2 - e.p0), p - e.p0) > 0;
}

void expect_well_formed(const LightLists& lists, size_t emitter_count)
{
    for (size_t cluster = 0; cluster < lists.lists().size(); cluster++) {
        const std::vector<uint32_t> list = collect_list(lists, cluster);
        ASSERT_TRUE(is_strictly_ascending(list)) << "cluster " << cluster;
        ASSERT_TRUE(list.empty() || list.back() < emitter_count);
    }
    EXPECT_EQ(collect_list(lists, lists.lists().size() - 1).size(), emitter_count) << "the list for outside holds all";
}

TEST(LightLists, HoldEveryEmitterThatIsInSight)
{
    for (uint32_t seed = 1; seed <= 4; seed++) {
        CellWorld world(12, 0.6, seed);
        std::vector<Emitter> fixed, moving;
        for (int i = 0; i < 150; i++)
            fixed.push_back(world.random_emitter(0));
        for (int i = 0; i < 30; i++)
            moving.push_back(world.random_emitter(i % 2 ? 0.0f : 200.0f));
        LightLists lists;
        lists.build(world.bsp, fixed);
        lists.update(moving);
        expect_well_formed(lists, fixed.size() + moving.size());

        int seen = 0;
        for (int i = 0; i < 200000; i++) {
            const size_t index = world.rng() % (fixed.size() + moving.size());
            const Emitter& e = index < fixed.size() ? fixed[index] : moving[index - fixed.size()];
            const glm::vec3 from = world.point_in_the_open(), to = world.point_on(e);
            if ((e.reach > 0 && glm::distance(from, e.p0) > e.reach) || !is_in_front(e, from)
                || !is_line_clear(world.bsp, from, to))
                continue;
            seen++;
            const std::vector<uint32_t> list = collect_list(lists, size_t(world.bsp.find_cluster(from)));
            ASSERT_TRUE(std::binary_search(list.begin(), list.end(), uint32_t(index))) << "seed " << seed;
        }
        EXPECT_GT(seen, 1000);
    }
}

// The lists must also be useful: emitters in other, separate rooms and out of reach are left out.
// Compilers compute each direction for itself, and may find one of them only.
TEST(LightLists, HoldWhatIsSeenInOneDirectionOnly)
{
    constexpr uint32_t clusters = 16, row_bytes = clusters / 8;
    formats::Bsp bsp = make_cell_map(4, std::vector<bool>(clusters, true));
    ASSERT_EQ(bsp.cluster_count, int(clusters));
    // The first sees itself alone, and all see it.
    std::vector<uint32_t> head { clusters };
    std::vector<uint8_t> rows;
    for (uint32_t cluster = 0; cluster < clusters; cluster++) {
        const uint32_t offset = uint32_t(4 + 8 * clusters + rows.size());
        head.insert(head.end(), { offset, offset });
        if (cluster == 0)
            rows.insert(rows.end(), { 1, 0, row_bytes - 1 }); // a zero, and how many
        else
            rows.insert(rows.end(), row_bytes, 0xff);
    }
    bsp.visibility.resize(4 * head.size());
    std::memcpy(bsp.visibility.data(), head.data(), bsp.visibility.size());
    bsp.visibility.insert(bsp.visibility.end(), rows.begin(), rows.end());
    ASSERT_FALSE(bsp.pvs(0).contains(9));
    ASSERT_TRUE(bsp.pvs(9).contains(0));

    std::vector<Emitter> emitters(clusters);
    for (uint32_t i = 0; i < clusters; i++) {
        emitters[i].type = shared::EMITTER_SPHERE;
        emitters[i].p0 = cell_size * glm::vec3(float(i % 4) + 0.5f, float(i / 4) + 0.5f, 0.5f);
        emitters[i].p1 = glm::vec3(2, 0, 0);
        emitters[i].radiance = glm::vec3(1);
    }
    LightLists lists;
    lists.build(bsp, emitters);
    for (size_t cluster = 0; cluster < clusters; cluster++)
        EXPECT_EQ(collect_list(lists, cluster).size(), clusters) << cluster;
}

TEST(LightLists, LeaveOutWhatCannotBeSeen)
{
    CellWorld world(12, 0.35, 9);
    std::vector<Emitter> fixed, moving;
    for (int i = 0; i < 100; i++)
        fixed.push_back(world.random_emitter(0));
    for (int i = 0; i < 100; i++) {
        moving.push_back(world.random_emitter(64));
        moving.back().type = shared::EMITTER_SPHERE;
        moving.back().p1 = glm::vec3(1, 0, 0);
    }
    LightLists lists;
    lists.build(world.bsp, fixed);
    lists.update(moving);
    for (size_t i = 0; i < moving.size(); i++)
        for (size_t leaf = 1; leaf < world.bsp.leaves.size(); leaf++) {
            const formats::BspLeaf& l = world.bsp.leaves[leaf];
            const glm::vec3 mins(l.mins[0], l.mins[1], l.mins[2]), maxs(l.maxs[0], l.maxs[1], l.maxs[2]);
            const float distance = glm::distance(glm::clamp(moving[i].p0, mins, maxs), moving[i].p0);
            const std::vector<uint32_t> list = collect_list(lists, size_t(l.cluster));
            const bool listed = std::binary_search(list.begin(), list.end(), uint32_t(fixed.size() + i));
            ASSERT_FALSE(listed && distance > 70);
        }
    size_t entries = 0;
    for (size_t cluster = 0; cluster + 1 < lists.lists().size(); cluster++)
        entries += lists.lists()[cluster].static_count;
    EXPECT_LT(entries, fixed.size() * (lists.lists().size() - 1) / 2);
}

// A lamp in the floor lights what is above it, and one in the ceiling what is below.
TEST(LightLists, LeaveOutWhatIsBehindAnEmitter)
{
    CellWorld world(4, 1, 1);
    const float middle = 1.5f * cell_size;
    Emitter east {};
    east.radiance = glm::vec3(1);
    east.p0 = glm::vec3(2 * cell_size - 8, middle, 40);
    east.p1 = east.p0 + glm::vec3(0, 10, 0);
    east.p2 = east.p0 + glm::vec3(0, 0, 10);
    ASSERT_TRUE(is_in_front(east, east.p0 + glm::vec3(1, 0, 0)));
    Emitter west = east;
    std::swap(west.p1, west.p2);
    LightLists lists;
    lists.build(world.bsp, std::vector { east });
    lists.update(std::vector { west });
    for (int column = 0; column < 4; column++) {
        const glm::vec3 p((float(column) + 0.5f) * cell_size, middle, 64);
        const std::vector<uint32_t> list = collect_list(lists, size_t(world.bsp.find_cluster(p)));
        EXPECT_EQ(std::ranges::count(list, 0u), column >= 1) << column; // their own cell is on both sides
        EXPECT_EQ(std::ranges::count(list, 1u), column <= 1) << column;
    }
}

// Births, moves and deaths leave nothing behind: the lists equal those of a fresh object, and the static part is
// untouched.
TEST(LightLists, UpdatesEqualListsFromScratch)
{
    CellWorld world(10, 0.6, 21);
    std::vector<Emitter> fixed, moving;
    for (int i = 0; i < 40; i++)
        fixed.push_back(world.random_emitter(0));
    LightLists lists;
    lists.build(world.bsp, fixed);
    const std::vector<uint32_t> static_before = lists.static_indices();
    for (int step = 0; step < 10000; step++) {
        const uint32_t action = world.rng() % 3;
        if (action == 0 && moving.size() < 32)
            moving.push_back(world.random_emitter(world.rng() % 3 ? 150.0f : 0.0f));
        else if (action == 1 && !moving.empty())
            moving.erase(moving.begin() + ptrdiff_t(world.rng() % moving.size()));
        else if (!moving.empty())
            moving[world.rng() % moving.size()].p0 += 40.0f * glm::vec3(world.unit(world.rng) - 0.5f);
        lists.update(moving);
        if (step % 20 != 0)
            continue;
        LightLists fresh;
        fresh.build(world.bsp, fixed);
        fresh.update(moving);
        for (size_t cluster = 0; cluster < fresh.lists().size(); cluster++)
            ASSERT_EQ(collect_list(lists, cluster), collect_list(fresh, cluster)) << "step " << step;
        expect_well_formed(lists, fixed.size() + moving.size());
    }
    EXPECT_EQ(lists.static_indices(), static_before);
}

TEST(LightLists, EmittersInSolidAreCountedAndListedOutside)
{
    CellWorld world(4, 1, 1);
    Emitter buried {};
    buried.type = shared::EMITTER_SPHERE;
    buried.p0 = glm::vec3(-500);
    buried.p1 = glm::vec3(4, 0, 0);
    buried.radiance = glm::vec3(1);
    LightLists lists;
    lists.build(world.bsp, std::vector { buried });
    EXPECT_EQ(lists.unlisted_static_count(), 1u);
    EXPECT_EQ(collect_list(lists, 0).size(), 0u);
    EXPECT_EQ(collect_list(lists, lists.lists().size() - 1).size(), 1u);
    lists.update(std::vector { buried }); // what moves may pass through a wall: it stays listed
    EXPECT_EQ(collect_list(lists, 0).size(), 1u);
}

// Thousands of lights, each seen from everywhere, every frame: what finds no room lights nothing, and finds room again.
TEST(LightLists, MovingLightsFindRoomOrAreLeftOut)
{
    CellWorld world(32, 1, 1);
    LightLists lists;
    lists.build(world.bsp, {});
    const size_t clusters = lists.lists().size() - 1, fit = LightLists::max_dynamic_entries / clusters;
    Emitter lamp {};
    lamp.type = shared::EMITTER_SPHERE;
    lamp.p0 = world.point_in_the_open();
    lamp.p1 = glm::vec3(4, 0, 0);
    lamp.radiance = glm::vec3(1);
    std::vector<Emitter> moving(fit + 3, lamp);
    lists.update(moving);
    EXPECT_EQ(collect_list(lists, 0).size(), fit);
    EXPECT_EQ(collect_list(lists, clusters).size(), moving.size()) << "outside";
    EXPECT_EQ(lists.unlisted_dynamic_count(), 3u);
    lists.update(moving);
    EXPECT_FALSE(lists.has_changed());
    EXPECT_EQ(lists.unlisted_dynamic_count(), 3u);
    for (size_t i = 0; i < 2; i++)
        moving[i].radiance = glm::vec3(0);
    lists.update(moving);
    EXPECT_EQ(lists.unlisted_dynamic_count(), 1u);
    EXPECT_EQ(collect_list(lists, 0).back(), moving.size() - 2);
}

TEST(LightLists, MapWithoutVisibilityHasOneList)
{
    CellWorld world(4, 1, 1);
    world.bsp.cluster_count = 0;
    world.bsp.visibility.clear();
    std::vector<Emitter> fixed { world.random_emitter(0), world.random_emitter(0) };
    LightLists lists;
    lists.build(world.bsp, fixed);
    lists.update(fixed);
    ASSERT_EQ(lists.lists().size(), 1u);
    EXPECT_EQ(collect_list(lists, 0), (std::vector<uint32_t> { 0, 1, 2, 3 }));
    EXPECT_EQ(lists.unlisted_static_count(), 0u);
    EXPECT_EQ(glsl::find_cluster({ lists.tree().data() }, world.point_in_the_open()), -1);
}

TEST(LightLists, MapOfOneLeafWorks)
{
    formats::Bsp bsp;
    bsp.leaves.push_back({});
    bsp.models.push_back({});
    bsp.models[0].head_node = -1;
    LightLists lists;
    lists.build(bsp, {});
    EXPECT_EQ(glsl::find_cluster({ lists.tree().data() }, glm::vec3(1, 2, 3)), -1);
}

TEST(LightLists, ShadersFindTheSameCluster)
{
    CellWorld world(16, 0.6, 5);
    LightLists lists;
    lists.build(world.bsp, {});
    const glsl::BspTreeBuffer tree { lists.tree().data() };
    for (int i = 0; i < 100000; i++) {
        const glm::vec3 p(world.extent * (1.4f * world.unit(world.rng) - 0.2f),
            world.extent * (1.4f * world.unit(world.rng) - 0.2f), cell_size * (1.4f * world.unit(world.rng) - 0.2f));
        ASSERT_EQ(glsl::find_cluster(tree, p), world.bsp.find_cluster(p));
    }
}

TEST(LightLists, ShadersReadTheLists)
{
    CellWorld world(6, 0.8, 5);
    std::vector<Emitter> emitters;
    for (int i = 0; i < 30; i++)
        emitters.push_back(world.random_emitter(0));
    LightLists lists;
    lists.build(world.bsp, std::span(emitters).first(20));
    lists.update(std::span(emitters).last(10));
    glsl::LightTables tables {};
    tables.lists.v = lists.lists().data();
    tables.static_indices.v = lists.static_indices().data();
    tables.dynamic_indices.v = lists.dynamic_indices().data();
    tables.list_count = uint32_t(lists.lists().size());
    for (int cluster = -1; cluster < int(tables.list_count) - 1; cluster++) {
        const glsl::LightListView view = glsl::open_light_list(tables, cluster);
        const std::vector<uint32_t> expected
            = collect_list(lists, cluster < 0 ? tables.list_count - 1 : size_t(cluster));
        ASSERT_EQ(glsl::light_count(view), expected.size());
        for (uint32_t i = 0; i < expected.size(); i++)
            ASSERT_EQ(glsl::light_at(view, i), expected[i]);
        for (uint32_t emitter = 0; emitter < 31; emitter++) {
            const auto at = std::lower_bound(expected.begin(), expected.end(), emitter);
            const bool listed = at != expected.end() && *at == emitter;
            ASSERT_EQ(glsl::find_light(view, emitter), listed ? int(at - expected.begin()) : -1);
        }
    }
}

// Lists as long and with gaps as wide as can be, of which a part has just come: every index is found, whichever it is.
TEST(LightLists, ShadersFindPlacesInRepeatedLists)
{
    std::mt19937 rng(7);
    const auto draw = [&](uint32_t least, uint32_t most) { return std::uniform_int_distribution(least, most)(rng); };
    for (int round = 0; round < 300; round++) {
        const uint32_t max_apart = 1u << draw(0, 12);
        uint32_t next = draw(0, 1) ? 0 : draw(0, 5000);
        const auto make_run = [&](size_t count) {
            std::vector<uint32_t> run;
            for (; run.size() < count; next += draw(1, max_apart))
                run.push_back(next);
            return run;
        };
        const std::vector<uint32_t> fixed = make_run(draw(0, 400));
        const uint32_t behind_fixed = next;
        std::vector<uint32_t> moving = make_run(draw(0, 40));
        const uint32_t counted = uint32_t(fixed.size() + moving.size());
        next = behind_fixed; // between the others' indices, where they left gaps
        for (const uint32_t index : make_run(draw(0, 40)))
            if (!std::binary_search(moving.begin(), moving.begin() + (counted - fixed.size()), index))
                moving.push_back(index);
        glsl::LightListView view {};
        view.tables.static_indices.v = fixed.data();
        view.tables.dynamic_indices.v = moving.data();
        view.range.static_count = uint32_t(fixed.size());
        view.range.dynamic_count = uint32_t(moving.size());
        view.counted = counted;
        std::map<uint32_t, int> places;
        for (uint32_t i = 0; i < glsl::light_count(view); i++)
            places[glsl::light_at(view, i)] = int(i);
        for (const auto& [index, place] : places)
            for (const uint32_t near : { index - 1, index, index + 1 }) {
                const auto found = places.find(near);
                ASSERT_EQ(glsl::find_light(view, near), found == places.end() ? -1 : found->second)
                    << "round " << round;
            }
        ASSERT_EQ(glsl::find_light(view, 0xffffffffu), -1);
        const glsl::LightListView before = glsl::counted_lights(view), come = glsl::newcomers(view);
        ASSERT_EQ(glsl::light_count(before), counted);
        ASSERT_EQ(glsl::light_count(come), places.size() - counted);
        for (const auto& [index, place] : places)
            ASSERT_EQ(uint32_t(place) < counted ? glsl::light_at(before, uint32_t(place))
                                                : glsl::light_at(come, uint32_t(place) - counted),
                index);
    }
}

} // namespace
} // namespace vkpt::test

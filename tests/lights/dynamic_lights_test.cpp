// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/dynamic_lights.hpp"
#include "ref_vkpt/lights/light_lists.hpp"
#include "synthetic_bsp.hpp"

#include <algorithm>
#include <ctime>
#include <gtest/gtest.h>
#include <iterator>
#include <random>

namespace vkpt::test {
namespace {

using shared::Emitter;

constexpr int map_size = 10; // cells
constexpr size_t max_lights = 64;

// A light of the game, with the name that the engine does not tell.
struct GameLight {
    Emitter emitter;
    int name = 0;
};

class Game {
public:
    explicit Game(uint32_t seed)
        : rng_(seed)
    {
    }

    // One birth, move or death. Each light has a cell of its own and moves less than to the next one: nobody could take
    // one for another.
    void step()
    {
        const uint32_t action = rng_() % 3;
        if (action == 0 && lights.size() < max_lights)
            lights.insert(lights.begin() + ptrdiff_t(rng_() % (lights.size() + 1)), { make_light(), names_++ });
        else if (action == 1 && !lights.empty())
            lights.erase(lights.begin() + ptrdiff_t(rng_() % lights.size()));
        else if (!lights.empty())
            lights[rng_() % lights.size()].emitter.p0.z = 20 + 80 * unit();
    }

    std::vector<Emitter> emitters() const
    {
        std::vector<Emitter> result;
        for (const GameLight& light : lights)
            result.push_back(light.emitter);
        return result;
    }

    std::vector<GameLight> lights;

private:
    float unit() { return float(rng_() >> 8) * 0x1p-24f; }

    Emitter make_light()
    {
        Emitter e {};
        do {
            const int cell = place_++ % (map_size * map_size);
            e.p0 = cell_size * glm::vec3(float(cell % map_size) + 0.5f, float(cell / map_size) + 0.5f, 0.3f);
        } while (std::ranges::any_of(lights,
            [&](const GameLight& light) { return light.emitter.p0.x == e.p0.x && light.emitter.p0.y == e.p0.y; }));
        e.radiance = glm::vec3(1);
        if (rng_() % 2) {
            e.type = shared::EMITTER_SPHERE;
            e.p1 = glm::vec3(4, 0, 0);
            e.lightstyle = rng_() % 3;
            e.reach = 200;
            return e;
        }
        e.area = 50 + float(rng_() % 3);
        e.p1 = e.p0 + glm::vec3(10, 0, 0);
        e.p2 = e.p0 + glm::vec3(0, 10, 0);
        return e;
    }

    std::mt19937 rng_;
    int names_ = 0, place_ = 0;
};

TEST(DynamicLights, KeepTheirSlotsWhileTheyLive)
{
    Game game(4);
    DynamicLights slots;
    std::vector<std::pair<int, uint32_t>> before; // name, slot
    for (int step = 0; step < 10000; step++) {
        game.step();
        std::vector<Emitter> arranged = game.emitters();
        const std::vector<uint32_t> slot = slots.arrange(arranged);
        ASSERT_LE(arranged.size(), max_lights);
        std::vector<std::pair<int, uint32_t>> now;
        std::vector<bool> taken(arranged.size(), false);
        for (size_t i = 0; i < game.lights.size(); i++) {
            ASSERT_FALSE(taken[slot[i]]);
            taken[slot[i]] = true;
            ASSERT_EQ(arranged[slot[i]].p0, game.lights[i].emitter.p0);
            now.emplace_back(game.lights[i].name, slot[i]);
            const auto old = std::ranges::find(before, game.lights[i].name, &std::pair<int, uint32_t>::first);
            ASSERT_EQ(old != before.end(), slots.lived_before()[slot[i]]) << "step " << step;
            ASSERT_TRUE(old == before.end() || old->second == slot[i]) << "step " << step;
        }
        for (size_t i = 0; i < taken.size(); i++)
            ASSERT_TRUE(taken[i] || is_dark(arranged[i]));
        before = now;
    }
}

// 10,000 births, moves and deaths: the lists that were updated equal those of a fresh object.
TEST(DynamicLights, ListsOfSlotsEqualListsFromScratch)
{
    const formats::Bsp bsp = make_cell_map(map_size, make_random_cells(map_size, 0.6, 2));
    Game game(5);
    DynamicLights slots;
    LightLists lists;
    lists.build(bsp, {});
    std::vector<uint32_t> lengths(lists.lists().size(), 0);
    for (int step = 0; step < 10000; step++) {
        game.step();
        std::vector<Emitter> arranged = game.emitters();
        slots.arrange(arranged);
        lists.update(arranged);
        ASSERT_EQ(lists.previous_lengths(), lengths);
        for (size_t i = 0; i < lengths.size(); i++)
            lengths[i] = lists.lists()[i].dynamic_count;
        LightLists fresh;
        fresh.build(bsp, {});
        fresh.update(arranged);
        ASSERT_EQ(lists.dynamic_indices(), fresh.dynamic_indices());
        for (size_t i = 0; i < lengths.size(); i++)
            ASSERT_EQ(lists.lists()[i].first_dynamic, fresh.lists()[i].first_dynamic);
    }
}

// Who repeats the last frame's random numbers meets what was there at its old place, and all that has come behind it.
TEST(DynamicLights, RepeatedListsKeepOldPlaces)
{
    const formats::Bsp bsp = make_cell_map(map_size, make_random_cells(map_size, 0.6, 2));
    Game game(7);
    DynamicLights slots;
    LightLists lists;
    lists.build(bsp, {});
    std::vector<shared::LightList> old_lists = lists.lists();
    std::vector<uint32_t> old_indices;
    size_t old_count = 0, with_gone_lights = 0;
    for (int step = 0; step < 300; step++) {
        game.step();
        std::vector<Emitter> arranged = game.emitters();
        slots.arrange(arranged);
        lists.update(arranged);
        const LightLists::Repeated repeated = lists.repeat();
        EXPECT_EQ(repeated.emitter_count, lists.has_changed() ? std::max(old_count, arranged.size()) : arranged.size());
        for (size_t i = 0; i < old_lists.size(); i++) {
            const auto part = [](const std::vector<uint32_t>& indices, size_t first, size_t count) {
                return std::vector(indices.begin() + long(first), indices.begin() + long(first + count));
            };
            const shared::LightList& list = repeated.lists[i];
            const std::vector<uint32_t> all = part(repeated.dynamic_indices, list.first_dynamic, list.dynamic_count);
            const auto before = part(old_indices, old_lists[i].first_dynamic, old_lists[i].dynamic_count);
            const auto now
                = part(lists.dynamic_indices(), lists.lists()[i].first_dynamic, lists.lists()[i].dynamic_count);
            ASSERT_EQ(lists.previous_lengths()[i], before.size());
            ASSERT_EQ(part(all, 0, before.size()), before);
            std::vector<uint32_t> expected;
            std::ranges::set_union(before, now, std::back_inserter(expected));
            std::vector<uint32_t> sorted = all;
            std::ranges::sort(sorted);
            ASSERT_EQ(sorted, expected);
            with_gone_lights += all.size() > now.size();
        }
        old_lists = lists.lists();
        old_indices = lists.dynamic_indices();
        old_count = arranged.size();
    }
    EXPECT_GT(with_gone_lights, 0u);
}

TEST(DynamicLights, ThatGoOutAreInNoList)
{
    const formats::Bsp bsp = make_cell_map(map_size, std::vector<bool>(map_size * map_size, true));
    std::vector<Emitter> lights(3);
    for (size_t i = 0; i < lights.size(); i++) {
        lights[i].type = shared::EMITTER_SPHERE;
        lights[i].p0 = glm::vec3(400 * float(i) + 100, 300, 60);
        lights[i].p1.x = 4;
        lights[i].radiance = glm::vec3(1);
    }
    DynamicLights slots;
    LightLists lists;
    lists.build(bsp, {});
    std::vector<Emitter> arranged = lights;
    slots.arrange(arranged);
    lists.update(arranged);
    EXPECT_EQ(lists.lists().back().dynamic_count, 3u);
    arranged = { lights[0], lights[2] };
    EXPECT_EQ(slots.arrange(arranged), (std::vector<uint32_t> { 0, 2 }));
    lists.update(arranged);
    EXPECT_TRUE(std::ranges::find(lists.dynamic_indices(), 1u) == lists.dynamic_indices().end());
    EXPECT_EQ(lists.lists().back().dynamic_count, 2u);
    arranged.clear();
    slots.arrange(arranged);
    lists.update(arranged);
    EXPECT_TRUE(lists.dynamic_indices().empty());
}

// Two lights in a row move on by more than half of what is between them: the first ends nearest to where the second
// was.
TEST(DynamicLights, TheNearestPairIsMatchedFirst)
{
    const auto light_at = [](float x) {
        Emitter e {};
        e.type = shared::EMITTER_SPHERE;
        e.p0 = { x, 0, 0 };
        e.radiance = glm::vec3(1);
        return e;
    };
    for (const bool reversed : { false, true }) {
        DynamicLights slots;
        std::vector<Emitter> lights { light_at(0), light_at(30) };
        slots.arrange(lights);
        // 50 is 20 from slot 1 and 50 from slot 0; 35 is 5 from slot 1 and 35 from slot 0.
        lights = { light_at(50), light_at(35) };
        if (reversed)
            std::ranges::reverse(lights);
        const std::vector<uint32_t> found = slots.arrange(lights);
        EXPECT_EQ(found, reversed ? (std::vector<uint32_t> { 1, 0 }) : (std::vector<uint32_t> { 0, 1 }));
    }
}

// What moves as one and has thousands of lights that are alike: their order tells them apart, and no time grows with
// the square of their number.
TEST(DynamicLights, ThousandsThatAreAlikeKeepTheirSlots)
{
    std::vector<Emitter> lights(8000);
    for (size_t i = 0; i < lights.size(); i++) {
        lights[i].p0 = { float(i % 20), float(i / 20 % 20), float(i / 400) };
        lights[i].area = 1;
        lights[i].radiance = glm::vec3(1);
    }
    DynamicLights slots;
    const std::clock_t start = std::clock(); // of the processor
    for (int frame = 0; frame < 5; frame++) {
        std::vector<Emitter> arranged = lights;
        const std::vector<uint32_t> found = slots.arrange(arranged);
        for (size_t i = 0; i < found.size(); i++)
            ASSERT_EQ(found[i], i) << "frame " << frame;
        EXPECT_EQ(std::ranges::count(slots.lived_before(), true), frame == 0 ? 0 : 8000);
        for (Emitter& light : lights)
            light.p0 += glm::vec3(0.25f);
    }
    EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 1);
}

// Too many to compare each with each, and told of in another order every frame: their places tell them apart.
TEST(DynamicLights, ThousandsThatStandStillKeepTheirSlotsInAnyOrder)
{
    std::vector<Emitter> lights(2000);
    for (size_t i = 0; i < lights.size(); i++) {
        lights[i].p0 = { float(i % 20), float(i / 20), 0 };
        lights[i].area = 1;
        lights[i].radiance = glm::vec3(1);
    }
    DynamicLights slots;
    std::vector<Emitter> first = lights;
    slots.arrange(first);
    std::mt19937 rng(5);
    for (int frame = 0; frame < 3; frame++) {
        std::ranges::shuffle(lights, rng);
        std::vector<Emitter> arranged = lights;
        slots.arrange(arranged);
        ASSERT_EQ(arranged.size(), first.size());
        for (size_t i = 0; i < first.size(); i++)
            ASSERT_EQ(arranged[i].p0, first[i].p0) << "frame " << frame;
    }
}

// 100,000 static emitters, 32 dlights and 128 entities of 20 emitters each: nothing is cut.
TEST(LightLists, HaveNoLimit)
{
    const formats::Bsp bsp = make_cell_map(map_size, std::vector<bool>(map_size * map_size, true));
    std::vector<Emitter> fixed(100000), dynamic(32 + 128 * 20);
    std::mt19937 rng(1);
    for (std::vector<Emitter>* emitters : { &fixed, &dynamic })
        for (Emitter& e : *emitters) {
            e.type = shared::EMITTER_SPHERE;
            e.p0 = cell_size * glm::vec3(float(rng() % map_size) + 0.5f, float(rng() % map_size) + 0.5f, 0.5f);
            e.p1.x = 2;
            e.radiance = glm::vec3(1);
        }
    LightLists lists;
    lists.build(bsp, fixed);
    lists.update(dynamic);
    for (const shared::LightList& list : lists.lists()) {
        ASSERT_EQ(list.static_count, fixed.size());
        ASSERT_EQ(list.dynamic_count, dynamic.size());
    }
}

} // namespace
} // namespace vkpt::test

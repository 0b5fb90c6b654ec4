// SPDX-License-Identifier: GPL-2.0-or-later
#include "glsl_libraries.hpp"
#include "lamp_hall.hpp"
#include "map_emitters.hpp"
#include "ref_vkpt/lights/light_multisets.hpp"
#include "sampler_case.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace vkpt::test {
namespace {

using shared::Emitter;

class Hall : public LampHall, public testing::Test {
protected:
    explicit Hall(size_t lamp_count = 120)
        : LampHall(lamp_count)
        , multisets(make_light_multisets(bsp, MapFaces(bsp).triangles, lists, lamps))
    {
    }

    glsl::LightTables tables() const
    {
        glsl::LightTables tables {};
        tables.lists.v = lists.lists().data();
        tables.multisets.v = multisets.ranges.data();
        tables.static_indices.v = multisets.entries.data();
        tables.dynamic_indices.v = lists.dynamic_indices().data();
        tables.list_count = uint32_t(lists.lists().size());
        return tables;
    }

    // How often each light of a cluster is in its multiset.
    std::map<uint32_t, size_t> count_copies(size_t cluster) const
    {
        std::map<uint32_t, size_t> copies;
        const shared::LightMultiset range = multisets.ranges[cluster];
        for (uint32_t i = 0; i < range.count; i++)
            copies[multisets.entries[range.first + i] & ((1u << shared::LIGHT_COPIES_SHIFT) - 1)]++;
        return copies;
    }

    LightMultisets multisets;
};

class HallOfManyLamps : public Hall {
protected:
    HallOfManyLamps()
        : Hall(3000)
    {
    }
};

TEST_F(Hall, EveryLightIsThereAndSharesAddUp)
{
    const glsl::LightTables tables = this->tables();
    for (int cluster = -1; cluster < int(tables.list_count) - 1; cluster++) {
        const glsl::LightListView list = glsl::open_light_list(tables, cluster), multiset = glsl::open_multiset(list);
        std::map<uint32_t, float> shares;
        uint32_t last = 0;
        for (uint32_t i = 0; i < glsl::light_count(multiset); i++) {
            const glsl::LightEntry entry = glsl::light_entry_at(multiset, i);
            ASSERT_GE(entry.emitter, last);
            last = entry.emitter;
            shares[entry.emitter] += entry.share;
        }
        ASSERT_EQ(shares.size(), glsl::light_count(list));
        for (uint32_t i = 0; i < glsl::light_count(list); i++)
            ASSERT_EQ(shares[glsl::light_at(list, i)], 1.0f) << "cluster " << cluster;
    }
}

TEST_F(Hall, WhatMattersMoreIsThereMoreOften)
{
    const glm::vec3 here(0.5f * cell_size, 0.5f * cell_size, 10);
    const int cluster = cluster_at(here);
    ASSERT_GE(cluster, 0);
    const auto light_here = [&](uint32_t lamp) {
        const glm::vec3 away = lamps[lamp].p0 - here;
        const float distance2 = glm::dot(away, away);
        return lamps[lamp].radiance.x * away.z * away.z / (distance2 * distance2);
    };
    std::map<uint32_t, size_t> copies = count_copies(size_t(cluster));
    std::vector<uint32_t> by_light;
    for (const auto& [lamp, count] : copies)
        by_light.push_back(lamp);
    std::ranges::sort(by_light, {}, light_here);
    const size_t part = by_light.size() / 8;
    size_t least = 0, most = 0;
    for (size_t i = 0; i < part; i++) {
        least += copies[by_light[i]];
        most += copies[by_light[by_light.size() - 1 - i]];
    }
    EXPECT_EQ(least, part);
    EXPECT_GT(most, 8 * part);
}

TEST_F(HallOfManyLamps, LongListsGrowByLittle)
{
    for (size_t cluster = 0; cluster + 1 < lists.lists().size(); cluster++) {
        ASSERT_EQ(lists.lists()[cluster].static_count, lamps.size());
        EXPECT_LT(multisets.ranges[cluster].count, lamps.size() + 1500);
        EXPECT_GT(multisets.ranges[cluster].count, lamps.size());
    }
}

TEST_F(Hall, ShadersFindEveryEntry)
{
    Emitter flash {};
    flash.type = shared::EMITTER_SPHERE;
    flash.p0 = glm::vec3(0.5f * cell_size, 0.5f * cell_size, 30);
    flash.p1.x = 4;
    flash.radiance = glm::vec3(9);
    lists.update(std::vector { flash });
    const glsl::LightTables tables = this->tables();
    const glsl::LightListView list = glsl::open_light_list(tables, cluster_at(flash.p0));
    const glsl::LightListView multiset = glsl::open_multiset(list);
    ASSERT_EQ(list.range.dynamic_count, 1u);
    std::map<uint32_t, std::vector<int>> places;
    for (uint32_t i = 0; i < glsl::light_count(multiset); i++)
        places[glsl::light_at(multiset, i)].push_back(int(i));
    for (const auto& [emitter, expected] : places)
        for (size_t i = 0; i < expected.size(); i++)
            ASSERT_EQ(
                glsl::find_light_entry(multiset, emitter, (float(i) + 0.5f) / float(expected.size())), expected[i]);
    EXPECT_EQ(places.count(uint32_t(lamps.size())), 1u) << "the flash";
    EXPECT_EQ(glsl::find_light_entry(multiset, uint32_t(lamps.size()) + 1, 0.5f), -1);
    // A repeated sample's list held fewer.
    glsl::LightListView repeated = list;
    repeated.counted -= 1;
    EXPECT_EQ(glsl::open_multiset(repeated).counted, glsl::light_count(multiset) - 1);
}

// What it is all for: less error than with each light once, on average over the points of the floor.
TEST_F(Hall, ErrorIsLowerThanWithEachLightOnce)
{
    const Sampler once = find_sampler("subset_dynamic"), likely = find_sampler("subset_pps");
    constexpr int points = 40, draws = 200, quadrature = 8;
    double error_once = 0, error_likely = 0;
    for (int point = 0; point < points; point++) {
        ListCase scene;
        scene.point.position = point_on_floor();
        const int cluster = cluster_at(scene.point.position);
        ASSERT_GE(cluster, 0);
        scene.emitters = lamps;
        scene.static_indices = multisets.entries;
        scene.range = lists.lists()[size_t(cluster)];
        scene.tables.multisets = { multisets.ranges[size_t(cluster)] };
        const double truth = once.integrate(scene, quadrature);
        for (int i = 0; i < draws; i++) {
            const Draw draw = make_draw(rng);
            error_once += std::pow(once.sample_lights(scene, draw, {}) / truth - 1, 2);
            error_likely += std::pow(likely.sample_lights(scene, draw, {}) / truth - 1, 2);
        }
    }
    EXPECT_LT(error_likely, 0.4 * error_once);
    RecordProperty("ratio", std::to_string(error_likely / error_once));
}

TEST(LightMultisets, MapsWithoutClustersOrLightsHaveThem)
{
    formats::Bsp bsp;
    bsp.leaves.push_back({});
    bsp.models.push_back({});
    bsp.models[0].head_node = -1;
    LightLists lists;
    lists.build(bsp, {});
    const LightMultisets none = make_light_multisets(bsp, {}, lists, {});
    ASSERT_EQ(none.ranges.size(), 1u);
    EXPECT_EQ(none.ranges[0].count, 0u);

    std::vector<Emitter> lamps(2);
    for (Emitter& lamp : lamps)
        lamp.radiance = glm::vec3(1);
    lists.build(bsp, lamps);
    EXPECT_EQ(make_light_multisets(bsp, {}, lists, lamps).ranges[0].count, 2u);
}

} // namespace
} // namespace vkpt::test

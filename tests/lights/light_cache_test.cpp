// SPDX-License-Identifier: GPL-2.0-or-later
// The light cache's cells: every point of a face has one, their number is bounded whatever the map, and those that
// stand out are aimed at.
#include "ref_vkpt/lights/guides.hpp"
#include "ref_vkpt/lights/light_cache.hpp"
#include "tests/lights/synthetic_bsp.hpp"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <set>

namespace vkpt::test {
namespace {

using shared::CACHE_SIZE_BITS;

struct Map {
    explicit Map(formats::Bsp bsp_, std::vector<shared::Emitter> emitters_ = {})
        : bsp(std::move(bsp_))
        , emitters(std::move(emitters_))
    {
        for (size_t face = 0; face < bsp.faces.size(); face++)
            bsp.leaf_faces.push_back(uint32_t(face));
        for (formats::BspLeaf& leaf : bsp.leaves)
            leaf.leaf_face_count = leaf.cluster >= 0 ? uint32_t(bsp.faces.size()) : uint32_t(0);
        lists.build(bsp, emitters);
    }
    LightCacheLayout lay_out() const { return lay_out_light_cache(bsp, lists, emitters); }

    formats::Bsp bsp;
    std::vector<shared::Emitter> emitters;
    LightLists lists;
};

formats::Bsp one_room() { return make_cell_map(1, { true }); }

shared::Emitter lamp(uint32_t style)
{
    shared::Emitter emitter {};
    emitter.type = shared::EMITTER_SPHERE;
    emitter.p0 = glm::vec3(cell_size / 2);
    emitter.p1 = glm::vec3(4, 0, 0);
    emitter.radiance = glm::vec3(1);
    emitter.lightstyle = style;
    return emitter;
}

glm::uvec2 cells_of(const shared::CacheFace& face)
{
    constexpr uint32_t mask = (1u << CACHE_SIZE_BITS) - 1;
    return { face.size & mask, face.size >> CACHE_SIZE_BITS & mask };
}

uint32_t layers_of(const shared::CacheFace& face) { return face.size >> (2 * CACHE_SIZE_BITS); }

// As the shaders pack it.
shared::CacheValue lit(float light)
{
    const uint64_t bits = std::bit_cast<uint32_t>(light) >> 10, all = bits | bits << 21 | bits << 42;
    return { { uint32_t(all), uint32_t(all >> 32) }, 0, shared::CACHE_MIN_SAMPLES };
}

// The value that readers look up for a point, as in lib/light_cache.glsl.
uint32_t value_at(const shared::CacheFace& face, glm::vec3 p)
{
    const glm::vec2 place(
        glm::dot(p, glm::vec3(face.across)) + face.across.w, glm::dot(p, glm::vec3(face.down)) + face.down.w);
    const glm::uvec2 cells = cells_of(face), cell = glm::min(glm::uvec2(glm::max(place, glm::vec2(0))), cells - 1u);
    return face.first_value + (cell.y * cells.x + cell.x) * layers_of(face);
}

TEST(LightCache, EveryPointOfAFaceHasACellThatIsUpdated)
{
    formats::Bsp bsp = one_room();
    const glm::vec3 corners[] = { { 0, 0, 50 }, { 100, 7, 50 }, { 90, 80, 50 }, { 30, 61, 50 } };
    const size_t face = add_face(bsp, { corners, corners + 4 }, { 0, 0, 1 }, 0);
    bsp.models[0].face_count = int32_t(bsp.faces.size());
    const LightCacheLayout layout = Map(bsp).lay_out();
    ASSERT_EQ(layout.faces.size(), bsp.faces.size());
    EXPECT_EQ(layout.cell_size, finest_cache_cell);
    std::set<uint32_t> updated;
    for (const shared::CacheCell& cell : layout.cells)
        if (cell.face == face)
            updated.insert(cell.first_value);
    const shared::CacheFace& cells = layout.faces[face];
    EXPECT_LT(updated.size(), size_t(cells_of(cells).x) * cells_of(cells).y)
        << "cells that the face leaves empty are updated";
    std::set<uint32_t> met;
    std::mt19937 rng(1);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 20000; i++) {
        float weights[4], sum = 0;
        for (float& weight : weights)
            sum += weight = -std::log(1 - unit(rng));
        glm::vec3 p(0);
        for (int k = 0; k < 4; k++)
            p += corners[k] * (weights[k] / sum);
        const uint32_t value = value_at(cells, p);
        ASSERT_TRUE(updated.contains(value)) << p.x << " " << p.y;
        met.insert(value);
    }
    EXPECT_GT(met.size(), updated.size() * 3 / 4);
}

// The axes and the first corner that updates take points from are those that readers look up.
TEST(LightCache, UpdatesAndReadersMeanTheSameCells)
{
    formats::Bsp bsp = one_room();
    const LightCacheLayout layout = Map(bsp).lay_out();
    ASSERT_FALSE(layout.cells.empty());
    for (const shared::CacheCell& cell : layout.cells) {
        const shared::CacheFace& face = layout.faces[cell.face];
        const shared::CacheFacePlane& plane = layout.planes[cell.face];
        const uint32_t number = (cell.first_value - face.first_value) / layers_of(face);
        const glm::vec2 place = glm::vec2(number % cells_of(face).x, number / cells_of(face).x)
            + glm::vec2(cell.centre & 0xffff, cell.centre >> 16) / 65535.0f;
        EXPECT_EQ(value_at(face, plane.origin + plane.across * place.x + plane.down * place.y), cell.first_value);
    }
}

TEST(LightCache, HasALayerForEachLightstyle)
{
    std::vector<shared::Emitter> emitters = { lamp(0), lamp(7), lamp(33) };
    const LightCacheLayout few = Map(one_room(), emitters).lay_out();
    ASSERT_GT(few.faces[0].size, 0u);
    EXPECT_EQ(layers_of(few.faces[0]), 3u);
    EXPECT_EQ(few.faces[0].styles[0], 0u | 7u << 16);
    EXPECT_EQ(few.faces[0].styles[1], 33u | shared::CACHE_NO_STYLE << 16);
    for (uint32_t style = 1; style < 6; style++)
        emitters.push_back(lamp(style));
    EXPECT_EQ(Map(one_room(), emitters).lay_out().faces[0].size, 0u) << "more styles than there are layers for";
}

TEST(LightCache, IsBoundedWhateverTheMap)
{
    formats::Bsp bsp = one_room();
    constexpr float huge = 1e6f, nan = std::numeric_limits<float>::quiet_NaN();
    const size_t large
        = add_face(bsp, { { 0, 0, 0 }, { huge, 0, 0 }, { huge, huge, 0 }, { 0, huge, 0 } }, { 0, 0, 1 }, 0);
    const size_t broken = add_face(bsp, { { 0, 0, 0 }, { nan, 0, 0 }, { 5, 5, 0 } }, { 0, 0, 1 }, 0);
    const size_t thin = add_face(bsp, { { 0, 0, 0 }, { 50, 0, 0 }, { 25, 0, 0 } }, { 0, 0, 1 }, 0);
    const size_t point = add_face(bsp, { { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } }, { 0, 0, 1 }, 0);
    bsp.models[0].face_count = int32_t(bsp.faces.size());
    const LightCacheLayout layout = Map(bsp).lay_out();
    EXPECT_LE(layout.cells.size(), max_cache_cells);
    EXPECT_GT(layout.faces[large].size, 0u);
    EXPECT_EQ(layout.faces[broken].size, 0u);
    EXPECT_EQ(layout.faces[point].size, 0u);
    EXPECT_EQ(layout.faces[thin].size, 0u);
}

// A map with one bright cell: its block is what the cluster aims at, above all the cell.
TEST(LightCacheGuides, AreTheCellsThatStandOut)
{
    const Map map(one_room(), { lamp(0) });
    const LightCacheLayout layout = map.lay_out();
    std::vector<shared::CacheValue> values(layout.value_count, lit(1));
    const shared::CacheCell bright = layout.cells[layout.cells.size() / 2];
    values[bright.first_value] = lit(255);
    const std::vector<float> styles(300, 1.0f);
    const std::vector<glm::vec3> colours(map.bsp.texinfos.size(), glm::vec3(0.5f));
    const LightCacheGuides guides = choose_guides({ map.bsp, layout, map.lists, styles, colours }, values);
    ASSERT_EQ(guides.lists.size(), map.lists.cluster_count());
    ASSERT_EQ(guides.blocks.size(), 1u);
    ASSERT_EQ(guides.guides.size(), 1u);
    EXPECT_EQ(guides.lists[0].count, 1u);
    EXPECT_EQ(guides.entries[guides.lists[0].first], 1u);
    const shared::CacheGuideBlock& block = guides.blocks[0];
    const shared::CacheFace& face = layout.faces[bright.face];
    uint32_t total = 0;
    std::set<uint32_t> in_block;
    for (uint32_t y = 0; y < shared::CACHE_GUIDE_SIDE; y++)
        for (uint32_t x = 0; x < shared::CACHE_GUIDE_SIDE; x++) {
            const glm::vec3 middle = block.corner + block.across * (float(x) + 0.5f) + block.down * (float(y) + 0.5f);
            const uint32_t share = block.shares[y] >> (8 * x) & 0xff, value = value_at(face, middle);
            EXPECT_EQ(share, value == bright.first_value ? 255u : 1u);
            in_block.insert(value);
            total += share;
        }
    EXPECT_EQ(block.total, total);
    EXPECT_EQ(in_block.size(), size_t(shared::CACHE_GUIDE_SIDE) * shared::CACHE_GUIDE_SIDE);
    for (const shared::CacheCell& cell : layout.cells)
        EXPECT_EQ(
            values[cell.first_value].last >> shared::CACHE_GUIDE_SHIFT, in_block.contains(cell.first_value) ? 1u : 0u);
    // What it sends comes from near the bright cell.
    EXPECT_EQ(value_at(face, guides.guides[0].centre), bright.first_value);
}

TEST(LightCacheGuides, AreNoneWhereAllIsAlike)
{
    const Map map(one_room(), { lamp(0) });
    const LightCacheLayout layout = map.lay_out();
    std::vector<shared::CacheValue> values(layout.value_count, lit(1));
    values[0] = lit(std::numeric_limits<float>::quiet_NaN());
    const std::vector<float> styles(300, 1.0f);
    const std::vector<glm::vec3> colours(map.bsp.texinfos.size(), glm::vec3(0.5f));
    EXPECT_TRUE(choose_guides({ map.bsp, layout, map.lists, styles, colours }, values).guides.empty());
}

} // namespace
} // namespace vkpt::test

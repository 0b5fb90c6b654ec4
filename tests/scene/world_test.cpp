// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/world.hpp"
#include "tests/lights/synthetic_bsp.hpp"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

namespace vkpt::test {
namespace {

FaceTexture make_panel(const std::string&)
{
    FaceTexture texture;
    texture.slot = 7;
    texture.parts = { { { 0.25f, 0.25f }, { 0.5f, 0.5f }, { 0.8f, 0.4f, 0.2f } } };
    return texture;
}

TEST(WorldFaces, TrianglesAreTheirEmitters)
{
    formats::Bsp bsp = make_cell_map(3, std::vector<bool>(9, true));
    const auto world = load_world(write_bsp(bsp), "maps/cells.bsp", make_panel, {});
    const MapGeometry& geometry = world->models[0];
    std::vector<int> counts(geometry.emitters.size(), 0);
    size_t apart = 0;
    for (const shared::Triangle& triangle : geometry.triangles) {
        apart += triangle.emitter == shared::EMITTER_SAMPLED_APART;
        if (triangle.emitter < 0)
            continue;
        ASSERT_LT(size_t(triangle.emitter), geometry.emitters.size());
        counts[size_t(triangle.emitter)]++;
        const shared::Emitter& emitter = geometry.emitters[size_t(triangle.emitter)];
        EXPECT_EQ(emitter.p0, triangle.positions[0]);
        EXPECT_EQ(emitter.p1, triangle.positions[1]);
        EXPECT_EQ(emitter.p2, triangle.positions[2]);
    }
    EXPECT_GT(counts.size(), 8u);
    EXPECT_TRUE(std::ranges::all_of(counts, [](int count) { return count == 1; }));
    EXPECT_GT(apart, 8u) << "what is dark of a lamp";
}

template <class T> bool same_bytes(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

// All that is made of a map is the same, whichever format it lies in.
TEST(WorldOfQbsp, IsThatOfTheSameMapAsIbsp)
{
    formats::Bsp bsp = make_cell_map(6, make_random_cells(6, 0.7, 5));
    const auto narrow = load_world(write_bsp(bsp), "maps/cells.bsp", make_panel, {});
    bsp.format = formats::BspFormat::qbsp;
    const auto wide = load_world(write_bsp(bsp), "maps/cells.bsp", make_panel, {});
    ASSERT_EQ(wide->bsp.format, formats::BspFormat::qbsp);
    const LightLists &a = narrow->light_lists, &b = wide->light_lists;
    EXPECT_GT(a.cluster_count(), 10u);
    EXPECT_GT(a.static_indices().size(), 100u);
    EXPECT_EQ(a.cluster_count(), b.cluster_count());
    EXPECT_TRUE(same_bytes(a.lists(), b.lists()));
    EXPECT_EQ(a.static_indices(), b.static_indices());
    for (size_t cluster = 0; cluster < a.cluster_count(); cluster++) {
        EXPECT_EQ(a.visible_from(cluster).bytes(), b.visible_from(cluster).bytes());
        EXPECT_EQ(a.cluster_bounds(cluster).mins, b.cluster_bounds(cluster).mins);
        EXPECT_EQ(a.cluster_bounds(cluster).maxs, b.cluster_bounds(cluster).maxs);
    }
    EXPECT_TRUE(same_bytes(narrow->models[0].triangles, wide->models[0].triangles));
    EXPECT_TRUE(same_bytes(narrow->models[0].emitters, wide->models[0].emitters));
    EXPECT_EQ(narrow->trees().bvh.nodes, wide->trees().bvh.nodes);
    EXPECT_EQ(narrow->trees().bvh.triangles, wide->trees().bvh.triangles);
}

// A texture may be on faces that nobody sees, too, and those may come first.
TEST(WorldTextures, AreFoundForWhateverIsDrawnOfTheirName)
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    bsp.texinfos[0].flags |= formats::SURF_NODRAW;
    bsp.texinfos[1].texture = bsp.texinfos[2].texture = bsp.texinfos[0].texture;
    int asked = 0;
    const auto find = [&](const std::string& name) {
        asked++;
        return make_panel(name);
    };
    const auto world = load_world(write_bsp(bsp), "maps/cells.bsp", find, {});
    EXPECT_EQ(asked, 1);
    EXPECT_EQ(world->textures[1].slot, 7u);
    EXPECT_EQ(world->textures[2].slot, 7u);
    EXPECT_EQ(world->textures[0].slot, 0u) << "not drawn";
    EXPECT_EQ(world->textures[3].slot, 0u) << "a sky";
}

TEST(WorldLiquids, AreWhatTheirMaterialsSay)
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    bsp.texinfos[0].flags |= formats::SURF_WARP;
    const auto find = [&](const std::string&) {
        FaceTexture texture;
        texture.medium = shared::MEDIUM_LAVA;
        return texture;
    };
    const auto world = load_world(write_bsp(bsp), "maps/cells.bsp", find, {});
    EXPECT_EQ(world->media[0], shared::MEDIUM_LAVA);
    EXPECT_EQ(world->media[1], shared::MEDIUM_NONE);
    EXPECT_TRUE(world->bsp.texinfos[0].flags & formats::SURF_LIGHT);
    for (const shared::Triangle& triangle : world->models[0].triangles)
        EXPECT_EQ(
            triangle.medium & shared::MEDIUM_MASK, triangle.material == 0 ? shared::MEDIUM_LAVA : shared::MEDIUM_NONE);
}

} // namespace
} // namespace vkpt::test

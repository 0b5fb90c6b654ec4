// SPDX-License-Identifier: GPL-2.0-or-later
// Contents, visibility, areas and brush models of compiled maps.
#include "formats/entities.hpp"
#include "tests/map_compiler/map_text.hpp"
#include "tests/map_compiler/tracer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

namespace vkpt::tests {

using namespace formats;

namespace {

class Structure : public testing::Test {
protected:
    static void SetUpTestSuite() { bsp_ = new Bsp(compile(two_rooms::text())); }
    static void TearDownTestSuite() { delete bsp_; }
    static inline Bsp* bsp_ = nullptr;

    static uint32_t contents_at(glm::vec3 p) { return bsp_->leaves[bsp_->find_leaf(p)].contents; }
};

TEST_F(Structure, ContentsAtKnownPoints)
{
    EXPECT_EQ(contents_at({ 0, 0, 50 }), 0u);
    EXPECT_EQ(contents_at({ 270, 0, 50 }), 0u) << "the door is a model, not part of the world";
    EXPECT_EQ(contents_at({ -150, -150, -50 }) & CONTENTS_WATER, uint32_t(CONTENTS_WATER));
    EXPECT_EQ(contents_at({ -150, -150, two_rooms::water_level + 2 }), 0u);
    EXPECT_TRUE(contents_at({ 270, 100, 50 }) & CONTENTS_SOLID) << "the wall beside the door";
    EXPECT_TRUE(contents_at({ -80, 120, 30 }) & CONTENTS_SOLID) << "a detail brush";
    EXPECT_EQ(contents_at({ -225, 225, 150 }) & (CONTENTS_SOLID | CONTENTS_PLAYERCLIP), uint32_t(CONTENTS_PLAYERCLIP));
    EXPECT_EQ(contents_at({ 0, 544, 30 }) & (CONTENTS_SOLID | CONTENTS_WINDOW), uint32_t(CONTENTS_WINDOW));
    EXPECT_TRUE(contents_at({ 0, 0, -30 }) & CONTENTS_SOLID);
    EXPECT_TRUE(contents_at({ 0, 0, 2000 }) & CONTENTS_SOLID) << "outside is filled";
    EXPECT_EQ(bsp_->leaves[0].contents, uint32_t(CONTENTS_SOLID)) << "the engine insists";
}

TEST_F(Structure, VisibilityIsSymmetricAndReflexive)
{
    ASSERT_GT(bsp_->cluster_count, 4);
    for (int a = 0; a < bsp_->cluster_count; a++) {
        const ClusterSet row = bsp_->pvs(a);
        EXPECT_TRUE(row.contains(a));
        for (int b = 0; b < bsp_->cluster_count; b++)
            EXPECT_EQ(row.contains(b), bsp_->pvs(b).contains(a)) << a << " " << b;
    }
}

TEST_F(Structure, RoomBehindTheBendIsHidden)
{
    const ClusterSet from_a = bsp_->pvs(bsp_->find_cluster({ 0, 0, 50 }));
    EXPECT_TRUE(from_a.contains(bsp_->find_cluster({ 500, 0, 50 }))) << "B, through the doorway";
    for (int x = -240; x <= 240; x += 32)
        for (int y = 336; y < 590; y += 32)
            EXPECT_FALSE(from_a.contains(bsp_->find_cluster({ x, y, 90 }))) << x << " " << y;
}

// Whatever a free line joins must be in the visible set: the flow may not cut too much.
TEST_F(Structure, FreeLinesOfSightAreVisible)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> x(-250, 790), y(-250, 590), z(-90, 190);
    const TraceBox point { glm::vec3(0), glm::vec3(0) };
    int checked = 0;
    while (checked < 3000) {
        const glm::vec3 a(x(random), y(random), z(random)), b(x(random), y(random), z(random));
        const int from = bsp_->find_cluster(a), to = bsp_->find_cluster(b);
        if (from < 0 || to < 0 || trace_box(*bsp_, point, a, b, CONTENTS_SOLID).fraction < 1)
            continue;
        checked++;
        EXPECT_TRUE(bsp_->pvs(from).contains(to)) << from << " " << to;
    }
}

TEST_F(Structure, BrushModelsAreNamedAndPlaced)
{
    ASSERT_EQ(bsp_->models.size(), 4u);
    int found = 0;
    for (const EntityText& entity : parse_entities(bsp_->entity_text, "entities")) {
        if (entity.class_name() == "func_door") {
            found++;
            EXPECT_EQ(entity.get("model"), "*1");
        }
        if (entity.class_name() == "func_rotating") {
            found++;
            EXPECT_EQ(entity.get("model"), "*2");
            EXPECT_EQ(entity.vector("origin"), glm::vec3(640, -90, 50)) << "the origin brush's middle";
        }
    }
    EXPECT_EQ(found, 2);
    EXPECT_EQ(bsp_->models[1].mins, glm::vec3(264, -48, 0));
    EXPECT_EQ(bsp_->models[1].maxs, glm::vec3(280, 48, 112));
    EXPECT_EQ(bsp_->models[1].face_count, 6);
    EXPECT_EQ(bsp_->models[2].mins, glm::vec3(-40, -10, -10)) << "about its own origin";
    EXPECT_EQ(bsp_->models[3].face_count, 0) << "a trigger is not drawn";
}

TEST(Areas, PortalSeparatesTwo)
{
    const std::string world = walls_around({ two_rooms::room_a, two_rooms::room_b, two_rooms::doorway }, "wall");
    const Bsp bsp = compile(entity_text({ { "classname", "worldspawn" } }, world)
        + entity_text({ { "classname", "info_player_start" }, { "origin", "0 0 24" } })
        + entity_text({ { "classname", "func_areaportal" }, { "targetname", "p" } },
            box_brush({ { 268, -48, 0 }, { 276, 48, 112 } }, "trigger")));
    const int a = bsp.leaves[bsp.find_leaf({ 0, 0, 50 })].area, b = bsp.leaves[bsp.find_leaf({ 500, 0, 50 })].area;
    EXPECT_NE(a, b);
    ASSERT_EQ(bsp.areas.size(), 3u);
    for (const int area : { a, b }) {
        ASSERT_EQ(bsp.areas[size_t(area)].area_portal_count, 1);
        const BspAreaPortal& portal = bsp.area_portals[size_t(bsp.areas[size_t(area)].first_area_portal)];
        EXPECT_EQ(portal.portal, 1);
        EXPECT_EQ(portal.other_area, a + b - area);
    }
    EXPECT_EQ(bsp.models.size(), 1u) << "the portal's brush is the world's";
    for (const EntityText& entity : parse_entities(bsp.entity_text, "entities"))
        if (entity.class_name() == "func_areaportal") {
            EXPECT_EQ(entity.get("style"), "1");
        }
}

TEST(Areas, OneWithoutPortals)
{
    const Bsp bsp = compile(entity_text({ { "classname", "worldspawn" } }, walls_around({ two_rooms::room_a }, "wall"))
        + entity_text({ { "classname", "info_player_start" }, { "origin", "0 0 24" } }));
    EXPECT_EQ(bsp.areas.size(), 2u);
    for (const BspLeaf& leaf : bsp.leaves)
        EXPECT_EQ(leaf.area, leaf.contents & CONTENTS_SOLID ? 0 : 1);
}

// Overlapping brushes in any number are one solid.
TEST(Overlap, CornersAreSealedAndInsideNoFaceRemains)
{
    const std::string world = walls_around({ two_rooms::room_a }, "wall")
        + box_brush({ { -50, -50, -20 }, { 50, 50, 100 } }, "one")
        + box_brush({ { -20, -80, -10 }, { 80, 20, 60 } }, "two")
        + box_brush({ { -30, -30, 10 }, { 30, 0, 50 } }, "hidden");
    const Bsp bsp = compile(entity_text({ { "classname", "worldspawn" } }, world)
        + entity_text({ { "classname", "info_player_start" }, { "origin", "200 200 24" } }));
    for (const BspFace& face : bsp.faces)
        EXPECT_NE(bsp.texinfos[face.texinfo].texture, "hidden");
}

// Nothing can show inside a structural wall: what stands in it divides it no further.
TEST(Overlap, WhatAWallHidesMakesNoNodes)
{
    const auto map = [](const std::string& hidden) {
        const std::string pillar = box_brush({ { -60, -60, 0 }, { 60, 60, 192 } }, "pillar");
        return compile(entity_text({ { "classname", "worldspawn" } },
                           walls_around({ two_rooms::room_a }, "wall") + pillar + hidden)
            + entity_text({ { "classname", "info_player_start" }, { "origin", "200 200 24" } }));
    };
    const Bsp bare = map(""), with_hidden = map(box_brush({ { -13, -17, 40 }, { 11, 19, 90 } }, "hidden"));
    EXPECT_EQ(with_hidden.nodes.size(), bare.nodes.size());
    EXPECT_EQ(with_hidden.leaves.size(), bare.leaves.size());
}

// A room full of turned, overlapping pillars: closed, solid exactly where a brush is, and nothing visible is lost.
class RandomBrushes : public testing::TestWithParam<int> { };

struct Pillar {
    std::vector<glm::ivec2> base;
    int top;

    // Signed distance to the nearest side, < 0 inside.
    double outside(glm::vec3 p) const
    {
        double most = p.z - double(top);
        for (size_t i = 0; i < base.size(); i++) {
            const glm::dvec2 a(base[i]), b(base[(i + 1) % base.size()]), edge = glm::normalize(b - a);
            most = std::max(most, edge.y * (p.x - a.x) - edge.x * (p.y - a.y));
        }
        return most;
    }
};

std::vector<Pillar> random_pillars(std::mt19937& random)
{
    std::vector<Pillar> pillars;
    std::uniform_int_distribution<int> place(-220, 220), size(20, 70), height(20, 230), turn(0, 359), corners(3, 6);
    for (int i = 0; i < 14; i++) {
        Pillar pillar { {}, height(random) };
        const glm::ivec2 centre(place(random), place(random));
        const int count = corners(random), radius = size(random), start = turn(random);
        for (int k = 0; k < count; k++) {
            const double angle = 3.14159265358979 / 180 * (start + 360.0 * k / count);
            pillar.base.push_back(
                centre + glm::ivec2(glm::round(glm::dvec2(std::cos(angle), std::sin(angle)) * double(radius))));
        }
        pillars.push_back(pillar);
    }
    return pillars;
}

Bsp compile_room_with(const std::vector<Pillar>& pillars)
{
    const Box room { { -256, -256, 0 }, { 256, 256, 256 } };
    std::string world = walls_around({ room }, "wall");
    for (const Pillar& pillar : pillars)
        world += prism_brush(pillar.base, -8, pillar.top, "pillar");
    return compile_dark(entity_text({ { "classname", "worldspawn" } }, world)
        + entity_text({ { "classname", "info_player_start" }, { "origin", "0 0 240" } }));
}

TEST_P(RandomBrushes, AreSolidWhereTheyStand)
{
    std::mt19937 random(static_cast<unsigned>(GetParam()));
    const std::vector<Pillar> pillars = random_pillars(random);
    const Bsp bsp = compile_room_with(pillars);
    std::uniform_real_distribution<float> place(-255, 255), height(1, 255);
    const auto outside = [&](glm::vec3 p) {
        double least = 1e9;
        for (const Pillar& pillar : pillars)
            least = std::min(least, pillar.outside(p));
        return least;
    };
    std::vector<glm::vec3> open;
    for (int i = 0; i < 10000; i++) {
        const glm::vec3 p(place(random), place(random), height(random));
        const double distance = outside(p);
        if (std::abs(distance) < 0.3)
            continue;
        const bool solid = bsp.leaves[bsp.find_leaf(p)].contents & CONTENTS_SOLID;
        EXPECT_EQ(solid, distance < 0) << p.x << " " << p.y << " " << p.z;
        if (!solid && open.size() < 80)
            open.push_back(p);
    }
    const TraceBox point { glm::vec3(0), glm::vec3(0) };
    for (const glm::vec3& a : open)
        for (const glm::vec3& b : open)
            if (trace_box(bsp, point, a, b, CONTENTS_SOLID).fraction == 1) {
                EXPECT_TRUE(bsp.pvs(bsp.find_cluster(a)).contains(bsp.find_cluster(b)));
            }
}

TEST_P(RandomBrushes, FloorIsCoveredOnce)
{
    std::mt19937 random(static_cast<unsigned>(GetParam()));
    const std::vector<Pillar> pillars = random_pillars(random);
    const Bsp bsp = compile_room_with(pillars);
    double floor = 0;
    for (size_t face = 0; face < bsp.faces.size(); face++) {
        const auto polygon = bsp.face_polygon(face);
        if (bsp.face_normal(face).z < 0.999f || std::abs(polygon[0].z) > 0.01f)
            continue;
        for (size_t i = 2; i < polygon.size(); i++)
            floor += 0.5 * double(glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]).z);
    }
    int free = 0;
    constexpr int steps = 512;
    for (int x = 0; x < steps; x++)
        for (int y = 0; y < steps; y++) {
            const glm::vec3 p(-256 + 1.0 * (x + 0.5), -256 + 1.0 * (y + 0.5), 0.01);
            free += std::ranges::none_of(pillars, [&](const Pillar& pillar) { return pillar.outside(p) < 0; });
        }
    EXPECT_NEAR(floor, free, 300) << "of " << 512 * 512;
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomBrushes, testing::Range(1, 9));

} // namespace

} // namespace vkpt::tests

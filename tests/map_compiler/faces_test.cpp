// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/map_compiler/map_text.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {

using namespace formats;

namespace {

class Faces : public testing::Test {
protected:
    static void SetUpTestSuite() { bsp_ = new Bsp(compile(two_rooms::text())); }
    static void TearDownTestSuite() { delete bsp_; }
    static inline Bsp* bsp_ = nullptr;

    static glm::vec3 area_vector(size_t face)
    {
        const auto polygon = bsp_->face_polygon(face);
        glm::vec3 sum(0);
        for (size_t i = 2; i < polygon.size(); i++)
            sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
        return sum * 0.5f;
    }
    static glm::vec3 middle(size_t face)
    {
        glm::vec3 sum(0);
        const auto polygon = bsp_->face_polygon(face);
        for (const glm::vec3& p : polygon)
            sum += p;
        return sum / float(polygon.size());
    }
    static const BspTexinfo& texinfo(size_t face) { return bsp_->texinfos[bsp_->faces[face].texinfo]; }
    // Area of the faces that look along `normal` on the plane at `dist`.
    static float area_on(glm::vec3 normal, float dist)
    {
        float area = 0;
        for (size_t face = 0; face < size_t(bsp_->models[0].face_count); face++)
            if (glm::dot(bsp_->face_normal(face), normal) > 0.999f
                && std::abs(glm::dot(middle(face), normal) - dist) < 0.1f)
                area += glm::length(area_vector(face));
        return area;
    }
};

TEST_F(Faces, ArePlanarAndLookOutOfTheirPlane)
{
    ASSERT_GT(bsp_->faces.size(), 50u);
    for (size_t face = 0; face < bsp_->faces.size(); face++) {
        const BspPlane& plane = bsp_->planes[bsp_->faces[face].plane];
        for (const glm::vec3& p : bsp_->face_polygon(face))
            EXPECT_NEAR(glm::dot(p, plane.normal), plane.dist, 0.02f) << face;
        EXPECT_GT(glm::dot(area_vector(face), bsp_->face_normal(face)), 0.5f) << face;
    }
}

// The format's unused edge 0 has a vertex, too: readers, ours and the engine's, look.
TEST(FacesOfNothing, MakeAMapThatCanBeRead)
{
    const std::string brush = box_brush({ { -64, -64, -16 }, { 64, 64, 0 } }, "hint");
    const Bsp bsp = compile(entity_text({ { "classname", "worldspawn" } }, brush));
    EXPECT_TRUE(bsp.faces.empty());
    EXPECT_EQ(bsp.vertices.size(), 1u);
}

TEST_F(Faces, SeparateOpenFromSolidOrLiquid)
{
    for (size_t face = 0; face < size_t(bsp_->models[0].face_count); face++) {
        const glm::vec3 p = middle(face), normal = bsp_->face_normal(face);
        const uint32_t front = bsp_->leaves[bsp_->find_leaf(p + normal)].contents;
        const uint32_t back = bsp_->leaves[bsp_->find_leaf(p - normal)].contents;
        EXPECT_FALSE(front & CONTENTS_SOLID) << face << " " << texinfo(face).texture;
        EXPECT_NE(front & 0x7f, back & 0x7f) << face << " " << texinfo(face).texture;
    }
}

TEST_F(Faces, CoverEverySurfaceOnce)
{
    EXPECT_NEAR(area_on({ 0, 0, -1 }, -192), 512 * 512 * 2 - 2 * 64 * 64 + 512 * 280, 1) << "ceilings less lamps";
    EXPECT_NEAR(area_on({ 0, 0, -1 }, -184), 2 * 64 * 64, 1) << "lamps";
    EXPECT_NEAR(area_on({ 0, 0, 1 }, -96), 160 * 160, 1) << "the pool's floor";
    EXPECT_NEAR(area_on({ -1, 0, 0 }, -800), 512 * 192, 1) << "the far wall of B";
}

TEST_F(Faces, WaterIsSeenFromBothSides)
{
    EXPECT_NEAR(area_on({ 0, 0, 1 }, two_rooms::water_level), 160 * 160, 1);
    EXPECT_NEAR(area_on({ 0, 0, -1 }, -two_rooms::water_level), 160 * 160, 1);
}

TEST_F(Faces, FitTheLightmap)
{
    for (size_t face = 0; face < bsp_->faces.size(); face++) {
        if (texinfo(face).flags & (SURF_WARP | SURF_SKY))
            continue;
        const auto extent = bsp_->lightmap_extent(face);
        EXPECT_GE(extent.size.x, 1);
        EXPECT_LE(std::max(extent.size.x, extent.size.y), 17) << face;
    }
}

TEST_F(Faces, HaveNoTJunctions)
{
    for (size_t face = 0; face < size_t(bsp_->models[0].face_count); face++) {
        const auto polygon = bsp_->face_polygon(face);
        for (size_t i = 0; i < polygon.size(); i++) {
            const glm::vec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
            const float length = glm::distance(a, b);
            const glm::vec3 direction = (b - a) / length;
            for (const glm::vec3& v : bsp_->vertices) {
                const float along = glm::dot(v - a, direction);
                const bool on_world = std::abs(v.x - 272) > 20 && (v.x < 500 || v.z < 0); // other models' corners aside
                if (on_world && along > 0.1f && along < length - 0.1f) {
                    EXPECT_GT(glm::distance(v, a + direction * along), 0.02f) << face;
                }
            }
        }
    }
}

TEST_F(Faces, LieInTheLeavesAndNodesThatShowThem)
{
    std::vector<int> in_leaves(bsp_->faces.size()), in_nodes(bsp_->faces.size());
    for (const uint32_t face : bsp_->leaf_faces)
        in_leaves[face]++;
    for (const BspNode& node : bsp_->nodes)
        for (uint32_t i = 0; i < node.face_count; i++) {
            in_nodes[size_t(node.first_face + i)]++;
            EXPECT_EQ(bsp_->faces[size_t(node.first_face + i)].plane, node.plane);
        }
    for (size_t face = 0; face < bsp_->faces.size(); face++) {
        EXPECT_GE(in_leaves[face], 1) << face;
        EXPECT_EQ(in_nodes[face], 1) << face;
    }
}

TEST(Texinfo, ClassicAndValveAxesAgree)
{
    const std::string room = walls_around({ two_rooms::room_a }, "wall");
    const std::string rest = entity_text({ { "classname", "info_player_start" }, { "origin", "200 200 24" } });
    const auto with_top = [&](const std::string& top) {
        const Box box { { 0, 0, 0 }, { 64, 64, 64 } };
        std::string brush = box_brush(box, "side");
        brush.erase(brush.rfind("( 0 0 64 )"));
        return compile(entity_text({ { "classname", "worldspawn" } },
                           room + brush + "( 0 0 64 ) ( 0 64 64 ) ( 64 0 64 ) " + top + "\n}\n")
            + rest);
    };
    const Bsp classic = with_top("top 8 -12 90 2 0.5 0 1 70"),
              valve = with_top("top [ 0 1 0 8 ] [ 1 0 0 -12 ] 0 2 0.5 0 1 70");
    const auto find = [](const Bsp& bsp) {
        for (const BspTexinfo& info : bsp.texinfos)
            if (info.texture == "top")
                return info;
        return BspTexinfo {};
    };
    const BspTexinfo a = find(classic), b = find(valve);
    EXPECT_EQ(a.texture, "top");
    EXPECT_NEAR(glm::distance(a.s_axis, b.s_axis), 0, 1e-5f);
    EXPECT_NEAR(glm::distance(a.t_axis, b.t_axis), 0, 1e-5f);
    EXPECT_FLOAT_EQ(a.s_offset, 8);
    EXPECT_FLOAT_EQ(b.t_offset, -12);
    EXPECT_NEAR(glm::length(a.s_axis), 0.5f, 1e-5f) << "scale 2: half a texel a unit";
    EXPECT_EQ(a.flags, uint32_t(SURF_LIGHT));
    EXPECT_EQ(a.value, 70);
}

} // namespace

} // namespace vkpt::tests

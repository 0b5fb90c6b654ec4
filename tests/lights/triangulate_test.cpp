// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/emitters.hpp"
#include "synthetic_bsp.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <set>

namespace vkpt::test {
namespace {

using Outline = std::vector<glm::vec3>;

struct Cut {
    std::vector<std::array<uint32_t, 3>> triangles;
    float area = 0;
    float min_normal_cosine_of_light = 1e30f;
    std::set<uint32_t> corners;
};

Cut cut_outline(const Outline& outline, glm::vec3 normal)
{
    formats::Bsp bsp = make_cell_map(1, { true });
    const size_t face = add_face(bsp, outline, normal, 0);
    const Outline polygon = bsp.face_polygon(face);
    Cut cut;
    cut.triangles = triangulate(polygon, bsp.face_normal(face));
    for (const auto& t : cut.triangles) {
        const glm::vec3 across = glm::cross(polygon[t[1]] - polygon[t[0]], polygon[t[2]] - polygon[t[0]]);
        cut.area += 0.5f * glm::length(across);
        cut.min_normal_cosine_of_light = std::min(cut.min_normal_cosine_of_light, glm::dot(across, normal));
        cut.corners.insert(t.begin(), t.end());
    }
    return cut;
}

const Outline square { { 0, 0, 0 }, { 64, 0, 0 }, { 64, 64, 0 }, { 0, 64, 0 } };
const Outline square_with_middles { { 0, 0, 0 }, { 32, 0, 0 }, { 64, 0, 0 }, { 64, 32, 0 }, { 64, 64, 0 },
    { 32, 64, 0 }, { 0, 64, 0 }, { 0, 32, 0 } };

TEST(Triangulate, FacesTheFrontWhicheverWayTheOutlineRuns)
{
    for (const glm::vec3 normal : { glm::vec3(0, 0, 1), glm::vec3(0, 0, -1) }) {
        const Cut cut = cut_outline(square, normal);
        EXPECT_EQ(cut.triangles.size(), 2u);
        EXPECT_FLOAT_EQ(cut.area, 64 * 64);
        EXPECT_GT(cut.min_normal_cosine_of_light, 0);
    }
}

TEST(Triangulate, UsesCornersOnStraightEdges)
{
    for (size_t start = 0; start < square_with_middles.size(); start++) {
        Outline outline = square_with_middles;
        std::rotate(outline.begin(), outline.begin() + ptrdiff_t(start), outline.end());
        const Cut cut = cut_outline(outline, glm::vec3(0, 0, 1));
        EXPECT_EQ(cut.triangles.size(), 6u) << "start " << start;
        EXPECT_EQ(cut.corners.size(), 8u) << "start " << start;
        EXPECT_FLOAT_EQ(cut.area, 64 * 64) << "start " << start;
        EXPECT_GT(cut.min_normal_cosine_of_light, 100) << "start " << start;
    }
}

TEST(Triangulate, LeavesSliversOut)
{
    EXPECT_TRUE(cut_outline({ { 0, 0, 0 }, { 32, 0, 0 }, { 64, 0, 0 } }, glm::vec3(0, 0, 1)).triangles.empty());
    EXPECT_TRUE(cut_outline({ { 5, 5, 5 }, { 5, 5, 5 }, { 5, 5, 5 } }, glm::vec3(0, 0, 1)).triangles.empty());
}

TEST(Triangulate, CutsOutlinesWithManyCorners)
{
    for (const size_t corners : { 12, 40, 41, 200 }) {
        Outline circle;
        double area = 0;
        for (size_t i = 0; i < corners; i++) {
            const double phi = 2 * M_PI * double(i) / double(corners);
            circle.emplace_back(float(256 * std::cos(phi)), float(256 * std::sin(phi)), 0.0f);
            area += 0.5 * 256 * 256 * std::sin(2 * M_PI / double(corners));
        }
        const Cut cut = cut_outline(circle, glm::vec3(0, 0, 1));
        EXPECT_EQ(cut.triangles.size(), corners - 2);
        EXPECT_NEAR(cut.area, area, 1e-3 * area);
    }
}

} // namespace
} // namespace vkpt::test

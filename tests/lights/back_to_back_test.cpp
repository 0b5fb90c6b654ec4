// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/back_to_back.hpp"
#include "ref_vkpt/lights/face_triangles.hpp"
#include "synthetic_bsp.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace vkpt::test {
namespace {

using Outline = std::vector<glm::vec3>;

Outline square_at(glm::vec3 corner, float size = 64)
{
    return { corner, corner + glm::vec3(size, 0, 0), corner + glm::vec3(size, size, 0),
        corner + glm::vec3(0, size, 0) };
}

constexpr glm::vec3 up(0, 0, 1), down(0, 0, -1);

class BackToBack : public testing::Test {
protected:
    size_t add(const Outline& outline, glm::vec3 normal)
    {
        const size_t face = add_face(bsp_, outline, normal, 0);
        bsp_.models[0].face_count = int32_t(bsp_.faces.size());
        return face;
    }

    formats::Bsp bsp_ = make_cell_map(1, { true });
};

TEST_F(BackToBack, SidesOfAShellAreFound)
{
    const size_t floor = add(square_at({ 0, 0, 8 }), up), underside = add(square_at({ 32, 0, 8 }), down);
    const std::vector<bool> found = find_back_to_back(bsp_);
    EXPECT_TRUE(found[floor]);
    EXPECT_TRUE(found[underside]);
    EXPECT_FALSE(found[0]);
}

TEST_F(BackToBack, NeighboursOtherPlanesOtherModelsAndSameSidesAreNot)
{
    add(square_at({ 0, 0, 8 }), up);
    add(square_at({ 64, 0, 8 }), down); // they share an edge
    add(square_at({ 0, 0, 10 }), down);
    add(square_at({ 0, 0, 10 }), down);
    for (const bool found : find_back_to_back(bsp_))
        EXPECT_FALSE(found);
    const size_t cover = add(square_at({ 0, 0, 8 }), down);
    bsp_.models.push_back({});
    bsp_.models[0].face_count--;
    bsp_.models[1].first_face = int32_t(cover);
    bsp_.models[1].face_count = 1;
    for (const bool found : find_back_to_back(bsp_))
        EXPECT_FALSE(found);
}

TEST_F(BackToBack, TrianglesStandApart)
{
    const size_t top = add(square_at({ 0, 0, 8 }), up), bottom = add(square_at({ 0, 0, 8 }), down);
    const size_t alone = add(square_at({ 0, 0, 40 }), up);
    const std::vector<FaceTexture> textures(bsp_.texinfos.size());
    const FaceTriangles triangles(bsp_, textures);
    const auto height = [&](size_t face) { return triangles.of(face)[0].corners[0].z; };
    EXPECT_EQ(height(top), 8 + side_lift);
    EXPECT_EQ(height(bottom), 8 - side_lift);
    EXPECT_EQ(height(alone), 40);
}

// Every face overlaps with half of the others, which would take 10^11 comparisons.
TEST_F(BackToBack, EndsWhateverAMapHolds)
{
    Outline round;
    for (int i = 0; i < 128; i++)
        round.emplace_back(100 * std::cos(float(i) / 128 * 6.2831853f), 100 * std::sin(float(i) / 128 * 6.2831853f), 8);
    for (int i = 0; i < 2000; i++) {
        for (glm::vec3& corner : round)
            corner.x += 0.01f;
        add(round, i % 2 == 0 ? up : down);
    }
    EXPECT_EQ(find_back_to_back(bsp_).size(), bsp_.faces.size());
}

} // namespace
} // namespace vkpt::test

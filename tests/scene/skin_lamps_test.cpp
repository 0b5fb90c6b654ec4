// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/skin_lamps.hpp"

#include "common/colour.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace vkpt {
namespace {

// Triangles of an area that grows with their number, each with texture coordinates around one place.
formats::Md2Model make_model(const std::vector<glm::vec2>& places, float uv_size = 0)
{
    formats::Md2Model model;
    model.skin_width = model.skin_height = 64;
    formats::Md2Model::Frame frame;
    for (size_t i = 0; i < places.size(); i++) {
        const float x = 20 * float(i), size = std::sqrt(float(i + 1));
        for (const glm::vec2 corner : { glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1) }) {
            model.indices.push_back(uint32_t(frame.positions.size()));
            model.texture_coordinates.push_back(places[i] + corner * uv_size);
            frame.positions.push_back({ x + corner.x * size, corner.y * size, 0 });
            frame.normals.push_back({ 0, 0, 1 });
        }
    }
    model.frames.push_back(frame);
    return model;
}

// Black but for a square of white in the middle, a quarter of all.
formats::Image make_picture(int size)
{
    formats::Image image { size, size, std::vector<formats::Rgba8>(size_t(size) * size_t(size)) };
    for (int y = size / 4; y < size * 3 / 4; y++)
        for (int x = size / 4; x < size * 3 / 4; x++)
            image.pixels[size_t(y) * size_t(size) + size_t(x)] = { 255, 255, 255, 255 };
    return image;
}

// The x of a lamp's triangle, in numbers of triangles.
int number_of(const Md2Mesh& mesh, const SkinLamp& lamp)
{
    std::vector<Float4> points;
    mesh.pose({}, points);
    float x = 1e9f;
    for (int i = 0; i < 3; i++)
        x = std::min(x, points[mesh.corners()[size_t(lamp.slot) * 3 + size_t(i)]][0]);
    return int(std::lround(x / 20));
}

TEST(SkinLamps, AreTheTrianglesThatGlowTheLargestFirst)
{
    const Md2Mesh mesh(make_model({ { 0.5f, 0.5f }, { 0.1f, 0.1f }, { 0.4f, 0.6f }, { 0.9f, 0.5f } }));
    const SkinLamps lamps = find_skin_lamps(mesh, *make_glow_map(make_picture(64)));
    ASSERT_EQ(lamps.size(), 2u);
    EXPECT_EQ(number_of(mesh, lamps[0]), 2);
    EXPECT_EQ(number_of(mesh, lamps[1]), 0);
    EXPECT_NEAR(lamps[0].colour.x, 1, 1e-3f);
}

// Texture coordinates beyond the skin repeat it; the triangle over all of it has the skin's mean, also by a map that is
// smaller than the picture.
TEST(SkinLamps, HaveTheMeanOfTheirTexels)
{
    const Md2Mesh mesh(make_model({ { 0, 0 }, { -3, 2 } }, 2));
    for (const int size : { 32, 128, 512 }) {
        const GlowMap map = make_glow_map(make_picture(size));
        EXPECT_LE(map->width, glow_map_size);
        const SkinLamps lamps = find_skin_lamps(mesh, *map);
        ASSERT_EQ(lamps.size(), 2u);
        for (const SkinLamp& lamp : lamps)
            EXPECT_NEAR(luminance(lamp.colour), 0.25f, 0.02f) << size;
    }
}

TEST(SkinLamps, AreNotMoreThanLightListsBear)
{
    const Md2Mesh mesh(make_model(std::vector<glm::vec2>(40, { 0.5f, 0.5f })));
    const SkinLamps lamps = find_skin_lamps(mesh, *make_glow_map(make_picture(64)));
    ASSERT_EQ(lamps.size(), max_skin_lamps);
    EXPECT_EQ(number_of(mesh, lamps.front()), 39);
    EXPECT_EQ(number_of(mesh, lamps.back()), 40 - int(max_skin_lamps));
}

TEST(SkinLamps, AreFoundOnce)
{
    SkinLampCache cache;
    const auto mesh = std::make_shared<const Md2Mesh>(make_model({ { 0.5f, 0.5f } }));
    const GlowMap bright = make_glow_map(make_picture(64)),
                  dark = make_glow_map({ 1, 1, { formats::Rgba8 { 0, 0, 0, 255 } } });
    const auto found = cache.find(mesh, bright);
    ASSERT_TRUE(found);
    EXPECT_EQ(cache.find(mesh, bright), found);
    EXPECT_EQ(cache.find(mesh, dark), nullptr);
    EXPECT_EQ(cache.find(mesh, nullptr), nullptr);
}

} // namespace
} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// Bounce rays that neighbouring pixels share (pt_bounce_pixels): how many there are, and that the picture's light
// stays.
#include "shaders/shared/frame.h"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <string_view>

namespace vkpt::tests {
namespace {

// A floor full of pillars under a lamp that lights the ceiling alone: what is seen is lit by bounces, and most blocks
// of pixels have an edge within.
class BouncePixels : public testing::Test {
protected:
    BouncePixels()
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("lamp", white_index);
        MapBuilder map;
        const uint16_t wall = map.add_material("wall");
        map.add_room({ -128, -128, 0 }, { 128, 128, 128 }, wall);
        map.add(rectangle({ 0, 0, 64 }, { 12, 0, 0 }, { 0, 12, 0 }), map.add_material("lamp", 0, 1000));
        for (int i = 0; i < 64; i++) {
            const glm::vec3 corner(-112 + 28 * (i % 8), -112 + 28 * (i / 8), 0);
            map.add_block(corner, corner + glm::vec3(10, 10, 24), wall);
        }
        folder_.add_map("pillars", map.finish());
    }

    std::unique_ptr<Session> start(const CvarList& cvars, glm::ivec2 size = { 64, 48 })
    {
        auto session = std::make_unique<Session>(folder_, cvars, size);
        session->load_map("pillars");
        session->look({ -120, -120, 60 }, { 10, 10, 0 });
        return session;
    }

    GameFolder folder_;
};

// Mean of the pictures of many frames. The filter over time alone hands all light on, later.
Radiance mean_of_frames(Session& session)
{
    constexpr int pictures = 64, frames_apart = 10;
    session.draw(40);
    Radiance sum = session.capture();
    for (int i = 1; i < pictures; i++) {
        session.draw(frames_apart);
        const Radiance picture = session.capture();
        for (size_t k = 0; k < sum.pixels.size(); k++)
            sum.pixels[k] += picture.pixels[k];
    }
    for (glm::vec3& pixel : sum.pixels)
        pixel /= float(pictures);
    return sum;
}

// A room that is closed has a primary ray and, where all pixels send one, a bounce ray for each pixel; the light cache
// would send its own.
TEST_F(BouncePixels, SendSoManyRays)
{
    const auto session = start({ { "flt_denoiser", "asvgf" }, { "pt_count_rays", "1" }, { "pt_indirect", "trace" } });
    const double pixels = 64 * 48, others = pixels + shared::LIGHT_LEVEL_LANES; // of the camera, and of light_level
    const auto bounce_rays = [&](const char* which) {
        session->set("pt_bounce_pixels", which);
        session->draw();
        return (double(session->extension().info().nearest_rays) - others) / pixels;
    };
    EXPECT_EQ(bounce_rays("all"), 1);
    EXPECT_EQ(bounce_rays("half"), 0.5);
    EXPECT_EQ(bounce_rays("quarter"), 0.25);
    const bool is_cpu = std::string_view(session->extension().info().device).find("llvmpipe") != std::string_view::npos;
    EXPECT_EQ(bounce_rays("auto"), is_cpu ? 0.25 : 0.5);
    session->view.time += 100; // a cut: what is shared would stand out where nothing older is known
    EXPECT_EQ(bounce_rays("quarter"), 1);
    EXPECT_EQ(bounce_rays("quarter"), 0.25);
    session->view.view_angles[1] += 30; // a part of the picture comes into view
    const double turned = bounce_rays("quarter");
    EXPECT_GT(turned, 0.3);
    EXPECT_LT(turned, 0.8);
    session->set("flt_denoiser", "off"); // nothing would even out what neighbours have in common
    EXPECT_EQ(bounce_rays("quarter"), 1);
    session->set("flt_denoiser", "svgf");
    session->set("pt_roughness_default", 0.1); // a neighbour's reflections are other ones
    EXPECT_EQ(bounce_rays("quarter"), 1);
}

// Also at edges, where a pixel takes over a neighbour's light in some frames and in others has none; and in a picture
// whose last blocks lie partly outside.
TEST_F(BouncePixels, KeepTheLight)
{
    const auto session
        = start({ { "flt_denoiser", "temporal" }, { "pt_seed", "0" }, { "pt_roughness_default", "0.5" } }, { 61, 45 });
    session->set("pt_bounce_pixels", "all");
    const Radiance all = mean_of_frames(*session);
    std::vector<size_t> edges;
    for (int y = 0; y < all.height; y++)
        for (int x = 1; x < all.width; x++) {
            const float here = luminance(all.at(x, y)), left = luminance(all.at(x - 1, y));
            if (std::abs(here - left) > 0.3f * std::max(here, left))
                edges.push_back(size_t(y) * size_t(all.width) + size_t(x));
        }
    ASSERT_GT(edges.size(), all.pixels.size() / 20);
    const auto sum_of_edges = [&](const Radiance& picture) {
        double sum = 0;
        for (const size_t i : edges)
            sum += luminance(picture.pixels[i]);
        return sum;
    };
    for (const char* which : { "half", "quarter" }) {
        session->set("pt_bounce_pixels", which);
        const Radiance shared = mean_of_frames(*session);
        const auto ratio = [&](auto light_of) { return double(light_of(shared)) / double(light_of(all)); };
        const auto of_all = [](const Radiance& picture) { return luminance(picture.mean()); };
        const auto of_last_column = [](const Radiance& picture) {
            return luminance(picture.mean({ 60, 0 }, { 61, 45 }));
        };
        EXPECT_NEAR(ratio(of_all), 1, 0.01) << which;
        EXPECT_NEAR(ratio(sum_of_edges), 1, 0.02) << which;
        EXPECT_NEAR(ratio(of_last_column), 1, 0.08) << which;
    }
}

TEST_F(BouncePixels, PhotoModeHasThemAll)
{
    const auto session = start({ { "flt_denoiser", "asvgf" } });
    session->set("pt_bounce_pixels", "all");
    const Radiance all = session->accumulate(4);
    session->set("pt_bounce_pixels", "quarter");
    EXPECT_TRUE(session->accumulate(4) == all);
}

} // namespace
} // namespace vkpt::tests

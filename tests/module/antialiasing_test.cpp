// SPDX-License-Identifier: GPL-2.0-or-later
// Lamps of a few pixels and less, in the picture that is averaged over frames: as bright as they are, and calm.
#include "shaders/shared/frame.h"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <utility>

namespace vkpt::tests {
namespace {

// Before a wall, in rows: lamps of .4 pixels, of 1.2, of 3, and a long one, .6 pixels high.
class SmallLamps : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        folder_->add_wall("wall", 120);
        folder_->add_wall("lamp", white_index);
        MapBuilder map;
        map.add_room({ -128, -128, -128 }, { 128, 128, 128 }, map.add_material("wall"));
        const uint16_t lamp = map.add_material("lamp", 0, 4000);
        const auto add = [&](float y, float z, float half_width, float half_height) {
            map.add(rectangle({ distance, y, z }, { 0, -half_width * pixel, 0 }, { 0, 0, half_height * pixel }), lamp);
        };
        for (int i = 0; i < 48; i++) // each elsewhere within a pixel
            add(-36 + 6.1f * float(i % 12), 20 + 5.3f * float(i / 12) + 0.13f * float(i % 12), 0.2f, 0.2f);
        for (int i = 0; i < 6; i++) {
            add(-40 + 16.3f * float(i), 10 + 0.31f * float(i), 0.6f, 0.6f);
            add(-40 + 16.3f * float(i), -10 + 0.31f * float(i), 1.5f, 1.5f);
        }
        // Slanted, so that it lies everywhere within pixels.
        map.add(rectangle({ distance, 0, -30 }, { 0, -18 * pixel, 3.1f * pixel }, { 0, 0, 0.3f * pixel }), lamp);
        folder_->add_map("room", map.finish());
        session_ = std::make_unique<Session>(*folder_,
            CvarList { { "flt_denoiser", "asvgf" }, { "pt_exposure", "1" }, { "pt_seed", "0" } }, glm::ivec2(96, 72));
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }
    void SetUp() override
    {
        session_->set("pt_accumulate", 0);
        session_->load_map("room");
    }

    // What pictures around the middle of a walk show.
    struct Shown {
        double brightness = 0; // mean
        double flicker = 0; // root mean square of the second difference over time of x / (1 + x)
    };
    // So many pixels a frame past the lamps.
    static Shown walk_past(float pixels)
    {
        constexpr int before = 4 * shared::OFFSETS_PER_PIXEL, measured = shared::OFFSETS_PER_PIXEL;
        Shown shown;
        std::vector<float> older, last;
        for (int frame = 0; frame < before + measured; frame++) {
            const float y = pixels * pixel * (before + 0.5f * measured - float(frame));
            session_->look({ 0, y, 0 }, { 100, y, 0 }, 60);
            session_->draw();
            if (frame < before)
                continue;
            const Radiance picture = session_->capture();
            shown.brightness += double(luminance(picture.mean())) / measured;
            std::vector<float> now(picture.pixels.size());
            std::ranges::transform(
                picture.pixels, now.begin(), [](glm::vec3 pixel) { return luminance(pixel) / (1 + luminance(pixel)); });
            for (size_t i = 0; i < older.size(); i++) {
                const double change = double(now[i] - 2 * last[i] + older[i]);
                shown.flicker += change * change / double(now.size() * size_t(measured - 2));
            }
            older = std::exchange(last, std::move(now));
        }
        shown.flicker = std::sqrt(shown.flicker);
        return shown;
    }

    // Mean brightness of the converged picture.
    static double measure_converged()
    {
        session_->look({ 0, 0, 0 }, { 100, 0, 0 }, 60);
        const double brightness = double(luminance(session_->accumulate(256).mean()));
        session_->set("pt_accumulate", 0);
        return brightness;
    }

    static constexpr float distance = 120;
    static constexpr float pixel = 2 * distance * 0.57735f / 96; // units that one spans there

    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
};

TEST_F(SmallLamps, KeepTheirLight)
{
    const double converged = measure_converged();
    for (const char* mode : { "on", "upscale" })
        for (const float pixels : { 0.0f, 0.13f, 1.7f }) {
            session_->set("flt_taa", mode);
            session_->view.time += 100; // anew
            const Shown shown = walk_past(pixels);
            const double kept = shown.brightness / converged;
            RecordProperty(std::string(mode) + std::to_string(pixels),
                std::to_string(kept) + ", flicker " + std::to_string(shown.flicker));
            if (pixels == 0) {
                EXPECT_NEAR(kept, 1, 0.03) << mode;
                continue;
            }
            // .82 and .88: lamps of a thousand times white, in part smaller than a pixel; .42 of one ray a pixel
            EXPECT_GT(kept, 0.75) << mode << ", pixels a frame: " << pixels;
            if (pixels < 1) { // .08; .21 of one ray a pixel
                EXPECT_LT(shown.flicker / kept, 0.12) << mode;
            }
        }
}

// Of fewer pixels than are shown: .70 to .73 where one ray a pixel keeps .28 and .24, and .64 are kept of lamps that
// are looked for only beside pixels whose ray has met one.
TEST_F(SmallLamps, KeepTheirLightWhereTheImageIsEnlarged)
{
    const double converged = measure_converged();
    session_->set("flt_taa", "upscale");
    session_->set("pt_render_scale", 60);
    for (const float pixels : { 0.13f, 1.7f }) {
        session_->view.time += 100; // anew
        const double kept = walk_past(pixels).brightness / converged;
        RecordProperty(std::to_string(pixels), std::to_string(kept));
        EXPECT_GT(kept, 0.67) << "pixels a frame: " << pixels;
        EXPECT_LT(kept, 1.03) << "pixels a frame: " << pixels;
    }
    session_->set("pt_render_scale", 100);
}

// More rays through their edges would not know of what lies between: such lamps have their own pixel's ray alone.
TEST_F(SmallLamps, AreDimmedByFog)
{
    session_->set("pt_fog_color", "0 0 0");
    session_->set("pt_fog", 0.01);
    session_->set("flt_taa", "on");
    const double converged = measure_converged();
    const double kept = walk_past(0.13f).brightness / converged;
    RecordProperty("kept", std::to_string(kept));
    EXPECT_LT(kept, 1.03); // .52; 2.5 as if there was none
    EXPECT_GT(kept, 0.3);
    session_->set("pt_fog", 0);
}

// A ledge of a pixel's height under a lamp: the jitter takes its history away in most frames, and its light must not
// pass for a firefly then.
TEST(Ledges, KeepTheirLight)
{
    constexpr float pixel = 2 * 120 * 0.57735f / 96;
    GameFolder folder;
    folder.add_wall("wall", 120);
    folder.add_wall("lamp", white_index);
    MapBuilder map;
    map.add_room({ -128, -128, -128 }, { 128, 128, 128 }, map.add_material("wall"));
    map.add_block({ 116, -60, -0.45f * pixel }, { 124, 60, 0.45f * pixel }, map.add_material("wall"));
    // Looks at the ledge from above, its back to the camera.
    map.add(rectangle({ 108, 0, 12 }, { 0, 60, 0 }, { 3, 0, 3 }), map.add_material("lamp", 0, 60000));
    folder.add_map("ledge", map.finish());
    Session session(folder,
        { { "flt_denoiser", "asvgf" }, { "pt_exposure", "1" }, { "pt_seed", "0" }, { "pt_bounces", "0" } },
        glm::ivec2(96, 72));
    session.load_map("ledge");
    session.look({ 0, 0, 1 }, { 100, 0, 1.2f }, 60);
    const auto brightness = [&] { return luminance(session.capture().mean({ 20, 30 }, { 76, 42 })); };
    session.accumulate(256);
    const float converged = brightness();
    session.set("pt_accumulate", 0);
    session.set("flt_taa", "on");
    session.draw(48);
    RecordProperty("converged", std::to_string(converged));
    const float kept = brightness() / converged;
    RecordProperty("kept", std::to_string(kept));
    EXPECT_NEAR(kept, 1, 0.1);
}

} // namespace
} // namespace vkpt::tests

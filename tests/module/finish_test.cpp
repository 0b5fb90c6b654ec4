// SPDX-License-Identifier: GPL-2.0-or-later
// From radiance to the window, through the real driver: dithering, gamma, blend, bloom, water, exposure.
#include "common/colour.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr float lamp_light = 300;
constexpr int dimmed_style = 1;

// With a glowing lamp on its wall.
void add_room(GameFolder& folder)
{
    MapBuilder room;
    room.add_room({ -256, -256, 0 }, { 256, 256, 256 }, room.add_material("wall"));
    room.add(
        rectangle({ 250, 0, 120 }, { 0, 16, 0 }, { 0, 0, -16 }), room.add_material("wall", formats::SURF_LIGHT, 3000));
    room.add_point_light({ 0, 0, 200 }, lamp_light, dimmed_style);
    folder.add_map("room", room.finish());
}

// A floor under a plain sky, and the room.
class Finish : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        folder_->add_wall("wall", 180);
        MapBuilder field;
        field.add(rectangle({ 0, 0, 0 }, { 512, 0, 0 }, { 0, 512, 0 }), field.add_material("wall"));
        folder_->add_map("field", field.finish());
        add_room(*folder_);
        session_ = std::make_unique<Session>(*folder_, CvarList { { "pt_tone_map", "none" }, { "vid_gamma", "1.2" } });
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }

    void SetUp() override
    {
        for (const auto& [name, value] : CvarList { { "pt_seed", "0" }, { "pt_exposure", "1" }, { "pt_bloom", "0" },
                 { "vid_gamma", "1.2" }, { "pt_accumulate", "0" }, { "pt_bounces", "0" } })
            session_->set(name, value);
        std::fill_n(session_->view.blend, 4, 0.0f);
        session_->view.flags = 0;
    }

    // Nothing but sky of one colour.
    static void look_at_sky()
    {
        session_->load_map("field");
        session_->look({ 0, 0, 40 }, { 1, 0, 100 });
    }
    static void look_at_lamp()
    {
        session_->load_map("room");
        session_->look({ 0, 0, 120 }, { 250, 0, 120 });
    }

    // Mean of the shown green over pixels and frames, 0 to 1.
    static double shown_green(int frames)
    {
        double sum = 0;
        for (int frame = 0; frame < frames; frame++) {
            session_->draw();
            const formats::Image image = session_->capture_display();
            for (const formats::Rgba8& pixel : image.pixels)
                sum += pixel.g / 255.0 / double(image.pixels.size());
        }
        return sum / frames;
    }

    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
};

TEST_F(Finish, DitheredGreyHasItsMeanAndBlueErrors)
{
    look_at_sky();
    session_->draw();
    const Radiance sky = session_->capture();
    const double expected = encode_srgb(double(sky.pixels[0].y));
    const auto brightness = [](glm::vec3 colour) { return luminance(colour); };
    ASSERT_EQ(
        *std::ranges::max_element(sky.pixels, {}, brightness), *std::ranges::min_element(sky.pixels, {}, brightness));
    for (const float exposure : { 0.5f, 0.72f, 0.93f, 1.0f }) {
        session_->set("pt_exposure", exposure);
        EXPECT_NEAR(shown_green(4), encode_srgb(sky.pixels[0].y * exposure), 1e-3) << exposure;
    }
    // Errors of neighbours cancel: blocks of 4 x 4 pixels hold less than white noise's sixteenth of the variance.
    session_->set("pt_exposure", 1);
    session_->draw();
    const formats::Image image = session_->capture_display();
    constexpr int block = 4;
    double variance = 0, block_variance = 0;
    for (int y = 0; y < image.height; y += block)
        for (int x = 0; x < image.width; x += block) {
            double sum = 0;
            for (int i = 0; i < block * block; i++) {
                const size_t pixel = size_t(y + i / block) * size_t(image.width) + size_t(x + i % block);
                const double error = image.pixels[pixel].g / 255.0 - expected;
                sum += error;
                variance += error * error;
            }
            block_variance += sum * sum / (block * block);
        }
    EXPECT_GT(variance, 0);
    EXPECT_LT(block_variance, 0.3 * variance); // white: equal
}

TEST_F(Finish, GammaAndBlendAreApplied)
{
    look_at_sky();
    const double plain = shown_green(2);
    session_->set("vid_gamma", 2.4);
    EXPECT_NEAR(shown_green(2), std::sqrt(plain), 2e-3);
    session_->set("vid_gamma", 1.2);
    const float blend[4] = { 0, 1, 0, 0.25f };
    std::ranges::copy(blend, session_->view.blend);
    EXPECT_NEAR(shown_green(2), 0.75 * plain + 0.25, 2e-3);
    session_->set("gl_polyblend", 0);
    EXPECT_NEAR(shown_green(2), plain, 2e-3);
    session_->set("gl_polyblend", 1);
}

// The video menu's overbrights and color intensity.
TEST_F(Finish, MenusRowsMakeThePictureBrighter)
{
    look_at_sky();
    session_->set("pt_exposure", 0.5);
    session_->draw();
    const double sky = 0.5 * session_->capture().pixels[0].y, plain = shown_green(2);
    EXPECT_NEAR(plain, encode_srgb(sky), 2e-3);
    session_->set("vk_overbrightbits", 1.5);
    EXPECT_NEAR(shown_green(2), encode_srgb(1.5 * sky), 2e-3);
    session_->set("vk_overbrightbits", 1);
    session_->set("vk_intensity", 3);
    EXPECT_NEAR(shown_green(2), std::min(1.0, 1.5 * plain), 2e-3);
    session_->set("vk_intensity", 0);
    EXPECT_NEAR(shown_green(2), 0.5 * plain, 2e-3);
    session_->set("vk_intensity", 2);
}

// Shown brightness of a column of pixels at the lamp's height, `off` pixels from the lamp's middle.
double shown_beside(Session& session, int off)
{
    session.draw();
    const formats::Image image = session.capture_display();
    return image.pixels[size_t(image.height / 2) * size_t(image.width) + size_t(image.width / 2 + off)].g;
}

TEST_F(Finish, BloomSpreadsLightButNotInReferences)
{
    look_at_lamp();
    session_->light_style(dimmed_style, 0);
    session_->set("pt_bounces", 0);
    session_->set("pt_exposure", 0.05);
    const double without = shown_beside(*session_, 4);
    const Radiance radiance = session_->capture();
    session_->set("pt_bloom", 0.2);
    EXPECT_GT(shown_beside(*session_, 4), without + 4);
    EXPECT_EQ(count_broken(session_->capture()), 0u);
    EXPECT_NEAR(luminance(session_->capture().mean()), luminance(radiance.mean()), 0.2f * luminance(radiance.mean()));
    session_->set("pt_accumulate", 1);
    EXPECT_NEAR(shown_beside(*session_, 4), without, 3);
    session_->light_style(dimmed_style, 1);
}

TEST_F(Finish, ThePictureSwaysUnderWater)
{
    look_at_lamp();
    session_->set("pt_water_density", 0); // how clear it is does not matter here
    const auto shown = [&](float warp, int32_t flags) {
        session_->set("pt_water_warp", warp);
        session_->set("pt_seed", 1);
        session_->view.flags = flags;
        session_->draw();
        return session_->capture_display().pixels;
    };
    const auto differs = [](const std::vector<formats::Rgba8>& a, const std::vector<formats::Rgba8>& b) {
        size_t count = 0;
        for (size_t i = 0; i < a.size(); i++)
            count += std::abs(int(a[i].g) - int(b[i].g)) > 8;
        return count;
    };
    EXPECT_EQ(differs(shown(0, 0), shown(1, 0)), 0u);
    const auto still = shown(0, engine::RDF_UNDERWATER), swaying = shown(1, engine::RDF_UNDERWATER);
    EXPECT_GT(differs(still, swaying), 20u);
    session_->view.time += 0.5f;
    EXPECT_GT(differs(swaying, shown(1, engine::RDF_UNDERWATER)), 8u);
    session_->set("pt_water_density", 0.5);
}

TEST_F(Finish, ExposureFollowsTheLightBitByBit)
{
    look_at_lamp();
    session_->set("pt_seed", 1); // a sixtieth of a second a frame
    session_->set("pt_exposure", 0);
    session_->light_style(dimmed_style, 1);
    const double bright = shown_green(120);
    const double settled = shown_green(1);
    session_->light_style(dimmed_style, 0.05f);
    const double at_once = shown_green(1);
    session_->draw(30);
    const double later = shown_green(1);
    session_->draw(240);
    const double adapted = shown_green(1);
    EXPECT_GT(bright, 0);
    EXPECT_LT(at_once, 0.7 * settled);
    EXPECT_GT(later, at_once * 1.02);
    EXPECT_GT(adapted, later * 1.02);
    EXPECT_LT(adapted, settled); // a dark room stays darker than a bright one
    session_->light_style(dimmed_style, 1);
}

// By pt_exposure_speed towards what was measured, as 1 - exp(-seconds * speed).
TEST_F(Finish, ExposureAdaptsAtItsSpeed)
{
    look_at_sky();
    session_->set("pt_seed", 1); // a sixtieth of a second a frame
    session_->set("pt_exposure", 0);
    const auto log2_exposure = [&] {
        session_->draw();
        const double radiance = double(session_->capture().pixels[0].y);
        const double shown = shown_green(1);
        return std::log2(decode_srgb(shown) / radiance);
    };
    for (const double speed : { 0.5, 2.0, 6.0 }) {
        SCOPED_TRACE(speed);
        session_->set("pt_sky_scale", 0.25);
        session_->set("pt_exposure_speed", 100);
        session_->draw(30);
        const double first = log2_exposure();
        session_->set("pt_sky_scale", 1);
        session_->draw(30);
        const double last = log2_exposure();
        EXPECT_LT(last, first - 1);
        session_->set("pt_sky_scale", 0.25);
        session_->draw(30);
        session_->set("pt_exposure_speed", speed);
        session_->set("pt_sky_scale", 1);
        constexpr int frames = 20;
        session_->draw(frames - 2);
        const double now = log2_exposure(); // in the last of two
        EXPECT_NEAR((now - last) / (first - last), std::exp(-speed * frames / 60), 0.02);
    }
    session_->set("pt_exposure_speed", 2);
    session_->set("pt_sky_scale", 1);
}

TEST_F(Finish, ExposureBiasIsInStops)
{
    look_at_sky();
    session_->draw();
    const double radiance = double(session_->capture().pixels[0].y);
    session_->set("pt_exposure", 0.1 / radiance);
    for (const double bias : { -2.0, -1.0, 0.0, 1.0, 3.0 }) {
        session_->set("pt_exposure_bias", bias);
        EXPECT_NEAR(shown_green(4), encode_srgb(0.1 * std::exp2(bias)), 2e-3) << bias;
    }
    session_->set("pt_exposure_bias", 0);
}

// Middle grey a little darker than it is, a straight middle, and a shoulder that ends at 11 times white.
TEST_F(Finish, FilmicCurveGoesThroughItsPoints)
{
    look_at_sky();
    session_->draw();
    const double radiance = double(session_->capture().pixels[0].y);
    session_->set("pt_tone_map", "filmic");
    const std::pair<double, double> points[] = { { 0.01, 0.0028 }, { 0.05, 0.0249 }, { 0.18, 0.1443 }, { 0.5, 0.4030 },
        { 1, 0.6182 }, { 4, 0.9124 }, { 11, 1 } };
    for (const auto& [exposed, display] : points) {
        session_->set("pt_exposure", exposed / radiance);
        EXPECT_NEAR(shown_green(4), encode_srgb(display), 2e-3) << exposed;
    }
    session_->set("pt_tone_map", "none");
}

// What bloom adds to the picture's brightness in its middle rows, at these shares of the width beside the lamp.
std::vector<double> measure_halo(const GameFolder& folder, glm::ivec2 size, std::initializer_list<double> places)
{
    Session session(folder,
        { { "pt_tone_map", "none" }, { "pt_exposure", "0.5" }, { "pt_bounces", "0" }, { "pt_bloom", "0" } }, size);
    session.load_map("room");
    session.look({ 0, 0, 120 }, { 250, 0, 120 });
    session.light_style(dimmed_style, 0);
    session.draw();
    const formats::Image without = session.capture_display();
    session.set("pt_bloom", 1);
    session.draw();
    const formats::Image with = session.capture_display();
    std::vector<double> halo;
    for (const double place : places) {
        double sum = 0;
        const int column = int((0.5 + place) * size.x), rows = size.y / 6;
        for (int y = size.y / 2 - rows; y < size.y / 2 + rows; y++) {
            const size_t pixel = size_t(y) * size_t(size.x) + size_t(column);
            sum += double(with.pixels[pixel].g) - double(without.pixels[pixel].g);
        }
        halo.push_back(sum / (2 * rows));
    }
    return halo;
}

TEST(Bloom, IsAsWideInPicturesOfEverySize)
{
    GameFolder folder;
    folder.add_wall("wall", 180);
    add_room(folder);
    const auto places = { 0.06, 0.12, 0.2 };
    const std::vector<double> expected = measure_halo(folder, { 512, 384 }, places);
    for (const glm::ivec2 size : { glm::ivec2(128, 96), glm::ivec2(1024, 768) }) {
        const std::vector<double> halo = measure_halo(folder, size, places);
        for (size_t i = 0; i < halo.size(); i++) {
            EXPECT_GT(halo[i], 5) << size.x;
            EXPECT_NEAR(halo[i] / expected[i], 1, 0.2) << size.x << ", place " << i;
        }
    }
}

} // namespace
} // namespace vkpt::tests

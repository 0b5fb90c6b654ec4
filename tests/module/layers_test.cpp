// SPDX-License-Identifier: GPL-2.0-or-later
// What is seen through glass, in water and behind particles, in filtered pictures and in single frames.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <utility>

namespace vkpt::tests {
namespace {

constexpr glm::ivec2 layers_size { 96, 72 };

// A sheet of a material, upright at x = 0 or lying at z = 0, and a lit wall with a lamp in it beyond.
class Layers : public testing::Test {
protected:
    Layers()
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("lamp", white_index);
        folder_.add_wall("sheet", 100);
    }

    void start(const Polygon& sheet, uint32_t flags, bool present = true)
    {
        session_ = nullptr;
        MapBuilder map;
        const uint16_t wall = map.add_material("wall"), lamp = map.add_material("lamp", 0, 60);
        map.add_room({ -200, -200, -200 }, { 200, 200, 200 }, wall);
        map.add(rectangle({ -199, 20, 10 }, { 0, 30, 0 }, { 0, 0, 30 }), lamp);
        map.add(rectangle({ 20, 40, -199 }, { 30, 0, 0 }, { 0, 30, 0 }), lamp);
        map.add_point_light({ 150, 100, 150 }, 300);
        map.add_point_light({ -150, -100, -150 }, 100);
        if (present)
            map.add(sheet, map.add_material("sheet", flags));
        folder_.add_map("room", map.finish());
        session_ = std::make_unique<Session>(folder_, CvarList { { "pt_seed", "0" } }, layers_size);
        session_->load_map("room");
    }

    // After so many live frames.
    Radiance filter(const char* denoiser, const char* antialiasing, int frames)
    {
        session_->set("pt_accumulate", 0);
        session_->set("flt_denoiser", denoiser);
        session_->set("flt_taa", antialiasing);
        session_->draw(frames);
        return session_->capture();
    }
    Radiance converge() { return session_->accumulate(600); }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
};

const Polygon window = rectangle({ 0, 0, 0 }, { 0, 60, 0 }, { 0, 0, 60 });
const Polygon pool = rectangle({ 0, 0, 0 }, { 120, 0, 0 }, { 0, 120, 0 });

struct LayersCase {
    const char* name;
    Polygon sheet;
    uint32_t flags;
    glm::vec3 eye;
};
void PrintTo(const LayersCase& c, std::ostream* out) { *out << c.name; }

class LayersOf : public Layers, public testing::WithParamInterface<LayersCase> { };

// Root of the mean squared difference in what the eye tells apart: more where it is dark, nothing in what is white
// anyway.
float visible_error(const Radiance& picture, const Radiance& reference)
{
    double sum = 0;
    for (size_t i = 0; i < picture.pixels.size(); i++) {
        const auto shown = [](glm::vec3 colour) { return std::sqrt(std::min(luminance(colour), 2.0f)); };
        const float off = shown(picture.pixels[i]) - shown(reference.pixels[i]);
        sum += double(off) * off;
    }
    return float(std::sqrt(sum / double(picture.pixels.size())));
}

TEST_P(LayersOf, FilteredPictureIsTheConvergedOne)
{
    start(GetParam().sheet, GetParam().flags);
    session_->look(GetParam().eye, { 0, 0, 0 }, 50);
    const Radiance reference = converge();
    for (const auto& [antialiasing, max_error] : { std::pair("off", 0.025f), std::pair("on", 0.013f) }) {
        const Radiance filtered = filter("asvgf", antialiasing, 60);
        EXPECT_NEAR(luminance(filtered.mean()), luminance(reference.mean()), 0.04f * luminance(reference.mean()))
            << antialiasing;
        EXPECT_LT(visible_error(filtered, reference), max_error) << antialiasing;
    }
}

// Layers that pixels share out must not show as a pattern that moves.
TEST_P(LayersOf, AtRestNothingFlickers)
{
    start(GetParam().sheet, GetParam().flags);
    session_->look(GetParam().eye, { 0, 0, 0 }, 50);
    Radiance before = filter("asvgf", "on", 60);
    for (int frame = 0; frame < 4; frame++) {
        session_->draw();
        const Radiance now = session_->capture();
        EXPECT_LT(visible_error(now, before), 0.004f) << frame;
        before = now;
    }
}

INSTANTIATE_TEST_SUITE_P(, LayersOf,
    testing::Values(LayersCase { "Glass33", window, formats::SURF_TRANS33, { 120, 20, 10 } },
        LayersCase { "Glass66", window, formats::SURF_TRANS66, { 120, 20, 10 } },
        LayersCase { "Water", pool, formats::SURF_TRANS66 | formats::SURF_WARP, { 150, 20, 60 } }),
    [](const auto& test) { return std::string(test.param.name); });

// As the classic renderers have it: nobody sees a pane twice who looks through its front and out of its back.
TEST_F(Layers, BacksOfGlassAreNotSeen)
{
    const auto seen_from_behind = [&](bool present) {
        start(window, formats::SURF_TRANS66, present);
        session_->set("pt_seed", 1);
        session_->set("r_fullbright", 1); // else what the pane takes of the room's light would be seen
        session_->look({ -120, 20, 10 }, { 0, 0, 0 }, 40);
        session_->draw();
        return luminance(session_->capture().mean());
    };
    const float without = seen_from_behind(false);
    EXPECT_NEAR(seen_from_behind(true), without, 1e-4f * without); // the ray goes on from the pane
}

// Particles are not lit: what they show and what is behind them is mixed, not chosen from. Many of them, one behind the
// other.
TEST_F(Layers, ParticlesAreMixedInEveryFrame)
{
    MapBuilder map;
    folder_.add_map(
        "dark", (map.add_room({ -200, -200, -200 }, { 200, 200, 200 }, map.add_material("wall")), map.finish()));
    session_ = std::make_unique<Session>(folder_, CvarList { { "pt_exposure", "1" } }, layers_size);
    session_->load_map("dark");
    session_->look({ 100, 0, 0 }, { 0, 0, 0 }, 20);
    std::vector<engine::Particle> particles(1, { { 90, 0, 0 }, white_index, 1.0f });
    const auto brightest = [&] {
        session_->view.particles = particles.data();
        session_->view.particle_count = int32_t(particles.size());
        session_->draw(2); // the second one knows the exposure
        const Radiance picture = session_->capture();
        return luminance(picture.at(layers_size.x / 2, layers_size.y / 2));
    };
    const float opaque = brightest();
    ASSERT_GT(opaque, 0);
    for (const float alpha : { 0.25f, 0.5f, 0.8f }) {
        particles.assign(1, { { 90, 0, 0 }, white_index, alpha });
        EXPECT_NEAR(brightest(), alpha * opaque, 1e-3f * opaque) << alpha;
        particles.assign(3, { { 90, 0, 0 }, white_index, alpha });
        for (size_t i = 0; i < particles.size(); i++)
            particles[i].origin[0] -= 4 * float(i);
        const float through = 1 - alpha;
        EXPECT_NEAR(brightest(), (1 - through * through * through) * opaque, 0.02f * opaque) << alpha;
    }
    // Far more than a path has mirrors.
    particles.assign(40, { { 90, 0, 0 }, white_index, 0.05f });
    for (size_t i = 0; i < particles.size(); i++)
        particles[i].origin[0] -= 2 * float(i);
    EXPECT_NEAR(brightest(), (1 - std::pow(0.95f, 40.0f)) * opaque, 0.02f * opaque);
}

// Discs with a soft edge, or squares; as large as gl3_particle_size says.
TEST_F(Layers, ParticlesAreSoftDiscs)
{
    MapBuilder map;
    folder_.add_map(
        "dark", (map.add_room({ -200, -200, -200 }, { 200, 200, 200 }, map.add_material("wall")), map.finish()));
    session_ = std::make_unique<Session>(
        folder_, CvarList { { "pt_exposure", "1" }, { "pt_accumulate", "1" } }, layers_size);
    session_->load_map("dark");
    session_->look({ 4, 0, 0 }, { 0, 0, 0 }, 40);
    const engine::Particle particle { { 0, 0, 0 }, white_index, 1.0f };
    session_->view.particles = &particle;
    session_->view.particle_count = 1;
    const auto measure_opaque_pixels = [&] {
        session_->extension().thaw_scene();
        session_->draw(64);
        const Radiance picture = session_->capture();
        float sum = 0, brightest = 0;
        for (const glm::vec3& pixel : picture.pixels) {
            sum += luminance(pixel);
            brightest = std::max(brightest, luminance(pixel));
        }
        return sum / brightest;
    };
    const float disc = measure_opaque_pixels();
    session_->set("gl3_particle_square", 1);
    const float square = measure_opaque_pixels();
    session_->set("gl3_particle_size", 20);
    const float half = measure_opaque_pixels();
    session_->set("gl3_particle_square", 0);
    session_->set("gl3_particle_size", 40);
    ASSERT_GT(square, 100);
    // Over the disc the mean of min(1, 1.2 (1 - r^2)) is 1/6 + 0.5 * 5/6.
    EXPECT_NEAR(disc / square, float(M_PI) / 4 * (1.0f / 6 + 5.0f / 12), 0.02f);
    EXPECT_NEAR(half / square, 0.25f, 0.02f);
}

// The same on the screen in the dark and in the light: the displayed value is radiance times exposure.
TEST_F(Layers, ParticlesFollowTheEyesAdaptation)
{
    MapBuilder map;
    folder_.add_map(
        "dark", (map.add_room({ -200, -200, -200 }, { 200, 200, 200 }, map.add_material("wall")), map.finish()));
    session_ = std::make_unique<Session>(folder_, CvarList {}, layers_size);
    session_->load_map("dark");
    session_->look({ 100, 0, 0 }, { 0, 0, 0 }, 20);
    const engine::Particle particle { { 90, 0, 0 }, white_index, 1.0f };
    session_->view.particles = &particle;
    session_->view.particle_count = 1;
    float shown[2];
    for (const int i : { 0, 1 }) {
        const float exposure = i == 0 ? 0.1f : 10.0f;
        session_->set("pt_exposure", exposure);
        session_->draw(2);
        shown[i] = luminance(session_->capture().at(layers_size.x / 2, layers_size.y / 2)) * exposure;
    }
    EXPECT_GT(shown[0], 0.3f);
    EXPECT_NEAR(shown[1], shown[0], 0.01f * shown[0]);
}

} // namespace
} // namespace vkpt::tests

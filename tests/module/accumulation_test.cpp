// SPDX-License-Identifier: GPL-2.0-or-later
// Repeatable random numbers, and the average that pt_accumulate keeps.
#include "tests/module/cube_room.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

class Accumulation : public testing::Test {
protected:
    Accumulation()
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("lamp", white_index);
        MapBuilder map;
        map.add_room({ -128, -128, 0 }, { 128, 128, 128 }, map.add_material("wall"));
        map.add(rectangle({ 30, 20, 127 }, { 0, 32, 0 }, { 32, 0, 0 }), map.add_material("lamp", 0, 1000));
        map.add_point_light({ -90, 90, 60 }, 100);
        folder_.add_map("room", map.finish());
    }

    void prepare(Session& session)
    {
        session.load_map("room");
        session.look({ -100, -100, 80 }, { 60, 60, 20 });
    }

    Radiance render(Session& session, int seed, int frames)
    {
        session.set("pt_seed", seed);
        return session.accumulate(frames);
    }

    GameFolder folder_;
};

double rms_difference(const Radiance& a, const Radiance& b)
{
    double sum = 0;
    for (size_t i = 0; i < a.pixels.size(); i++) {
        const glm::dvec3 d = glm::dvec3(a.pixels[i]) - glm::dvec3(b.pixels[i]);
        sum += d.x * d.x + d.y * d.y + d.z * d.z;
    }
    return std::sqrt(sum / double(3 * a.pixels.size()));
}

TEST_F(Accumulation, ASeedRepeatsBitForBit)
{
    Radiance first, second;
    {
        Session session(folder_);
        prepare(session);
        first = render(session, 7, 12);
        EXPECT_FALSE(is_black(first));
        EXPECT_FALSE(render(session, 8, 12) == first);
        EXPECT_TRUE(render(session, 7, 12) == first);
        session.load_map("room");
        EXPECT_TRUE(render(session, 7, 12) == first);
    }
    Session::end_idle();
    Session session(folder_);
    prepare(session);
    EXPECT_TRUE(render(session, 7, 12) == first);
}

TEST_F(Accumulation, SeedZeroIsNewEveryTime)
{
    Session session(folder_);
    prepare(session);
    const Radiance first = render(session, 0, 4);
    EXPECT_FALSE(render(session, 0, 4) == first);
}

TEST_F(Accumulation, CountsFramesAndStartsAgainWhenTheViewChanges)
{
    Session session(folder_, { { "pt_accumulate", "1" } });
    prepare(session);
    for (uint32_t frame = 1; frame <= 5; frame++) {
        session.draw();
        EXPECT_EQ(session.extension().accumulated_frames(), frame);
    }
    session.view.view_angles[1] += 1;
    session.draw();
    EXPECT_EQ(session.extension().accumulated_frames(), 1u);
    session.draw(2);
    EXPECT_EQ(session.extension().accumulated_frames(), 3u);
    session.set("pt_emission_scale", 2);
    session.draw();
    EXPECT_EQ(session.extension().accumulated_frames(), 1u);
    session.set("pt_accumulate", 0);
    session.draw(3);
    EXPECT_EQ(session.extension().accumulated_frames(), 1u);
}

// The average of n frames is that of its frames.
TEST_F(Accumulation, IsTheMeanOfItsFrames)
{
    Session session(folder_);
    prepare(session);
    const double error = rms_difference(render(session, 3, 200), render(session, 4, 200));
    const glm::vec3 mean = render(session, 5, 200).mean();
    EXPECT_NEAR(luminance(render(session, 6, 4).mean()), luminance(mean), 0.05f * luminance(mean));
    EXPECT_LT(error, 0.2 * luminance(mean));
}

double mean_difference(const Radiance& a, const Radiance& b)
{
    double sum = 0;
    for (size_t i = 0; i < a.pixels.size(); i++) {
        const glm::dvec3 d = glm::abs(glm::dvec3(a.pixels[i]) - glm::dvec3(b.pixels[i]));
        sum += d.x + d.y + d.z;
    }
    return sum / double(3 * a.pixels.size());
}

// Two seeds' pictures differ by their errors alone: sixteen times the frames, a quarter of the error. A few bright
// pixels decide the squared error; of the mean difference, one pair's ratio has a standard deviation of .33.
TEST_F(Accumulation, ErrorFallsWithTheSquareRootOfTheFrames)
{
    constexpr int pairs = 6;
    Session session(folder_);
    prepare(session);
    double few = 0, many = 0;
    for (int i = 0; i < pairs; i++) {
        const int seed = 1 + 4 * i;
        few += mean_difference(render(session, seed, 16), render(session, seed + 1, 16));
        many += mean_difference(render(session, seed + 2, 256), render(session, seed + 3, 256));
    }
    EXPECT_NEAR(few / many, 4, 0.4);
}

// A lit room with a cube, a dynamic light and particles, whose time stands still.
class FrozenScene : public CubeRoomTest {
protected:
    static constexpr int samples = 8;

    void start()
    {
        CubeRoomTest::start({ { "pt_bounces", "0" } });
        session_->view.dlights = &light_;
        session_->view.dlight_count = 1;
        session_->view.particles = &particle_;
        session_->view.particle_count = 1;
    }
    Radiance see()
    {
        session_->draw(samples);
        EXPECT_EQ(session_->extension().accumulated_frames(), uint32_t(samples));
        return session_->capture();
    }

    engine::DynamicLight light_ { { 0, 60, 40 }, { 1, 1, 0 }, 200 };
    engine::Particle particle_ { { -40, -20, 50 }, white_index, 1 };
};

// Settings that count where the scene is taken, too.
TEST_F(FrozenScene, SettingsCountAtOnce)
{
    start();
    const CvarList changes { { "pt_emission_scale", "3" }, { "pt_dlight_scale", "5" },
        { "pt_roughness_default", "0.1" }, { "pt_metallic_default", "1" }, { "pt_flashlight", "1" },
        { "gl3_particle_size", "400" }, { "r_drawentities", "0" }, { "vk_dynamic", "0" } };
    for (const auto& [name, value] : changes) {
        SCOPED_TRACE(name);
        const Radiance before = session_->accumulate(samples);
        const std::string initial = session_->host().cvars().find(name)->text;
        session_->set(name, value);
        const Radiance changed = see();
        EXPECT_FALSE(changed == before);
        EXPECT_TRUE(changed == session_->accumulate(samples)) << "as from the start";
        session_->set(name, initial);
        EXPECT_TRUE(see() == before);
    }
}

TEST_F(FrozenScene, StandsStillWhileNothingIsChanged)
{
    start();
    const Radiance before = session_->accumulate(samples);
    cube_.origin[2] = 90;
    session_->view.view_angles[1] += 1;
    see();
    session_->view.view_angles[1] -= 1;
    EXPECT_TRUE(see() == before) << "the cube has moved";
}

} // namespace
} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// What the ring keeps and forgets, that its traces are whole, and where the player is.
#include "ref_vkpt/replay/replay.hpp"
#include "ref_vkpt/replay/replay_ring.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

using trace::CallKind;

int model_place, skin_place;

class ReplayParts : public testing::Test {
protected:
    ReplayParts()
    {
        ring.begin_map("castle");
        ring.note_model("models/a.md2", &model_place);
        ring.note_skin("players/a.pcx", &skin_place);
        ring.note_model("models/a.md2", &model_place); // twice, as the engine does
        ring.note_model("models/missing.md2", nullptr);
        ring.end_registration();
        entity.model = &model_place;
        entity.skin = &skin_place;
        refdef.fov_x = refdef.fov_y = 90;
        refdef.entities = &entity;
        refdef.entity_count = 1;
    }

    // `seconds` of a flight along x, ten units a second.
    void fly(float seconds, float step = 1.0f / 60)
    {
        for (const float end = refdef.time + seconds; refdef.time < end - step / 2;) {
            refdef.time += step;
            refdef.view_origin[0] = 10 * refdef.time;
            entity.origin[0] = entity.previous_origin[0] = 20 * refdef.time;
            ring.add(refdef, limits);
        }
    }
    Replay play() { return { ring.make_trace({}), ring.handles() }; }

    ReplayRing ring;
    ReplayRing::Limits limits;
    engine::Entity entity {};
    engine::RefDef refdef {};
};

TEST_F(ReplayParts, TracesAreWhole)
{
    fly(5);
    const auto file = ring.make_trace({});
    const trace::TraceReader reader({ reinterpret_cast<const char*>(file.data()), file.size() }, "a");
    EXPECT_EQ(reader.cut_at(), 0u);
    EXPECT_EQ(reader.frame_count(), 300u);
    EXPECT_EQ(reader.frame_count(), ring.views());
    EXPECT_EQ(reader.totals().calls, 4 + 3 * 300u);
    ASSERT_EQ(reader.lasting_calls().size(), 4u);
    EXPECT_EQ(reader.lasting_calls()[0].call.kind, CallKind::begin_registration);
    EXPECT_EQ(reader.lasting_calls()[1].call.name, "models/a.md2");
    EXPECT_EQ(reader.lasting_calls()[1].call.numbers[0], 1);
    EXPECT_EQ(reader.lasting_calls()[2].call.numbers[0], 2);
    fly(1); // it goes on being kept
    EXPECT_EQ(ring.views(), 360u);
    EXPECT_NEAR(play().length(), 6, 0.05);
}

TEST_F(ReplayParts, ForgetsWhatIsOlderThanItsSeconds)
{
    limits.seconds = 10;
    fly(35);
    EXPECT_GE(ring.seconds(), 10);
    EXPECT_LT(ring.seconds(), 13) << "a chunk more, at most";
    Replay replay = play();
    EXPECT_NEAR(replay.moment().view_origin[0], 10 * (35 - ring.seconds()), 0.5);
    EXPECT_EQ(replay.moment().entities[0].model, &model_place) << "registrations stay";
    limits.seconds = 0;
    fly(0.1f);
    EXPECT_TRUE(ring.is_empty());
}

TEST_F(ReplayParts, StaysWithinItsMemory)
{
    std::vector<engine::Particle> particles(2000);
    refdef.particles = particles.data();
    refdef.particle_count = int32_t(particles.size());
    limits.bytes = 1 << 20;
    uint32_t random = 1;
    for (int i = 0; i < 600; i++) {
        for (engine::Particle& particle : particles)
            for (float& x : particle.origin)
                x = float(random = random * 1664525u + 1013904223u) * 1e-6f;
        fly(1.0f / 60);
        ASSERT_LE(ring.bytes(), limits.bytes + (2 << 20)) << "the newest chunk always stays";
    }
    EXPECT_GT(ring.views(), 0u);
    EXPECT_LT(ring.views(), 600u);
}

TEST_F(ReplayParts, KeepsNothingOfAPausedGameAndAFewOfManyViews)
{
    fly(1);
    const size_t views = ring.views();
    for (int i = 0; i < 100; i++)
        ring.add(refdef, limits);
    EXPECT_EQ(ring.views(), views);
    fly(1, 0.001f);
    EXPECT_NEAR(double(ring.views() - views), 80, 8);
}

TEST_F(ReplayParts, AnotherMapOrClockForgetsWhatWas)
{
    fly(2);
    refdef.time = 0.5f;
    fly(1);
    EXPECT_EQ(ring.views(), 60u);
    ring.begin_map("garden");
    EXPECT_TRUE(ring.is_empty());
    EXPECT_EQ(ring.handles().size(), 1u);
    EXPECT_EQ(ring.map(), "garden");
}

TEST_F(ReplayParts, PlaysBetweenViewsForwardsAndBackwards)
{
    fly(4, 0.1f);
    Replay replay = play();
    EXPECT_FALSE(replay.is_playing());
    EXPECT_TRUE(replay.takes_moment());
    EXPECT_FALSE(replay.takes_moment());
    replay.play(0.5);
    replay.advance(0.5); // a quarter of a second
    EXPECT_TRUE(replay.takes_moment());
    EXPECT_NEAR(replay.place(), 0.25, 1e-9);
    EXPECT_NEAR(replay.moment().view_origin[0], 1 + 2.5, 1e-3);
    EXPECT_NEAR(replay.moment().entities[0].origin[0], 2 + 5, 1e-3);
    EXPECT_NEAR(replay.moment().time, 0.35, 1e-4);
    replay.step(-1);
    EXPECT_NEAR(replay.place(), 0.2, 1e-4);
    replay.step(-1);
    EXPECT_NEAR(replay.place(), 0.1, 1e-4);
    replay.step(2);
    EXPECT_NEAR(replay.place(), 0.3, 1e-4);
    EXPECT_FALSE(replay.is_playing());
    replay.play(-1);
    replay.advance(10);
    EXPECT_EQ(replay.place(), 0);
    EXPECT_FALSE(replay.is_playing()) << "it stops at its start";
    replay.play(-1);
    EXPECT_NEAR(replay.place(), 3.9, 1e-3) << "from the end";
    replay.play(1);
    EXPECT_EQ(replay.place(), 0) << "and from the start";
    replay.seek(99);
    EXPECT_NEAR(replay.place(), 3.9, 1e-3);
}

} // namespace
} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/map_compiler/map_text.hpp"
#include "tests/map_compiler/tracer.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {

using namespace formats;

namespace {

class Collision : public testing::Test {
protected:
    static void SetUpTestSuite() { bsp_ = new Bsp(compile(two_rooms::text())); }
    static void TearDownTestSuite() { delete bsp_; }
    static inline Bsp* bsp_ = nullptr;

    // Where the player's origin stops.
    static glm::vec3 stop(glm::vec3 from, glm::vec3 to)
    {
        const TraceResult result = trace_box(*bsp_, player_box, from, to);
        EXPECT_FALSE(result.starts_solid);
        return from + (to - from) * result.fraction;
    }
};

constexpr float tolerance = 0.02f;

TEST_F(Collision, WallsStopThePlayer)
{
    EXPECT_NEAR(stop({ 0, 0, 30 }, { -1000, 0, 30 }).x, -256 + 16, tolerance);
    EXPECT_NEAR(stop({ 0, 0, 30 }, { 0, -1000, 30 }).y, -256 + 16, tolerance);
    EXPECT_NEAR(stop({ 100, 0, 30 }, { 100, 0, 1000 }).z, 192 - 32, tolerance);
    EXPECT_NEAR(stop({ 100, 0, 30 }, { 100, 0, -1000 }).z, 24, tolerance);
}

TEST_F(Collision, DoorwayLetsThePlayerThroughAndFrameDoesNot)
{
    EXPECT_NEAR(stop({ 0, 0, 30 }, { 2000, 0, 30 }).x, 800 - 16, tolerance);
    EXPECT_NEAR(stop({ 0, 40, 30 }, { 2000, 40, 30 }).x, 256 - 16, tolerance);
}

TEST_F(Collision, StepsHaveTheirHeight)
{
    for (int step = 0; step < 4; step++) {
        const float x = 400 + 32 * float(step) + 32 - 16.5f; // the box's front edge on this step, not the next
        EXPECT_NEAR(stop({ x, 180, 150 }, { x, 180, 0 }).z, 16 + 16 * step + 24, tolerance) << step;
    }
}

TEST_F(Collision, DetailBrushStops) { EXPECT_NEAR(stop({ 0, 120, 30 }, { -200, 120, 30 }).x, -60 + 16, tolerance); }

TEST_F(Collision, PlayerClipStopsPlayersOnly)
{
    EXPECT_NEAR(stop({ -225, 0, 130 }, { -225, 240, 130 }).y, 200 - 16, tolerance);
    const TraceResult shot = trace_box(*bsp_, player_box, { -225, 0, 130 }, { -225, 240, 130 }, CONTENTS_SOLID);
    EXPECT_EQ(shot.fraction, 1);
}

// Without the axial bevel planes the grown diamond would have a spike 16 units longer.
TEST_F(Collision, BevelCutsTheSpikeOfADiamond)
{
    EXPECT_NEAR(stop({ 0, 160, 30 }, { 128, 160, 30 }).x, 96 - 16, tolerance);
    EXPECT_NEAR(stop({ 128, 60, 30 }, { 128, 160, 30 }).y, 128 - 16, tolerance);
}

TEST_F(Collision, WaterDoesNotStop)
{
    EXPECT_NEAR(stop({ -150, -150, 60 }, { -150, -150, -500 }).z, -96 + 24, tolerance);
    EXPECT_LT(trace_box(*bsp_, player_box, { -150, -150, 60 }, { -150, -150, -90 }, CONTENTS_WATER).fraction, 1);
}

TEST_F(Collision, BrushModelsCollideAtTheirOwnTree)
{
    const int door = bsp_->models.at(1).head_node;
    const uint32_t mask = CONTENTS_SOLID;
    const TraceResult hit = trace_box(*bsp_, player_box, { 200, 0, 30 }, { 300, 0, 30 }, mask, door);
    EXPECT_NEAR(200 + 100 * hit.fraction, 264 - 16, tolerance);
    EXPECT_TRUE(trace_box(*bsp_, player_box, { 270, 0, 30 }, { 300, 0, 30 }, mask, door).starts_solid);
    EXPECT_EQ(trace_box(*bsp_, player_box, { 200, 0, 200 }, { 300, 0, 200 }, mask, door).fraction, 1);
}

} // namespace

} // namespace vkpt::tests

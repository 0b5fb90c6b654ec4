// SPDX-License-Identifier: GPL-2.0-or-later
// Which frames have their passes timed one by one, and which are timed as a whole.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <string>

namespace vkpt::tests {
namespace {

struct FrameTimes : testing::Test {
    FrameTimes()
    {
        folder.add_wall("lamp", white_index);
        MapBuilder map;
        map.add_lit_room("missing");
        folder.add_map("room", map.finish());
    }
    // A view that knows the one before, so that all passes of the filters run.
    static void begin(Session& session)
    {
        session.load_map("room");
        session.look({ -100, 0, 50 }, { 100, 0, 50 });
    }
    static bool has_timed(Session& session, const std::string& pass)
    {
        return std::ranges::count(session.timed_passes(), pass) > 0;
    }
    // How many samples each name has.
    static std::map<std::string, size_t> collected(Session& session)
    {
        size_t count = 0;
        const PassSamples* samples = session.extension().collected_times(&count);
        std::map<std::string, size_t> sizes;
        for (size_t i = 0; i < count; i++)
            sizes[samples[i].name] = samples[i].count;
        return sizes;
    }

    GameFolder folder;
    const CvarList filters { { "flt_denoiser", "asvgf" }, { "flt_taa", "on" } };
};

TEST_F(FrameTimes, FollowAGlanceUntilAllAreAskedFor)
{
    Session session(folder, filters);
    begin(session);
    session.draw(1); // its passes are timed, and nothing was before
    EXPECT_TRUE(has_timed(session, "primary_visibility"));
    EXPECT_FALSE(has_timed(session, "denoise_gradient"));
    session.draw(15);
    EXPECT_FALSE(has_timed(session, "denoise_gradient")) << "not timed since";
    session.draw(1);
    EXPECT_TRUE(has_timed(session, "denoise_gradient")) << "one frame of sixteen";

    session.set("flt_denoiser", "temporal");
    session.extension().time_every_pass();
    session.draw(1);
    EXPECT_FALSE(has_timed(session, "denoise_gradient"));
}

TEST_F(FrameTimes, HaveARowForTheBuildsOfStructures)
{
    CvarList cvars = filters;
    cvars.emplace_back("pt_trace", "query");
    Session session(folder, cvars);
    begin(session);
    session.draw(1);
    if (session.extension().info().trace_backend != std::string("query"))
        GTEST_SKIP() << "the device traces no rays of its own";
    EXPECT_TRUE(has_timed(session, "acceleration_structures"));
    session.set("pt_trace", "software");
    session.draw(16);
    EXPECT_FALSE(has_timed(session, "acceleration_structures"));
}

TEST_F(FrameTimes, AreCollectedByTurns)
{
    CvarList cvars = filters;
    cvars.emplace_back("pt_times", "1");
    Session::end_idle(); // once all have been asked for, there are no turns
    Session session(folder, cvars);
    begin(session);
    session.draw(4);
    for (const int frames : { 7, 8 }) {
        session.extension().forget_times();
        session.draw(frames);
        const std::map<std::string, size_t> sizes = collected(session);
        ASSERT_TRUE(sizes.contains("frame") && sizes.contains("direct_light") && sizes.contains("cpu scene"));
        EXPECT_EQ(sizes.at("frame"), frames / 2u);
        EXPECT_EQ(sizes.at("direct_light"), (frames + 1u) / 2) << "passes first";
        EXPECT_EQ(sizes.at("denoise_gradient"), sizes.at("direct_light"));
        EXPECT_EQ(sizes.at("cpu scene"), size_t(frames));
    }
}

} // namespace
} // namespace vkpt::tests

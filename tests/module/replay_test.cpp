// SPDX-License-Identifier: GPL-2.0-or-later
// Instant replay: a moment is shown as it was, through the player's eyes and a free camera's; what is saved is a trace
// that vkpt replays; another map forgets it.
#include "client/host/trace_frames.hpp"
#include "tests/module/cube_room.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace vkpt::tests {
namespace {

namespace fs = std::filesystem;

class InstantReplay : public CubeRoomTest {
protected:
    // Where things are at a moment of the game, 0 and later.
    void set_moment(float time)
    {
        session_->view.time = 1 + time;
        cube_.origin[1] = cube_.previous_origin[1] = 40 * time;
        session_->view.view_origin[0] = -100 + 10 * time;
    }
    void play(int frames)
    {
        for (int i = 0; i < frames; i++) {
            set_moment(float(i) / 10);
            session_->draw();
        }
    }
};

TEST_F(InstantReplay, ShowsAMomentAsItWas)
{
    start();
    set_moment(1.05f); // between two frames
    const Radiance expected = session_->accumulate(16);
    session_->set("pt_accumulate", 0);
    set_moment(1.5f);
    const Radiance later = session_->accumulate(16);
    session_->set("pt_accumulate", 0);
    play(20);
    run("pt_replay");
    run("pt_replay pause");
    run("pt_replay seek 1.05");
    session_->draw(16);
    EXPECT_EQ(session_->extension().accumulated_frames(), 16u);
    const double error = error_between(session_->capture(), expected);
    EXPECT_LT(error, 0.02 * error_between(later, expected));
    // The free camera, at the same moment, and back to the player's eyes.
    run("pt_photo move 30");
    session_->draw(4);
    EXPECT_GT(error_between(session_->capture(), expected), 10 * error);
    run("pt_replay step 3");
    run("pt_replay seek 1.05");
    run("pt_photo home");
    session_->draw(16);
    EXPECT_LT(error_between(session_->capture(), expected), 0.02 * error_between(later, expected));
    run("pt_replay");
    session_->draw(2);
    EXPECT_EQ(session_->extension().accumulated_frames(), 1u) << "the game goes on";
}

TEST_F(InstantReplay, PlaysAndStopsAtItsEnd)
{
    start();
    play(6);
    run("pt_replay");
    run("pt_replay play 16");
    session_->draw(30);
    run("pt_replay info");
    EXPECT_TRUE(session_->has_line("at 0.500 of 0.500 seconds, speed 16, paused"));
    run("pt_replay play -16");
    session_->draw(30);
    run("pt_replay info");
    EXPECT_TRUE(session_->has_line("at 0.000 of 0.500 seconds, speed -16, paused"));
    run("pt_replay dance");
    EXPECT_TRUE(session_->has_line("there is no \"dance\""));
}

TEST_F(InstantReplay, SavesATraceAndNeverOverAnother)
{
    start({ { "pt_photo_save", "1" } });
    play(12);
    const std::string name = fmt::format("room{}", getpid());
    run("pt_replay save " + name);
    constexpr std::string_view words = "pt_replay: wrote ";
    fs::path written;
    for (const std::string& line : session_->lines())
        if (line.starts_with(words))
            written = line.substr(words.size());
    ASSERT_TRUE(written.string().ends_with("/vkpt/replays/" + name + ".rtrace")) << written;
    run("pt_replay save " + name);
    EXPECT_TRUE(session_->has_line(name + " is there already"));
    run("pt_replay save ../a");
    EXPECT_TRUE(session_->has_line("\"../a\" may have only letters"));
    client::TraceFrames frames(session_->files(), written.string(), 0);
    EXPECT_EQ(frames.frame_count(), 12);
    EXPECT_TRUE(frames.notes().empty());
    frames.register_with(session_->host());
    frames.draw(session_->host(), 7);
    const Radiance replayed = session_->capture();
    EXPECT_GT(replayed.mean().y, 0);
    EXPECT_TRUE(fs::remove(written));
}

// Servers can run console commands.
TEST_F(InstantReplay, TheConsoleAloneWritesNothing)
{
    start();
    play(3);
    run("set pt_photo_save 1");
    run("pt_replay save room");
    EXPECT_TRUE(session_->has_line("press T"));
    EXPECT_FALSE(session_->has_line("pt_replay: wrote"));
}

TEST_F(InstantReplay, EndsWithTheMap)
{
    start();
    play(5);
    run("pt_replay");
    session_->draw(2);
    session_->load_map("room");
    session_->view.entity_count = 0;
    run("pt_replay");
    EXPECT_TRUE(session_->has_line("there is nothing to show"));
    session_->draw(2);
    session_->set("pt_replay_seconds", 0);
    session_->draw(2);
    run("pt_replay info");
    EXPECT_TRUE(session_->has_line("0.0 seconds are kept, 0 views"));
}

} // namespace
} // namespace vkpt::tests

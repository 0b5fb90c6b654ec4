// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/photo/pause_watch.hpp"

#include <gtest/gtest.h>

namespace vkpt {
namespace {

using Event = PauseWatch::Event;

struct Told {
    int paused = 0, resumed = 0;
    bool operator==(const Told&) const = default;
};

Told look(PauseWatch& watch, int frames, bool is_paused, bool engine_has_keys)
{
    Told told;
    for (int i = 0; i < frames; i++) {
        const Event event = watch.look(is_paused, engine_has_keys);
        told.paused += event == Event::paused;
        told.resumed += event == Event::resumed;
    }
    return told;
}

TEST(PauseWatch, TellsOfThePlayersPauseOnce)
{
    PauseWatch watch;
    EXPECT_EQ(look(watch, 20, false, false), Told());
    EXPECT_EQ(look(watch, 20, true, false), (Told { 1, 0 }));
    EXPECT_EQ(look(watch, 20, false, false), (Told { 0, 1 }));
}

TEST(PauseWatch, MenusDoNotCount)
{
    PauseWatch watch;
    look(watch, 20, false, false);
    EXPECT_EQ(look(watch, 2, true, false), Told()) << "not yet drawn";
    EXPECT_EQ(look(watch, 100, true, true), Told()) << "open";
    EXPECT_EQ(look(watch, 1, false, true), Told()) << "closed in this frame";
    EXPECT_EQ(look(watch, 20, false, false), Told());
    // Opened in a pause: closing it ends the pause, until somebody asks for it again.
    look(watch, 20, true, false);
    EXPECT_EQ(look(watch, 50, true, true), Told());
    EXPECT_EQ(look(watch, 3, false, false), Told());
    EXPECT_EQ(look(watch, 20, true, false), Told());
    EXPECT_EQ(look(watch, 20, false, false), (Told { 0, 1 }));
}

} // namespace
} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// How long a film will take, said once a minute: films take hours.
#pragma once

#include <chrono>
#include <string>

namespace vkpt::client {

class TimeLeft {
public:
    using Clock = std::chrono::steady_clock;

    TimeLeft(int frames, Clock::time_point start)
        : frames_(frames)
        , start_(start)
        , said_(start)
    {
    }

    // A line where a minute has passed since the last one, and frames are left; else empty.
    std::string describe(int done, Clock::time_point now);

private:
    int frames_;
    Clock::time_point start_, said_;
};

} // namespace vkpt::client

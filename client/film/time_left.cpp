// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/film/time_left.hpp"

#include <cmath>
#include <fmt/format.h>

namespace vkpt::client {

std::string TimeLeft::describe(int done, Clock::time_point now)
{
    constexpr std::chrono::seconds between(60);
    if (now - said_ < between || done == frames_)
        return {};
    said_ = now;
    const double left = std::chrono::duration<double>(now - start_).count() / done * (frames_ - done);
    return fmt::format("frame {} of {}, {:.0f} minutes left", done, frames_, std::ceil(left / 60));
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace vkpt::client {

ProgressBar::ProgressBar(std::string title, int total)
    : title_(std::move(title))
    , total_(std::max(total, 1))
    , is_terminal_(isatty(STDERR_FILENO) != 0)
{
}

ProgressBar::~ProgressBar() { finish(); }

void ProgressBar::show(int done)
{
    if (!is_terminal_)
        return;
    constexpr int width = 40;
    const int filled = std::clamp(int(int64_t(width) * done / total_), 0, width);
    std::fprintf(stderr, "\r%s [%s%s] %d/%d", title_.c_str(), std::string(size_t(filled), '#').c_str(),
        std::string(size_t(width - filled), ' ').c_str(), done, std::max(done, total_));
    is_shown_ = true;
}

void ProgressBar::finish()
{
    if (is_shown_)
        std::fprintf(stderr, "\r\033[K");
    is_shown_ = false;
}

} // namespace vkpt::client

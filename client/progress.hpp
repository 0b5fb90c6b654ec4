// SPDX-License-Identifier: GPL-2.0-or-later
// How far a long command is, on a terminal's last line. Silent where stderr is no terminal.
#pragma once

#include <string>

namespace vkpt::client {

class ProgressBar {
public:
    ProgressBar(std::string title, int total);
    ~ProgressBar(); // leaves no line behind that is not finished
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(int done);
    // Takes the line away.
    void finish();
    bool is_shown() const { return is_shown_; }

private:
    std::string title_;
    int total_;
    bool is_terminal_, is_shown_ = false;
};

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// Makes a film of pictures, by the program ffmpeg.
#pragma once

#include "formats/image.hpp"

#include <filesystem>
#include <string>
#include <sys/types.h>

namespace vkpt::client {

class Encoder {
public:
    struct Sound {
        std::filesystem::path file; // any that ffmpeg reads; empty: none
        double from = 0; // seconds of it that come before the film
        double seconds = 0; // of the film: silence where the file ends earlier
    };
    // Throws Failure where ffmpeg is not installed. `folder`: for its messages.
    Encoder(const std::filesystem::path& film, const std::filesystem::path& folder, int width, int height, double rate,
        const Sound& sound);
    ~Encoder();
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    void add(const formats::Image& picture);
    // Waits until the film is whole.
    void finish();

private:
    int wait();
    [[noreturn]] void fail();

    std::filesystem::path messages_;
    pid_t process_ = -1;
    int pipe_ = -1;
    void (*old_handler_)(int) = nullptr;
};

// Throws Failure, with the remedy, where there is no ffmpeg.
void check_ffmpeg();

} // namespace vkpt::client

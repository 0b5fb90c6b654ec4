// SPDX-License-Identifier: GPL-2.0-or-later
// recording_clock.so, preloaded into an engine that records: on the engine's own thread time passes with the frames
// that are recorded, not with the clock on the wall. So console lines over the picture, films and whatever else goes by
// time come and go as they would for somebody who watches, and each time at the same frame.
#include <atomic>
#include <cstdint>
#include <ctime>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

namespace {

constexpr int64_t second = 1'000'000'000; // nanoseconds, as all times here
// What loops and waits for time to pass must not wait for ever.
constexpr int64_t step_of_a_call = 100;
// Of no meaning, but the same in every recording: 1997-12-09, noon.
constexpr int64_t start_of_date = 881'668'800 * second;
constexpr int64_t start_of_uptime = 1000 * second;

std::atomic<int64_t> now { 0 }; // since the start
int64_t last_frame = 0;

bool is_engines_thread() { return syscall(SYS_gettid) == getpid(); }
int64_t tick() { return now.fetch_add(step_of_a_call) + step_of_a_call; }

bool is_faked(clockid_t clock)
{
    switch (clock) {
    case CLOCK_REALTIME:
    case CLOCK_REALTIME_COARSE:
    case CLOCK_MONOTONIC:
    case CLOCK_MONOTONIC_COARSE:
    case CLOCK_MONOTONIC_RAW:
    case CLOCK_BOOTTIME:
        return is_engines_thread();
    default:
        return false;
    }
}

int64_t read_clock(clockid_t clock)
{
    return tick() + (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE ? start_of_date : start_of_uptime);
}

} // namespace

extern "C" {

// ref_record.so calls it at every frame.
[[gnu::visibility("default")]] void vkpt_advance_clock(int64_t microseconds)
{
    last_frame += microseconds * 1000;
    if (now < last_frame)
        now = last_frame;
    else
        last_frame = now; // something has waited for longer than a frame
}

[[gnu::visibility("default")]] int clock_gettime(clockid_t clock, timespec* time) noexcept
{
    if (!is_faked(clock))
        return int(syscall(SYS_clock_gettime, clock, time));
    const int64_t read = read_clock(clock);
    *time = { time_t(read / second), long(read % second) };
    return 0;
}

[[gnu::visibility("default")]] time_t time(time_t* result) noexcept
{
    timespec read {};
    clock_gettime(CLOCK_REALTIME, &read);
    if (result)
        *result = read.tv_sec;
    return read.tv_sec;
}

[[gnu::visibility("default")]] int gettimeofday(timeval* __restrict result, void* __restrict) noexcept
{
    timespec read {};
    clock_gettime(CLOCK_REALTIME, &read);
    *result = { read.tv_sec, read.tv_nsec / 1000 };
    return 0;
}

} // extern "C"

// SPDX-License-Identifier: GPL-2.0-or-later
// Ends a fuzzing program whose input takes too much CPU time. libFuzzer's own limit goes by the clock on the wall,
// which a busy machine exceeds with any input. Linked with --wrap=LLVMFuzzerTestOneInput.
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <sys/time.h>

namespace {

// Between once and twice this is the limit: sanitizers take two to five times as long as a release build, which has 5
// s.
constexpr long tick_seconds = 10;

std::atomic<uint64_t> runs { 0 }, runs_at_tick { UINT64_MAX };
std::atomic<bool> is_running { false };

void check_progress(int)
{
    if (is_running && runs == runs_at_tick) {
        std::fputs("broken promise: an input takes no more than seconds of CPU time\n", stderr);
        std::abort();
    }
    runs_at_tick = runs.load();
}

bool start_watch()
{
    std::signal(SIGPROF, check_progress);
    itimerval timer {};
    timer.it_value.tv_sec = timer.it_interval.tv_sec = tick_seconds;
    return setitimer(ITIMER_PROF, &timer, nullptr) == 0;
}

} // namespace

extern "C" int __real_LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

extern "C" int __wrap_LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    static const bool watched = start_watch();
    (void)watched;
    runs++;
    is_running = true;
    const int result = __real_LLVMFuzzerTestOneInput(data, size);
    is_running = false;
    return result;
}

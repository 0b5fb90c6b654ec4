// SPDX-License-Identifier: GPL-2.0-or-later
// pt_times: how long each pass took over many frames.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

class PassStatistics {
public:
    static constexpr size_t kept = 4096; // samples of a pass

    void add(std::string_view name, double milliseconds);
    bool empty() const { return passes_.empty(); }
    void clear() { passes_.clear(); }

    struct Pass {
        std::string name;
        std::vector<float> milliseconds; // one a frame, oldest first: the last `kept` at least, twice as many at most
    };
    // In the order in which they came first.
    const std::vector<Pass>& passes() const { return passes_; }

private:
    std::vector<Pass> passes_;
};

// Adds the time from its making to its end of life under `name`, less what timers inside took. On the engine's thread.
class CpuTimer {
public:
    explicit CpuTimer(const char* name)
        : name_(name)
        , outer_(innermost_)
    {
        innermost_ = this;
    }
    CpuTimer(const CpuTimer&) = delete;
    CpuTimer& operator=(const CpuTimer&) = delete;
    ~CpuTimer();

    // Where the times go from now on; nullptr: nobody wants to know.
    static void collect_into(PassStatistics* statistics) { statistics_ = statistics; }

private:
    using Clock = std::chrono::steady_clock;

    static inline PassStatistics* statistics_ = nullptr;
    static inline CpuTimer* innermost_ = nullptr;
    const char* name_;
    CpuTimer* outer_;
    Clock::time_point start_ = Clock::now();
    Clock::duration inside_ {};
};

} // namespace vkpt

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
    void add(std::string_view name, double milliseconds);
    // One console line a pass, in the order in which they came first.
    void print() const;
    bool empty() const { return passes_.empty(); }

private:
    struct Pass {
        std::string name;
        std::vector<float> milliseconds;
    };
    std::vector<Pass> passes_;
};

// Adds the time from its making to its end of life under `name`; nullptr: nobody wants to know.
class CpuTimer {
public:
    CpuTimer(PassStatistics* statistics, const char* name)
        : statistics_(statistics)
        , name_(name)
        , start_(std::chrono::steady_clock::now())
    {
    }
    CpuTimer(const CpuTimer&) = delete;
    CpuTimer& operator=(const CpuTimer&) = delete;
    ~CpuTimer()
    {
        if (statistics_)
            statistics_->add(
                name_, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count());
    }

private:
    PassStatistics* statistics_;
    const char* name_;
    std::chrono::steady_clock::time_point start_;
};

} // namespace vkpt

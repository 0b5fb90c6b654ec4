// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace vkpt::tools {

// Calls work(i) for every i < count, on `threads` threads. The first exception is passed on.
template <class Work> void parallel_for(size_t count, int threads, const Work& work)
{
    std::atomic<size_t> next { 0 };
    std::exception_ptr failure;
    std::mutex mutex;
    const auto run = [&] {
        try {
            for (size_t i = next++; i < count; i = next++)
                work(i);
        } catch (...) {
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
            next = count;
        }
    };
    {
        std::vector<std::jthread> others;
        for (int i = 1; i < threads; i++)
            others.emplace_back(run);
        run();
    }
    if (failure)
        std::rethrow_exception(failure);
}

} // namespace vkpt::tools

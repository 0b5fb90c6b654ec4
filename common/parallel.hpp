// SPDX-License-Identifier: GPL-2.0-or-later
// Independent pieces of work on several threads, which are made for them; ref_vkpt/workers.hpp keeps threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace vkpt {

inline unsigned core_count() { return std::max(1u, std::thread::hardware_concurrency()); }

// Calls work(i) for every i < count, on `threads` threads, the caller's among them. The first exception is passed on,
// and what had not begun by then is left out.
template <class Work> void parallel_for(size_t count, unsigned threads, const Work& work)
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
            if (!failure)
                failure = std::current_exception();
            next = count;
        }
    };
    {
        std::vector<std::jthread> others;
        for (unsigned i = 1; i < threads; i++)
            others.emplace_back(run);
        run();
    }
    if (failure)
        std::rethrow_exception(failure);
}

} // namespace vkpt

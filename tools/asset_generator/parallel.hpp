// SPDX-License-Identifier: GPL-2.0-or-later
// Independent pieces of work on all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace vkpt::tools {

// work(i) for each i in [0, count), in any order; rethrows one of the exceptions, if any.
template <class Work> void for_each_index(size_t count, Work work)
{
    std::atomic<size_t> next = 0;
    std::exception_ptr failure;
    std::mutex failure_lock;
    const auto run = [&] {
        for (size_t i = next++; i < count; i = next++) {
            try {
                work(i);
            } catch (...) {
                const std::scoped_lock guard(failure_lock);
                failure = std::current_exception();
            }
        }
    };
    {
        std::vector<std::jthread> threads;
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); i++)
            threads.emplace_back(run);
    }
    if (failure)
        std::rethrow_exception(failure);
}

} // namespace vkpt::tools

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/workers.hpp"

#include <algorithm>

namespace vkpt {

// Beyond that, memory is what limits the work of a frame.
constexpr unsigned max_threads = 8;

Workers::Workers(unsigned threads)
{
    if (threads == 0)
        threads = std::clamp(std::thread::hardware_concurrency(), 1u, max_threads);
    for (unsigned i = 1; i < threads; i++)
        threads_.emplace_back([this, i] { run_thread(i); });
}

Workers::~Workers()
{
    {
        const std::lock_guard lock(mutex_);
        stops_ = true;
    }
    work_is_there_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
}

void Workers::parallel_for(size_t count, const Work& work)
{
    std::unique_lock lock(mutex_);
    work_ = &work;
    next_ = 0;
    count_ = count;
    error_ = nullptr;
    if (count > 1)
        work_is_there_.notify_all();
    take_items(lock, 0);
    work_is_done_.wait(lock, [this] { return running_ == 0; });
    work_ = nullptr;
    if (error_)
        std::rethrow_exception(error_);
}

void Workers::run_thread(size_t thread)
{
    std::unique_lock lock(mutex_);
    for (;;) {
        work_is_there_.wait(lock, [this] { return stops_ || next_ < count_; });
        if (stops_)
            return;
        take_items(lock, thread);
        if (running_ == 0)
            work_is_done_.notify_one();
    }
}

// Takes one item after the other until none is left.
void Workers::take_items(std::unique_lock<std::mutex>& lock, size_t thread)
{
    running_++;
    while (next_ < count_) {
        const size_t item = next_++;
        lock.unlock();
        std::exception_ptr error;
        try {
            (*work_)(item, thread);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        if (error) {
            next_ = count_;
            if (!error_)
                error_ = error;
        }
    }
    running_--;
}

} // namespace vkpt

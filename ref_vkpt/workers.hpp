// SPDX-License-Identifier: GPL-2.0-or-later
// Threads that wait for pieces of a frame's work.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace vkpt {

class Workers {
public:
    // `threads`: those that work, the caller's among them; 0: as many as the machine has, within reason.
    explicit Workers(unsigned threads = 0);
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    unsigned thread_count() const { return unsigned(threads_.size()) + 1; }

    // Of an item and of a thread: 0, the caller's, up to thread_count() - 1.
    using Work = std::function<void(size_t item, size_t thread)>;
    // Calls `work` for the items 0 .. count - 1 in about that order, several at once, and returns when all have
    // returned. The first exception goes to the caller; calls that had not begun by then are left out. Not for use
    // within `work`.
    void parallel_for(size_t count, const Work& work);

private:
    void run_thread(size_t thread);
    void take_items(std::unique_lock<std::mutex>& lock, size_t thread);

    std::vector<std::thread> threads_;
    std::mutex mutex_; // of everything below
    std::condition_variable work_is_there_, work_is_done_;
    const Work* work_ = nullptr;
    size_t next_ = 0, count_ = 0, running_ = 0;
    std::exception_ptr error_;
    bool stops_ = false;
};

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// Compiles the shaders of the coming frames on threads of its own while the engine loads a map.
//
// Most drivers compile when a pipeline is made. Mesa's CPU driver compiles at the first dispatch, on its queue's one
// thread, which takes many seconds for all passes of a frame. So each thread here also has a queue of its own, on
// another logical device, and dispatches nothing there: what comes out lies in the driver's cache on disk, where the
// frame's own dispatch finds it.
#pragma once

#include "ref_vkpt/vulkan/pipelines.hpp"

#include <atomic>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace vkpt {

class ShaderWarmUp {
public:
    // Starts with the first of `shaders` (names of compute shaders, see find_shader). The other two outlive this.
    ShaderWarmUp(const Device& device, Pipelines& pipelines, std::vector<std::string> shaders);
    // Leaves out what has not begun.
    ~ShaderWarmUp();
    ShaderWarmUp(const ShaderWarmUp&) = delete;
    ShaderWarmUp& operator=(const ShaderWarmUp&) = delete;

    // Until all are done.
    void wait();

private:
    void run_thread();
    void read_compiled();
    bool is_compiled(const std::string& key);
    void add_compiled(const std::string& key);
    std::string key_of(const std::string& shader) const;

    const Device& device_;
    Pipelines& pipelines_;
    const std::vector<std::string> shaders_;
    std::atomic<size_t> next_ = 0;
    // A line for each shader that the driver's cache holds: its key. Empty: the driver does not compile at the
    // dispatch.
    std::string compiled_file_;
    std::mutex mutex_; // of the next
    std::set<std::string> compiled_;
    std::vector<std::thread> threads_;
};

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// Shader modules and pipelines by name, made when first asked for; the driver's pipeline cache is kept on disk.
#pragma once

#include "ref_vkpt/vulkan/bindings.hpp"
#include "ref_vkpt/vulkan/shaders.hpp"

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vkpt {

// A ray generation shader with the shared trace shaders, and its shader binding table of one record a kind.
struct RayPipeline {
    VkPipeline handle = VK_NULL_HANDLE;
    Buffer table;
    VkStridedDeviceAddressRegionKHR generation {}, miss {}, hit {}, callable {};
};

class Pipelines {
public:
    // `cache_file`: where the pipeline cache lives; empty: nowhere.
    Pipelines(const Gpu& gpu, const Bindings& bindings, std::string cache_file);
    ~Pipelines();
    Pipelines(const Pipelines&) = delete;
    Pipelines& operator=(const Pipelines&) = delete;

    // From any thread. Waits where another one is making it.
    VkPipeline compute(std::string_view shader);
    // `shader`: the ray generation one.
    const RayPipeline& ray(std::string_view shader);
    // All that there are, by shader.
    std::vector<std::pair<std::string, VkPipeline>> all();
    // The shaders of all pipelines that there are.
    std::vector<std::string> used_shaders();
    // From now on `shader` has this code. `finish` waits for the device and is called where a pipeline is made anew.
    // False: it has that code already. What fails is thrown, and leaves all as it was. On the thread that calls ray().
    bool replace(const std::string& shader, const std::vector<uint32_t>& code, const std::function<void()>& finish);
    VkPipelineCache cache() const { return cache_; }

private:
    void save_cache() const;
    std::vector<uint32_t> code_of(std::string_view shader);
    VkShaderModule make_module(std::string_view shader);
    VkPipeline make_compute_pipeline(std::string_view shader);
    VkPipeline make_ray_pipeline(std::string_view shader);
    void fill_table(RayPipeline& pipeline) const;

    Gpu gpu_;
    const Bindings& bindings_;
    std::string cache_file_;
    VkPipelineCache cache_ = VK_NULL_HANDLE;
    std::mutex mutex_; // of the three below
    std::map<std::string, std::vector<uint32_t>, std::less<>> replaced_; // shaders with other code than the build's
    std::condition_variable one_is_made_;
    std::map<std::string, VkPipeline, std::less<>> compute_; // VK_NULL_HANDLE: a thread is making it
    std::map<std::string, RayPipeline, std::less<>> ray_;
};

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// Shader modules and pipelines by name, made when first asked for; the driver's pipeline cache is kept on disk.
#pragma once

#include "ref_vkpt/vulkan/bindings.hpp"
#include "ref_vkpt/vulkan/shaders.hpp"
#include "shaders/shared/specialization.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vkpt {

// A ray generation shader with the shared trace shaders, and its shader binding table of one record a kind.
struct RayPipeline {
    Pipeline handle;
    Buffer table;
    VkStridedDeviceAddressRegionKHR generation {}, miss {}, hit {}, callable {};
};

// Settings that shaders are compiled for (shared/specialization.h); NOT_FIXED: they read them in every frame.
struct FixedChoices {
    int light_weight = shared::NOT_FIXED, light_point = shared::NOT_FIXED, bounces = shared::NOT_FIXED,
        indirect = shared::NOT_FIXED, screens = shared::NOT_FIXED;
    bool operator==(const FixedChoices&) const = default;
};

class Pipelines {
public:
    // `cache_file`: where the pipeline cache lives; empty: nowhere.
    Pipelines(const Gpu& gpu, const Bindings& bindings, std::string cache_file);
    ~Pipelines();
    Pipelines(const Pipelines&) = delete;
    Pipelines& operator=(const Pipelines&) = delete;

    // From now on the shaders that know these settings are compiled for them. A pipeline for other settings goes on
    // until the new one is ready, which is made beside the frames; with `at_once` it is waited for. None of them may
    // have been replaced.
    void fix(const FixedChoices& choices, bool at_once);
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
    // How many there have been.
    uint64_t made() const { return made_; }

private:
    void save_cache() const;
    std::vector<uint32_t> code_of(std::string_view shader);
    ShaderModule make_module(std::string_view shader);
    bool knows_choices(std::string_view shader);
    std::string key_of(std::string_view shader, const FixedChoices& choices);
    template <class Made, class Make>
    const Made* find_older(std::unique_lock<std::mutex>& lock, std::map<std::string, Made, std::less<>>& made,
        std::string_view shader, const std::string& key, const Make& make);
    Pipeline keep(VkPipeline made, std::string_view shader);
    Pipeline make_compute_pipeline(std::string_view shader, const FixedChoices& choices);
    Pipeline make_ray_pipeline(std::string_view shader, const FixedChoices& choices);
    void fill_table(RayPipeline& pipeline) const;

    Gpu gpu_;
    const Bindings& bindings_;
    std::string cache_file_;
    Handle<VkPipelineCache, vkDestroyPipelineCache> cache_;
    std::atomic<uint64_t> made_ = 0;
    std::mutex mutex_; // of all below
    FixedChoices choices_;
    bool at_once_ = true;
    std::map<std::string, bool, std::less<>> knows_choices_; // by shader
    std::map<std::string, std::string, std::less<>> latest_; // the key that a shader was last used by
    // By key: the shader's name, and behind a # the settings that it is compiled for.
    std::map<std::string, std::vector<uint32_t>, std::less<>> replaced_; // shaders with other code than the build's
    std::condition_variable one_is_made_;
    std::map<std::string, Pipeline, std::less<>> compute_; // empty: a thread is making it
    std::map<std::string, RayPipeline, std::less<>> ray_;
    // The last one here, as destroying it waits for threads that use all of this.
    std::map<std::string, std::future<Pipeline>, std::less<>> under_way_;
};

} // namespace vkpt

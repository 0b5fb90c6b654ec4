// SPDX-License-Identifier: GPL-2.0-or-later
// Shader modules and compute pipelines by name, made when first asked for; the driver's pipeline cache is kept on disk.
#pragma once

#include "ref_vkpt/vulkan/bindings.hpp"
#include "ref_vkpt/vulkan/shaders.hpp"

#include <map>
#include <string>
#include <string_view>

namespace vkpt {

class Pipelines {
public:
    // `cache_file`: where the pipeline cache lives; empty: nowhere.
    Pipelines(const Gpu& gpu, const Bindings& bindings, std::string cache_file);
    ~Pipelines();
    Pipelines(const Pipelines&) = delete;
    Pipelines& operator=(const Pipelines&) = delete;

    VkPipeline compute(std::string_view shader);
    // The caller destroys the module.
    VkShaderModule make_module(std::string_view shader) const;
    VkPipelineCache cache() const { return cache_; }

private:
    void save_cache() const;

    Gpu gpu_;
    const Bindings& bindings_;
    std::string cache_file_;
    VkPipelineCache cache_ = VK_NULL_HANDLE;
    std::map<std::string, VkPipeline, std::less<>> compute_;
};

} // namespace vkpt

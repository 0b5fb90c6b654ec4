// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/pipelines.hpp"

#include "ref_vkpt/engine/errors.hpp"

#include <cassert>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <unistd.h>
#include <vector>

namespace vkpt {

namespace {

std::vector<char> read_file(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return { std::istreambuf_iterator<char>(file), {} };
}

} // namespace

Pipelines::Pipelines(const Gpu& gpu, const Bindings& bindings, std::string cache_file)
    : gpu_(gpu), bindings_(bindings), cache_file_(std::move(cache_file))
{
    // Drivers check the header of what they are given and ignore a foreign cache.
    const std::vector<char> stored = cache_file_.empty() ? std::vector<char>() : read_file(cache_file_);
    VkPipelineCacheCreateInfo info { VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO };
    info.initialDataSize = stored.size();
    info.pInitialData = stored.data();
    VKPT_CHECK(vkCreatePipelineCache(gpu.device.handle, &info, nullptr, &cache_));
}

Pipelines::~Pipelines()
{
    save_cache();
    for (auto& [name, pipeline] : compute_)
        vkDestroyPipeline(gpu_.device.handle, pipeline, nullptr);
    vkDestroyPipelineCache(gpu_.device.handle, cache_, nullptr);
}

VkShaderModule Pipelines::make_module(std::string_view shader) const
{
    const std::span<const uint32_t> code = find_shader(shader);
    if (code.empty())
        throw FatalError(fmt::format("shader {} is not part of this build", shader));
    VkShaderModuleCreateInfo info { VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO };
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    VkShaderModule module = VK_NULL_HANDLE;
    VKPT_CHECK(vkCreateShaderModule(gpu_.device.handle, &info, nullptr, &module));
    return module;
}

VkPipeline Pipelines::compute(std::string_view shader)
{
    if (auto found = compute_.find(shader); found != compute_.end())
        return found->second;
    const VkShaderModule module = make_module(shader);
    VkComputePipelineCreateInfo info { VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO };
    info.layout = bindings_.pipeline_layout();
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = vkCreateComputePipelines(gpu_.device.handle, cache_, 1, &info, nullptr, &pipeline);
    vkDestroyShaderModule(gpu_.device.handle, module, nullptr);
    check_vulkan(result, "vkCreateComputePipelines");
    gpu_.device.name_object(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(pipeline), shader);
    compute_.emplace(shader, pipeline);
    return pipeline;
}

void Pipelines::save_cache() const
{
    size_t size = 0;
    if (cache_file_.empty() || vkGetPipelineCacheData(gpu_.device.handle, cache_, &size, nullptr) != VK_SUCCESS)
        return;
    std::vector<char> data(size);
    if (vkGetPipelineCacheData(gpu_.device.handle, cache_, &size, data.data()) != VK_SUCCESS)
        return;
    // Written beside and renamed, so that a cut write never leaves half a cache. A cache that cannot be written is no error.
    // By process: several may share the folder.
    const std::string partial = fmt::format("{}.{}.new", cache_file_, getpid());
    std::ofstream file(partial, std::ios::binary);
    file.write(data.data(), std::streamsize(size));
    file.close();
    std::error_code ignored;
    if (file)
        std::filesystem::rename(partial, cache_file_, ignored);
    else
        std::filesystem::remove(partial, ignored);
}

} // namespace vkpt

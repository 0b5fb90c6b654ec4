// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/pipelines.hpp"

#include "ref_vkpt/engine/errors.hpp"
#include "ref_vkpt/files/pipeline_cache_file.hpp"
#include "shaders/shared/texels.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <unistd.h>
#include <utility>
#include <vector>

namespace vkpt {

namespace {

std::string read_file(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return { std::istreambuf_iterator<char>(file), {} };
}

// The stages of a ray tracing pipeline, and its groups in the order of the shader binding table.
enum RayStage : uint32_t { stage_generation, stage_miss, stage_closest_hit, stage_any_hit, stage_count };
constexpr std::string_view shared_stages[] = { "trace.rmiss", "trace.rchit", "trace.rahit" };
enum RayGroup : uint32_t { group_generation, group_miss, group_hit, group_count };

// Of lib/device: whether tables are read as texels, and whether lanes are those of GPUs; and the fixed choices.
class Specialization {
public:
    Specialization(const Device& device, const FixedChoices& choices)
        : values_ { device.reads_texels() ? VK_TRUE : VK_FALSE, choices.light_weight, choices.light_point,
            choices.bounces, choices.indirect, choices.screens, device.traits.gpu_lanes ? VK_TRUE : VK_FALSE }
    {
    }
    Specialization(const Specialization&) = delete;
    const VkSpecializationInfo* info() const { return &info_; }

private:
    struct Values {
        VkBool32 as_texels;
        int32_t light_weight, light_point, bounces, indirect, screens;
        VkBool32 gpu_lanes;
    } const values_;
    static constexpr VkSpecializationMapEntry entries_[] = {
        { shared::TEXELS_CONSTANT, offsetof(Values, as_texels), sizeof(VkBool32) },
        { shared::LIGHT_WEIGHT_CONSTANT, offsetof(Values, light_weight), sizeof(int32_t) },
        { shared::LIGHT_POINT_CONSTANT, offsetof(Values, light_point), sizeof(int32_t) },
        { shared::BOUNCES_CONSTANT, offsetof(Values, bounces), sizeof(int32_t) },
        { shared::INDIRECT_CONSTANT, offsetof(Values, indirect), sizeof(int32_t) },
        { shared::SCREENS_CONSTANT, offsetof(Values, screens), sizeof(int32_t) },
        { shared::GPU_LANES_CONSTANT, offsetof(Values, gpu_lanes), sizeof(VkBool32) },
    };
    const VkSpecializationInfo info_ { uint32_t(std::size(entries_)), entries_, sizeof values_, &values_ };
};

// Whether SPIR-V declares the specialization constant: OpDecorate with SpecId.
bool declares_constant(std::span<const uint32_t> code, uint32_t constant)
{
    constexpr uint32_t header_words = 5, op_decorate = 71, decoration_spec_id = 1;
    for (size_t at = header_words; at < code.size() && code[at] >> 16 > 0; at += code[at] >> 16)
        if ((code[at] & 0xffff) == op_decorate && code[at] >> 16 == 4 && at + 3 < code.size()
            && code[at + 2] == decoration_spec_id && code[at + 3] == constant)
            return true;
    return false;
}

std::string shader_of_key(std::string_view key) { return std::string(key.substr(0, key.find('#'))); }

Pipeline& handle_of(Pipeline& pipeline) { return pipeline; }
Pipeline& handle_of(RayPipeline& pipeline) { return pipeline.handle; }

VkPipelineCreateFlags pipeline_flags(const Device& device)
{
    return device.has_pipeline_statistics ? VkPipelineCreateFlags(VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR) : 0;
}

VkRayTracingShaderGroupCreateInfoKHR make_group(uint32_t general, uint32_t closest_hit, uint32_t any_hit)
{
    VkRayTracingShaderGroupCreateInfoKHR group { VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR };
    group.type = general == VK_SHADER_UNUSED_KHR ? VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR
                                                 : VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR;
    group.generalShader = general;
    group.closestHitShader = closest_hit;
    group.anyHitShader = any_hit;
    group.intersectionShader = VK_SHADER_UNUSED_KHR;
    return group;
}

} // namespace

Pipelines::Pipelines(const Gpu& gpu, const Bindings& bindings, std::string cache_file)
    : gpu_(gpu)
    , bindings_(bindings)
    , cache_file_(std::move(cache_file))
{
    const std::string file = cache_file_.empty() ? std::string() : read_file(cache_file_);
    const std::span stored = read_pipeline_cache(gpu.device.identity, std::as_bytes(std::span(file)));
    VkPipelineCacheCreateInfo info { VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO };
    info.initialDataSize = stored.size();
    info.pInitialData = stored.data();
    VKPT_RENEW(cache_, vkCreatePipelineCache, gpu.device.handle, info);
}

Pipelines::~Pipelines() { save_cache(); }

std::vector<uint32_t> Pipelines::code_of(std::string_view shader)
{
    const std::scoped_lock lock(mutex_);
    if (const auto replaced = replaced_.find(shader); replaced != replaced_.end())
        return replaced->second;
    const std::span<const uint32_t> built = find_shader(shader);
    return { built.begin(), built.end() };
}

ShaderModule Pipelines::make_module(std::string_view shader)
{
    const std::vector<uint32_t> code = code_of(shader);
    if (code.empty())
        throw FatalError(fmt::format("shader {} is not part of this build", shader));
    VkShaderModuleCreateInfo info { VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO };
    info.codeSize = code.size() * sizeof(uint32_t);
    info.pCode = code.data();
    ShaderModule module;
    VKPT_RENEW(module, vkCreateShaderModule, gpu_.device.handle, info);
    return module;
}

void Pipelines::fix(const FixedChoices& choices, bool at_once)
{
    const std::scoped_lock lock(mutex_);
    choices_ = choices;
    at_once_ = at_once;
}

// With the lock.
bool Pipelines::knows_choices(std::string_view shader)
{
    const auto known = knows_choices_.find(shader);
    if (known != knows_choices_.end())
        return known->second;
    const std::span<const uint32_t> code = find_shader(shader);
    return knows_choices_
        .emplace(shader,
            declares_constant(code, shared::LIGHT_WEIGHT_CONSTANT)
                || declares_constant(code, shared::LIGHT_POINT_CONSTANT)
                || declares_constant(code, shared::BOUNCES_CONSTANT)
                || declares_constant(code, shared::INDIRECT_CONSTANT)
                || declares_constant(code, shared::SCREENS_CONSTANT))
        .first->second;
}

// With the lock.
std::string Pipelines::key_of(std::string_view shader, const FixedChoices& choices)
{
    if (choices == FixedChoices {} || !knows_choices(shader))
        return std::string(shader);
    return fmt::format("{}#{},{},{},{},{}", shader, choices.light_weight, choices.light_point, choices.bounces,
        choices.indirect, choices.screens);
}

// With the lock. What goes on in the place of `key` while that is under way, which it is from here on. nullptr: it is
// there, or has to be made now.
template <class Made, class Make>
const Made* Pipelines::find_older(std::unique_lock<std::mutex>& lock, std::map<std::string, Made, std::less<>>& made,
    std::string_view shader, const std::string& key, const Make& make)
{
    std::string& latest = latest_.try_emplace(std::string(shader), key).first->second;
    const auto older = made.find(latest);
    const bool is_there = made.contains(key), goes_on = older != made.end() && handle_of(older->second) && !at_once_;
    const auto under_way = under_way_.find(key);
    if (is_there || (!goes_on && under_way == under_way_.end())) {
        latest = key;
        return nullptr;
    }
    if (under_way == under_way_.end()) {
        under_way_.emplace(key, std::async(std::launch::async, make));
        return &older->second;
    }
    if (goes_on && under_way->second.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return &older->second;
    std::future<Pipeline> finished = std::move(under_way->second);
    under_way_.erase(under_way);
    lock.unlock(); // which making it needs
    Pipeline pipeline = finished.get();
    lock.lock();
    handle_of(made[key]) = std::move(pipeline); // a ray pipeline's table is filled where it is first used
    latest = key;
    return nullptr;
}

Pipeline Pipelines::keep(VkPipeline made, std::string_view shader)
{
    made_++;
    gpu_.device.name_object(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(made), shader);
    return { gpu_.device.handle, made };
}

Pipeline Pipelines::make_compute_pipeline(std::string_view shader, const FixedChoices& choices)
{
    const Specialization specialization(gpu_.device, choices);
    const ShaderModule module = make_module(shader);
    VkComputePipelineCreateInfo info { VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO };
    info.layout = bindings_.pipeline_layout();
    info.flags = pipeline_flags(gpu_.device);
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = specialization.info();
    VkPipeline pipeline = VK_NULL_HANDLE;
    VKPT_CHECK(vkCreateComputePipelines(gpu_.device.handle, cache_, 1, &info, nullptr, &pipeline));
    return keep(pipeline, shader);
}

VkPipeline Pipelines::compute(std::string_view shader)
{
    std::unique_lock lock(mutex_);
    const FixedChoices choices = choices_;
    const std::string key = key_of(shader, choices);
    const auto make = [this, name = std::string(shader), choices] { return make_compute_pipeline(name, choices); };
    if (const Pipeline* older = find_older(lock, compute_, shader, key, make))
        return *older;
    one_is_made_.wait(lock, [&] {
        const auto found = compute_.find(key);
        return found == compute_.end() || found->second;
    });
    if (const auto found = compute_.find(key); found != compute_.end())
        return found->second;
    const auto entry = compute_.try_emplace(key).first;
    lock.unlock();
    Pipeline pipeline;
    try {
        pipeline = make();
    } catch (...) {
        lock.lock();
        compute_.erase(entry); // whoever waits tries it, too
        one_is_made_.notify_all();
        throw;
    }
    lock.lock();
    entry->second = std::move(pipeline);
    one_is_made_.notify_all();
    return entry->second;
}

Pipeline Pipelines::make_ray_pipeline(std::string_view shader, const FixedChoices& choices)
{
    const Specialization specialization(gpu_.device, choices);
    const std::string_view names[stage_count] = { shader, shared_stages[0], shared_stages[1], shared_stages[2] };
    constexpr VkShaderStageFlagBits kinds[stage_count] = { VK_SHADER_STAGE_RAYGEN_BIT_KHR, VK_SHADER_STAGE_MISS_BIT_KHR,
        VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, VK_SHADER_STAGE_ANY_HIT_BIT_KHR };
    ShaderModule modules[stage_count];
    VkPipelineShaderStageCreateInfo stages[stage_count] {};
    for (uint32_t i = 0; i < stage_count; i++) {
        stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stages[i].stage = kinds[i];
        stages[i].module = modules[i] = make_module(names[i]);
        stages[i].pName = "main";
        stages[i].pSpecializationInfo = specialization.info();
    }
    VkRayTracingShaderGroupCreateInfoKHR groups[group_count];
    groups[group_generation] = make_group(stage_generation, VK_SHADER_UNUSED_KHR, VK_SHADER_UNUSED_KHR);
    groups[group_miss] = make_group(stage_miss, VK_SHADER_UNUSED_KHR, VK_SHADER_UNUSED_KHR);
    groups[group_hit] = make_group(VK_SHADER_UNUSED_KHR, stage_closest_hit, stage_any_hit);
    VkRayTracingPipelineCreateInfoKHR info { VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR };
    info.flags = pipeline_flags(gpu_.device);
    info.stageCount = stage_count;
    info.pStages = stages;
    info.groupCount = group_count;
    info.pGroups = groups;
    info.maxPipelineRayRecursionDepth = 1; // only ray generation shaders trace
    info.layout = bindings_.pipeline_layout();
    VkPipeline pipeline = VK_NULL_HANDLE;
    VKPT_CHECK(
        vkCreateRayTracingPipelinesKHR(gpu_.device.handle, VK_NULL_HANDLE, cache_, 1, &info, nullptr, &pipeline));
    return keep(pipeline, shader);
}

void Pipelines::fill_table(RayPipeline& pipeline) const
{
    const uint32_t bytes = gpu_.device.shader_group_bytes;
    const VkDeviceSize alignment = std::max(gpu_.device.shader_table_alignment, gpu_.device.shader_group_alignment);
    const VkDeviceSize stride = (bytes + alignment - 1) / alignment * alignment;
    std::vector<std::byte> handles(size_t(bytes) * group_count);
    VKPT_CHECK(vkGetRayTracingShaderGroupHandlesKHR(
        gpu_.device.handle, pipeline.handle, 0, group_count, handles.size(), handles.data()));
    pipeline.table = Buffer(
        gpu_, stride * group_count + alignment, BufferHome::upload, MemoryKind::acceleration, "shader binding table");
    const VkDeviceAddress start = (pipeline.table.address() + alignment - 1) / alignment * alignment;
    std::byte* mapped = pipeline.table.mapped() + (start - pipeline.table.address());
    VkStridedDeviceAddressRegionKHR* regions[group_count] = { &pipeline.generation, &pipeline.miss, &pipeline.hit };
    for (uint32_t group = 0; group < group_count; group++) {
        std::memcpy(mapped + group * stride, &handles[size_t(group) * bytes], bytes);
        *regions[group] = { start + group * stride, stride, stride };
    }
}

const RayPipeline& Pipelines::ray(std::string_view shader)
{
    std::unique_lock lock(mutex_);
    const FixedChoices choices = choices_;
    const std::string key = key_of(shader, choices);
    const auto make = [this, name = std::string(shader), choices] { return make_ray_pipeline(name, choices); };
    if (const RayPipeline* older = find_older(lock, ray_, shader, key, make))
        return *older;
    lock.unlock();
    if (const auto found = ray_.find(key); found != ray_.end()) {
        if (!found->second.table)
            fill_table(found->second);
        return found->second;
    }
    RayPipeline pipeline;
    pipeline.handle = make();
    RayPipeline& kept = ray_.emplace(key, std::move(pipeline)).first->second;
    fill_table(kept);
    return kept;
}

std::vector<std::pair<std::string, VkPipeline>> Pipelines::all()
{
    const std::scoped_lock lock(mutex_);
    std::vector<std::pair<std::string, VkPipeline>> pipelines;
    for (const auto& [shader, pipeline] : compute_)
        if (pipeline)
            pipelines.emplace_back(shader_of_key(shader), pipeline);
    for (const auto& [shader, pipeline] : ray_)
        pipelines.emplace_back(shader_of_key(shader), pipeline.handle);
    return pipelines;
}

std::vector<std::string> Pipelines::used_shaders()
{
    const std::scoped_lock lock(mutex_);
    std::vector<std::string> shaders;
    for (const auto& [key, pipeline] : compute_)
        shaders.push_back(shader_of_key(key));
    for (const auto& [key, pipeline] : ray_)
        shaders.push_back(shader_of_key(key));
    if (!ray_.empty())
        shaders.insert(shaders.end(), std::begin(shared_stages), std::end(shared_stages));
    return shaders;
}

bool Pipelines::replace(
    const std::string& shader, const std::vector<uint32_t>& code, const std::function<void()>& finish)
{
    const std::vector<uint32_t> before = code_of(shader);
    if (before == code)
        return false;
    std::unique_lock lock(mutex_);
    one_is_made_.wait(lock, [&] { return !compute_.contains(shader) || compute_[shader]; });
    const bool is_computed = compute_.contains(shader), is_shared = std::ranges::count(shared_stages, shader) > 0;
    replaced_[shader] = code;
    lock.unlock();
    Pipeline computed;
    std::map<std::string, RayPipeline> traced;
    try {
        if (is_computed)
            computed = make_compute_pipeline(shader, {});
        for (const auto& [name, pipeline] : ray_)
            if (is_shared || name == shader) {
                traced[name].handle = make_ray_pipeline(name, {});
                fill_table(traced[name]);
            }
    } catch (...) {
        lock.lock();
        replaced_[shader] = before;
        throw;
    }
    finish();
    for (auto& [name, pipeline] : traced)
        ray_[name] = std::move(pipeline);
    if (is_computed) {
        lock.lock();
        compute_[shader] = std::move(computed);
    }
    return true;
}

void Pipelines::save_cache() const
{
    size_t size = 0;
    if (cache_file_.empty() || vkGetPipelineCacheData(gpu_.device.handle, cache_, &size, nullptr) != VK_SUCCESS)
        return;
    std::vector<std::byte> data(size);
    if (vkGetPipelineCacheData(gpu_.device.handle, cache_, &size, data.data()) != VK_SUCCESS)
        return;
    data.resize(size);
    const std::vector<std::byte> bytes = write_pipeline_cache(gpu_.device.identity, data);
    // Written beside and renamed, so that a cut write never leaves half a cache. A cache that cannot be written is no
    // error. By process: several may share the folder.
    const std::string partial = fmt::format("{}.{}.new", cache_file_, getpid());
    std::ofstream file(partial, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    file.close();
    std::error_code ignored;
    if (file)
        std::filesystem::rename(partial, cache_file_, ignored);
    else
        std::filesystem::remove(partial, ignored);
}

} // namespace vkpt

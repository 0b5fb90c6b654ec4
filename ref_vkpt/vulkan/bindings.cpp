// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/bindings.hpp"

#include "ref_vkpt/engine/errors.hpp"
#include "shaders/shared/frame.h"
#include "shaders/shared/texels.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>
#include <span>

namespace vkpt {

namespace {

// More than any mod registers; devices that cannot do as many get what they can.
constexpr uint32_t wanted_textures = 8192;

enum FrameBinding : uint32_t { binding_uniforms, binding_samplers };
constexpr uint32_t binding_textures = 0;

DescriptorSetLayout make_layout(VkDevice device, VkDescriptorSetLayoutCreateFlags flags, const void* next,
    std::span<const VkDescriptorSetLayoutBinding> bindings)
{
    VkDescriptorSetLayoutCreateInfo info { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, next };
    info.flags = flags;
    info.bindingCount = uint32_t(bindings.size());
    info.pBindings = bindings.data();
    DescriptorSetLayout layout;
    VKPT_RENEW(layout, vkCreateDescriptorSetLayout, device, info);
    return layout;
}

} // namespace

DescriptorPool make_descriptor_pool(
    VkDevice device, VkDescriptorPoolCreateFlags flags, uint32_t sets, std::span<const VkDescriptorPoolSize> sizes)
{
    VkDescriptorPoolCreateInfo info { VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO };
    info.flags = flags;
    info.maxSets = sets;
    info.poolSizeCount = uint32_t(sizes.size());
    info.pPoolSizes = sizes.data();
    DescriptorPool pool;
    VKPT_RENEW(pool, vkCreateDescriptorPool, device, info);
    return pool;
}

VkDescriptorSet make_descriptor_set(VkDevice device, VkDescriptorPool pool, VkDescriptorSetLayout layout)
{
    VkDescriptorSetAllocateInfo info { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO };
    info.descriptorPool = pool;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    VKPT_CHECK(vkAllocateDescriptorSets(device, &info, &set));
    return set;
}

Bindings::Bindings(const Gpu& gpu)
    : gpu_(gpu)
    , max_textures_(std::min(wanted_textures, gpu.device.max_textures))
{
    create_samplers();
    create_layouts();
    create_sets();
}

void Bindings::create_samplers()
{
    struct Row {
        VkFilter filter;
        VkSamplerAddressMode address;
    };
    Row rows[shared::SAMPLER_COUNT];
    rows[shared::SAMPLER_REPEAT] = { VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT };
    rows[shared::SAMPLER_CLAMP] = { VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE };
    rows[shared::SAMPLER_REPEAT_NEAREST] = { VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT };
    rows[shared::SAMPLER_CLAMP_NEAREST] = { VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE };
    for (const Row& row : rows) {
        VkSamplerCreateInfo info { VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO };
        info.magFilter = info.minFilter = row.filter;
        info.mipmapMode
            = row.filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
        info.addressModeU = info.addressModeV = info.addressModeW = row.address;
        info.maxLod = VK_LOD_CLAMP_NONE;
        VKPT_RENEW(samplers_.emplace_back(), vkCreateSampler, gpu_.device.handle, info);
    }
}

void Bindings::create_layouts()
{
    const VkDevice device = gpu_.device.handle;
    const std::vector<VkSampler> samplers(samplers_.begin(), samplers_.end());
    const VkDescriptorSetLayoutBinding frame[] = {
        { binding_uniforms, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1, VK_SHADER_STAGE_ALL, nullptr },
        { binding_samplers, VK_DESCRIPTOR_TYPE_SAMPLER, shared::SAMPLER_COUNT, VK_SHADER_STAGE_ALL, samplers.data() },
    };
    frame_layout_ = make_layout(device, 0, nullptr, frame);

    const VkDescriptorSetLayoutBinding textures[] = {
        { binding_textures, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, max_textures_, VK_SHADER_STAGE_ALL, nullptr },
    };
    const VkDescriptorBindingFlags flags = VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT
        | VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT | VK_DESCRIPTOR_BINDING_UPDATE_UNUSED_WHILE_PENDING_BIT;
    VkDescriptorSetLayoutBindingFlagsCreateInfo binding_flags {
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO
    };
    binding_flags.bindingCount = 1;
    binding_flags.pBindingFlags = &flags;
    texture_layout_
        = make_layout(device, VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT, &binding_flags, textures);

    std::array<VkDescriptorSetLayoutBinding, shared::TEXELS_COUNT> texels {};
    for (uint32_t binding = 0; binding < texels.size(); binding++)
        texels[binding] = { binding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr };
    scene_layout_ = make_layout(device, 0, nullptr, texels);
    const VkDescriptorSetLayoutBinding screen[] = {
        { 0, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, shared::SCREEN_BUFFER_COUNT, VK_SHADER_STAGE_ALL, nullptr },
    };
    screen_layout_ = make_layout(device, 0, nullptr, screen);

    const VkDescriptorSetLayout sets[] = { frame_layout_, texture_layout_, scene_layout_, screen_layout_ };
    const VkPushConstantRange push { VK_SHADER_STAGE_ALL, 0, push_constant_bytes };
    VkPipelineLayoutCreateInfo layout { VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO };
    layout.setLayoutCount = uint32_t(std::size(sets));
    layout.pSetLayouts = sets;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    VKPT_RENEW(pipeline_layout_, vkCreatePipelineLayout, device, layout);
}

void Bindings::create_sets()
{
    const VkDevice device = gpu_.device.handle;
    const VkDescriptorPoolSize frame[] = {
        { VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1 },
        { VK_DESCRIPTOR_TYPE_SAMPLER, shared::SAMPLER_COUNT },
    };
    const VkDescriptorPoolSize textures[] = { { VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, max_textures_ } };
    frame_pool_ = make_descriptor_pool(device, 0, 1, frame);
    texture_pool_ = make_descriptor_pool(device, VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT, 1, textures);
    frame_set_ = make_descriptor_set(device, frame_pool_, frame_layout_);
    texture_set_ = make_descriptor_set(device, texture_pool_, texture_layout_);
}

void Bindings::bind_uniforms(const Buffer& buffer, VkDeviceSize bytes_per_frame)
{
    const VkDescriptorBufferInfo info { buffer.handle(), 0, bytes_per_frame };
    VkWriteDescriptorSet write { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET };
    write.dstSet = frame_set_;
    write.dstBinding = binding_uniforms;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
    write.pBufferInfo = &info;
    vkUpdateDescriptorSets(gpu_.device.handle, 1, &write, 0, nullptr);
}

uint32_t Bindings::add_texture(const Image& image)
{
    uint32_t slot = next_slot_;
    if (!free_slots_.empty()) {
        slot = free_slots_.back();
        free_slots_.pop_back();
    } else if (next_slot_ < max_textures_) {
        next_slot_++;
    } else {
        throw FatalError(fmt::format("more than {} textures in use at once, this device's limit", max_textures_));
    }
    const VkDescriptorImageInfo info { VK_NULL_HANDLE, image.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL };
    VkWriteDescriptorSet write { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET };
    write.dstSet = texture_set_;
    write.dstBinding = 0;
    write.dstArrayElement = slot;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    write.pImageInfo = &info;
    vkUpdateDescriptorSets(gpu_.device.handle, 1, &write, 0, nullptr);
    return slot;
}

void Bindings::remove_texture(uint32_t slot) { free_slots_.push_back(slot); }

void Bindings::bind(
    VkCommandBuffer commands, VkPipelineBindPoint point, uint32_t uniform_offset, const ViewSets& view) const
{
    const VkDescriptorSet sets[] = { frame_set_, texture_set_, view.scene, view.screen };
    const uint32_t count = uint32_t(std::size(sets)) - (view.scene ? 0 : 2);
    vkCmdBindDescriptorSets(commands, point, pipeline_layout_, 0, count, sets, 1, &uniform_offset);
}

} // namespace vkpt

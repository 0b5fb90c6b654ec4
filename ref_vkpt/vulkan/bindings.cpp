// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/bindings.hpp"

#include "ref_vkpt/engine/errors.hpp"
#include "shaders/shared/frame.h"

#include <algorithm>
#include <fmt/format.h>

namespace vkpt {

namespace {

// More than any mod registers; devices that cannot do as many get what they can.
constexpr uint32_t wanted_textures = 8192;

enum Binding : uint32_t { binding_uniforms, binding_output, binding_samplers, binding_textures, binding_count };

} // namespace

Bindings::Bindings(const Gpu& gpu, bool anisotropic)
    : gpu_(gpu), max_textures_(std::min(wanted_textures, gpu.device.max_textures))
{
    create_samplers(anisotropic);
    create_layouts();
    create_set();
}

Bindings::~Bindings()
{
    const VkDevice device = gpu_.device.handle;
    vkDestroyDescriptorPool(device, pool_, nullptr);
    vkDestroyPipelineLayout(device, pipeline_layout_, nullptr);
    vkDestroyDescriptorSetLayout(device, set_layout_, nullptr);
    for (VkSampler sampler : samplers_)
        vkDestroySampler(device, sampler, nullptr);
}

void Bindings::create_samplers(bool anisotropic)
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
        info.anisotropyEnable = anisotropic && gpu_.device.has_anisotropy && row.filter == VK_FILTER_LINEAR;
        info.maxAnisotropy = info.anisotropyEnable ? gpu_.device.properties.limits.maxSamplerAnisotropy : 1.0f;
        VKPT_CHECK(vkCreateSampler(gpu_.device.handle, &info, nullptr, &samplers_.emplace_back()));
    }
}

void Bindings::create_layouts()
{
    VkDescriptorSetLayoutBinding bindings[binding_count] {};
    bindings[binding_uniforms] = { binding_uniforms, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1, VK_SHADER_STAGE_ALL, nullptr };
    bindings[binding_output] = { binding_output, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr };
    bindings[binding_samplers] = { binding_samplers, VK_DESCRIPTOR_TYPE_SAMPLER, shared::SAMPLER_COUNT, VK_SHADER_STAGE_ALL, samplers_.data() };
    bindings[binding_textures] = { binding_textures, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, max_textures_, VK_SHADER_STAGE_ALL, nullptr };

    VkDescriptorBindingFlags flags[binding_count] {};
    flags[binding_textures] = VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT | VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT
        | VK_DESCRIPTOR_BINDING_UPDATE_UNUSED_WHILE_PENDING_BIT;
    VkDescriptorSetLayoutBindingFlagsCreateInfo binding_flags {
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO
    };
    binding_flags.bindingCount = binding_count;
    binding_flags.pBindingFlags = flags;

    VkDescriptorSetLayoutCreateInfo set { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &binding_flags };
    set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT;
    set.bindingCount = binding_count;
    set.pBindings = bindings;
    VKPT_CHECK(vkCreateDescriptorSetLayout(gpu_.device.handle, &set, nullptr, &set_layout_));

    const VkPushConstantRange push { VK_SHADER_STAGE_ALL, 0, push_constant_bytes };
    VkPipelineLayoutCreateInfo layout { VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO };
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &set_layout_;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    VKPT_CHECK(vkCreatePipelineLayout(gpu_.device.handle, &layout, nullptr, &pipeline_layout_));
}

void Bindings::create_set()
{
    const VkDescriptorPoolSize sizes[] = {
        { VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1 },
        { VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1 },
        { VK_DESCRIPTOR_TYPE_SAMPLER, shared::SAMPLER_COUNT },
        { VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, max_textures_ },
    };
    VkDescriptorPoolCreateInfo pool { VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO };
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
    pool.maxSets = 1;
    pool.poolSizeCount = uint32_t(std::size(sizes));
    pool.pPoolSizes = sizes;
    VKPT_CHECK(vkCreateDescriptorPool(gpu_.device.handle, &pool, nullptr, &pool_));
    VkDescriptorSetAllocateInfo info { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO };
    info.descriptorPool = pool_;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &set_layout_;
    VKPT_CHECK(vkAllocateDescriptorSets(gpu_.device.handle, &info, &set_));
}

void Bindings::bind_uniforms(const Buffer& buffer, VkDeviceSize bytes_per_frame)
{
    const VkDescriptorBufferInfo info { buffer.handle(), 0, bytes_per_frame };
    VkWriteDescriptorSet write { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET };
    write.dstSet = set_;
    write.dstBinding = binding_uniforms;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
    write.pBufferInfo = &info;
    vkUpdateDescriptorSets(gpu_.device.handle, 1, &write, 0, nullptr);
}

void Bindings::bind_output(const Image& image)
{
    const VkDescriptorImageInfo info { VK_NULL_HANDLE, image.view(), VK_IMAGE_LAYOUT_GENERAL };
    VkWriteDescriptorSet write { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET };
    write.dstSet = set_;
    write.dstBinding = binding_output;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    write.pImageInfo = &info;
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
        throw FatalError(fmt::format("more than {} pictures in use at once, the most that this device serves", max_textures_));
    }
    const VkDescriptorImageInfo info { VK_NULL_HANDLE, image.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL };
    VkWriteDescriptorSet write { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET };
    write.dstSet = set_;
    write.dstBinding = binding_textures;
    write.dstArrayElement = slot;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    write.pImageInfo = &info;
    vkUpdateDescriptorSets(gpu_.device.handle, 1, &write, 0, nullptr);
    return slot;
}

void Bindings::remove_texture(uint32_t slot) { free_slots_.push_back(slot); }

void Bindings::bind(VkCommandBuffer commands, VkPipelineBindPoint point, uint32_t uniform_offset) const
{
    vkCmdBindDescriptorSets(commands, point, pipeline_layout_, 0, 1, &set_, 1, &uniform_offset);
}

} // namespace vkpt

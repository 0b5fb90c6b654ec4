// SPDX-License-Identifier: GPL-2.0-or-later
// The descriptor sets and pipeline layout that all passes share, so that a new pass is a shader and nothing else.
//   set 0, binding 0  uniform buffer: shared::FrameUniforms (dynamic offset: one per frame in flight)
//   set 0, binding 1  samplers, see SAMPLER_*
//   set 1, binding 0  sampled images, bindless; slot 0 is always a valid white texture. A set of its own because it is
//                     updated while bound, which Vulkan forbids beside dynamic offsets.
//   set 2             buffers of texels: the scene's tables, TEXELS_*; each view has its own (frame/scene_texels.hpp)
//   set 3             buffers of texels: those of screen_buffers.def, of each view (frame/view_buffers.hpp)
// Push constants: 64 bytes, the pass's own.
#pragma once

#include "ref_vkpt/vulkan/resources.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vkpt {

// For as many sets as asked for, which live as long as the pool.
DescriptorPool make_descriptor_pool(
    VkDevice device, VkDescriptorPoolCreateFlags flags, uint32_t sets, std::span<const VkDescriptorPoolSize> sizes);
VkDescriptorSet make_descriptor_set(VkDevice device, VkDescriptorPool pool, VkDescriptorSetLayout layout);

inline constexpr uint32_t push_constant_bytes = 64;

class Bindings {
public:
    explicit Bindings(const Gpu& gpu);
    Bindings(const Bindings&) = delete;
    Bindings& operator=(const Bindings&) = delete;

    VkPipelineLayout pipeline_layout() const { return pipeline_layout_; }
    VkDescriptorSetLayout scene_layout() const { return scene_layout_; }
    VkDescriptorSetLayout screen_layout() const { return screen_layout_; }
    uint32_t max_textures() const { return max_textures_; }

    void bind_uniforms(const Buffer& buffer, VkDeviceSize bytes_per_frame);
    // A free slot now showing `image` (layout SHADER_READ_ONLY). Throws FatalError when all are taken.
    uint32_t add_texture(const Image& image);
    // The slot may be handed out again; the device must be idle.
    void remove_texture(uint32_t slot);

    // Sets 2 and 3 of a view; none where no shader reads either.
    struct ViewSets {
        VkDescriptorSet scene = VK_NULL_HANDLE;
        VkDescriptorSet screen = VK_NULL_HANDLE;
    };
    void bind(VkCommandBuffer commands, VkPipelineBindPoint point, uint32_t uniform_offset, const ViewSets& view) const;
    void bind(VkCommandBuffer commands, VkPipelineBindPoint point, uint32_t uniform_offset) const
    {
        bind(commands, point, uniform_offset, {});
    }

private:
    void create_layouts();
    void create_samplers();
    void create_sets();

    Gpu gpu_;
    uint32_t max_textures_;
    std::vector<Handle<VkSampler, vkDestroySampler>> samplers_;
    DescriptorSetLayout frame_layout_, texture_layout_, scene_layout_, screen_layout_;
    Handle<VkPipelineLayout, vkDestroyPipelineLayout> pipeline_layout_;
    DescriptorPool frame_pool_, texture_pool_;
    VkDescriptorSet frame_set_ = VK_NULL_HANDLE, texture_set_ = VK_NULL_HANDLE;
    std::vector<uint32_t> free_slots_;
    uint32_t next_slot_ = 0;
};

} // namespace vkpt

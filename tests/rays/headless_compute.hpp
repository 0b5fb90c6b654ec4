// SPDX-License-Identifier: GPL-2.0-or-later
// As much Vulkan as a test of a compute shader needs: one device, mapped buffers, one dispatch at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

namespace vkpt::tests {

// No Vulkan device with what the software backend needs: a reason to skip, not to fail.
struct NoDevice : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class HeadlessCompute {
public:
    struct Buffer {
        VkBuffer buffer = VK_NULL_HANDLE;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkDeviceAddress address = 0;
        std::byte* mapped = nullptr;
        size_t size = 0;
    };
    // One level, one layer, in the general layout.
    struct Image {
        VkImage image = VK_NULL_HANDLE;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
    };
    // What a shader has at a binding of set 0: a buffer's texels, or a storage image.
    struct Binding {
        VkBuffer texels = VK_NULL_HANDLE;
        VkFormat format = VK_FORMAT_UNDEFINED; // of the texels
        VkImageView image = VK_NULL_HANDLE;
    };
    struct Pipeline {
        VkShaderModule module = VK_NULL_HANDLE;
        VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
        VkDescriptorSet set = VK_NULL_HANDLE; // where it has bindings
        VkPipelineLayout layout = VK_NULL_HANDLE;
        VkPipeline pipeline = VK_NULL_HANDLE;
        uint32_t push_bytes = 0;
    };

    enum class Validation { off, on };

    // Takes the first device. With validation (core and synchronization), messages() has what the layer said.
    // Throws NoDevice, or std::runtime_error naming the call that failed.
    explicit HeadlessCompute(Validation validation);
    ~HeadlessCompute();
    HeadlessCompute(const HeadlessCompute&) = delete;
    HeadlessCompute& operator=(const HeadlessCompute&) = delete;

    // Host-visible; they live until free_buffers().
    Buffer create_buffer(size_t bytes);
    Buffer create_buffer(std::span<const std::byte> content);
    template <class T> Buffer create_buffer_of(std::span<const T> items) { return create_buffer(std::as_bytes(items)); }

    void free_buffers();

    Image create_image(VkFormat format, uint32_t width, uint32_t height);

    // Entry point main; `specialization` sets the constants 0, 1, 2, ..., `bindings` are the types of the bindings 0,
    // 1, 2, ..., which are filled by bind().
    Pipeline create_pipeline(std::span<const uint32_t> spirv, uint32_t push_bytes,
        std::span<const uint32_t> specialization, std::span<const VkDescriptorType> bindings = {});
    void bind(const Pipeline& pipeline, std::span<const Binding> bindings);

    // Seconds from submission to completion.
    double dispatch(const Pipeline& pipeline, const void* push, uint32_t groups);

    const std::string& device_name() const { return device_name_; }
    const std::vector<std::string>& messages() const { return messages_; }

private:
    void create_instance(Validation validation);
    void choose_device();
    void create_device();
    void create_set(Pipeline& pipeline, std::span<const VkDescriptorType> bindings);
    VkDeviceMemory allocate(const VkMemoryRequirements& needed);
    void submit_and_wait();
    void destroy();

    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    uint32_t queue_family_ = 0;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    std::vector<Buffer> buffers_;
    std::vector<Image> images_;
    std::vector<VkBufferView> texel_views_;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
    std::vector<Pipeline> pipelines_;
    std::string device_name_;
    std::vector<std::string> messages_;
};

} // namespace vkpt::tests

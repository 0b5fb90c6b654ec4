// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/rays/headless_compute.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>

namespace vkpt::tests {
namespace {

void require(VkResult result, const char* call)
{
    if (result != VK_SUCCESS)
        throw std::runtime_error(std::string(call) + " returned " + std::to_string(int(result)));
}
#define REQUIRE_VK(call) require(call, #call)

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

// The CPU driver reads these when it loads. Its disk cache does not know the vector width, so a cache filled at another
// width would undo the choice.
void set_driver_environment()
{
    if (__builtin_cpu_supports("avx512f"))
        setenv("LP_NATIVE_VECTOR_WIDTH", "512", 0);
    setenv("MESA_SHADER_CACHE_DISABLE", "1", 0);
}

VkBool32 VKAPI_PTR keep_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
    const VkDebugUtilsMessengerCallbackDataEXT* data, void* messages)
{
    static_cast<std::vector<std::string>*>(messages)->push_back(data->pMessage);
    return VK_FALSE;
}

bool has_layer(const char* name)
{
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(
        layers.begin(), layers.end(), [&](const auto& layer) { return !std::strcmp(layer.layerName, name); });
}

} // namespace

HeadlessCompute::HeadlessCompute(Validation validation)
{
    set_driver_environment();
    try {
        create_instance(validation);
        choose_device();
        create_device();
    } catch (...) {
        destroy();
        throw;
    }
}

HeadlessCompute::~HeadlessCompute() { destroy(); }

void HeadlessCompute::create_instance(Validation validation)
{
    VkApplicationInfo application { VK_STRUCTURE_TYPE_APPLICATION_INFO };
    application.apiVersion = VK_API_VERSION_1_2;
    VkInstanceCreateInfo info { VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO };
    info.pApplicationInfo = &application;

    VkDebugUtilsMessengerCreateInfoEXT messenger { VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT };
    messenger.messageSeverity
        = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = keep_message;
    messenger.pUserData = &messages_;
    VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features { VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT };
    features.pNext = &messenger;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronization;
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    if (validation == Validation::on) {
        if (!has_layer(validation_layer))
            throw NoDevice("the Vulkan validation layer is not installed (Debian: vulkan-validationlayers)");
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &validation_layer;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &extension;
    }
    if (VkResult result = vkCreateInstance(&info, nullptr, &instance_); result != VK_SUCCESS)
        throw NoDevice("vkCreateInstance returned " + std::to_string(int(result)));
    if (validation == Validation::on) {
        auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
        REQUIRE_VK(create(instance_, &messenger, nullptr, &messenger_));
    }
}

void HeadlessCompute::choose_device()
{
    uint32_t count = 1;
    VkResult result = vkEnumeratePhysicalDevices(instance_, &count, &physical_);
    if ((result != VK_SUCCESS && result != VK_INCOMPLETE) || count == 0)
        throw NoDevice("there is no Vulkan device");
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical_, &properties);
    device_name_ = properties.deviceName;
}

void HeadlessCompute::create_device()
{
    VkPhysicalDeviceVulkan12Features features12 { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES };
    VkPhysicalDeviceFeatures2 features { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2 };
    features.pNext = &features12;
    vkGetPhysicalDeviceFeatures2(physical_, &features);
    if (!features12.bufferDeviceAddress || !features12.scalarBlockLayout || !features.features.shaderInt64)
        throw NoDevice(device_name_ + " lacks bufferDeviceAddress, scalarBlockLayout or shaderInt64");
    features12 = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES };
    features12.bufferDeviceAddress = features12.scalarBlockLayout = VK_TRUE;
    features.features = {};
    features.features.shaderInt64 = VK_TRUE;

    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, families.data());
    auto compute = std::find_if(
        families.begin(), families.end(), [](const auto& family) { return family.queueFlags & VK_QUEUE_COMPUTE_BIT; });
    if (compute == families.end())
        throw NoDevice(device_name_ + " has no compute queue");
    queue_family_ = uint32_t(compute - families.begin());

    float priority = 1.0f;
    VkDeviceQueueCreateInfo queue { VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO };
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info { VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO };
    info.pNext = &features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    REQUIRE_VK(vkCreateDevice(physical_, &info, nullptr, &device_));
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);

    VkCommandPoolCreateInfo pool { VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO };
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = queue_family_;
    REQUIRE_VK(vkCreateCommandPool(device_, &pool, nullptr, &pool_));
    VkCommandBufferAllocateInfo commands { VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO };
    commands.commandPool = pool_;
    commands.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    commands.commandBufferCount = 1;
    REQUIRE_VK(vkAllocateCommandBuffers(device_, &commands, &commands_));
    VkFenceCreateInfo fence { VK_STRUCTURE_TYPE_FENCE_CREATE_INFO };
    REQUIRE_VK(vkCreateFence(device_, &fence, nullptr, &fence_));

    constexpr uint32_t max_descriptors = 64;
    const VkDescriptorPoolSize sizes[] = { { VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, max_descriptors },
        { VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, max_descriptors } };
    VkDescriptorPoolCreateInfo descriptors { VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO };
    descriptors.maxSets = max_descriptors;
    descriptors.poolSizeCount = uint32_t(std::size(sizes));
    descriptors.pPoolSizes = sizes;
    REQUIRE_VK(vkCreateDescriptorPool(device_, &descriptors, nullptr, &descriptors_));
}

// Host-visible.
VkDeviceMemory HeadlessCompute::allocate(const VkMemoryRequirements& needed)
{
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
    constexpr VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    uint32_t type = 0;
    while (type < memory.memoryTypeCount
        && (!(needed.memoryTypeBits >> type & 1) || (memory.memoryTypes[type].propertyFlags & wanted) != wanted))
        type++;
    VkMemoryAllocateFlagsInfo flags { VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO };
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo allocation { VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO };
    allocation.pNext = &flags;
    allocation.allocationSize = needed.size;
    allocation.memoryTypeIndex = type;
    VkDeviceMemory result = VK_NULL_HANDLE;
    REQUIRE_VK(vkAllocateMemory(device_, &allocation, nullptr, &result));
    return result;
}

HeadlessCompute::Buffer HeadlessCompute::create_buffer(size_t bytes)
{
    Buffer& buffer = buffers_.emplace_back();
    buffer.size = bytes;
    VkBufferCreateInfo info { VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO };
    info.size = std::max<size_t>(bytes, 16);
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT
        | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    REQUIRE_VK(vkCreateBuffer(device_, &info, nullptr, &buffer.buffer));
    VkMemoryRequirements needed;
    vkGetBufferMemoryRequirements(device_, buffer.buffer, &needed);
    buffer.memory = allocate(needed);
    REQUIRE_VK(vkBindBufferMemory(device_, buffer.buffer, buffer.memory, 0));
    void* mapped = nullptr;
    REQUIRE_VK(vkMapMemory(device_, buffer.memory, 0, VK_WHOLE_SIZE, 0, &mapped));
    buffer.mapped = static_cast<std::byte*>(mapped);
    VkBufferDeviceAddressInfo address { VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO };
    address.buffer = buffer.buffer;
    buffer.address = vkGetBufferDeviceAddress(device_, &address);
    return buffer;
}

HeadlessCompute::Buffer HeadlessCompute::create_buffer(std::span<const std::byte> content)
{
    Buffer buffer = create_buffer(content.size());
    std::copy(content.begin(), content.end(), buffer.mapped);
    return buffer;
}

HeadlessCompute::Image HeadlessCompute::create_image(VkFormat format, uint32_t width, uint32_t height)
{
    Image& image = images_.emplace_back();
    VkImageCreateInfo info { VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO };
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = { width, height, 1 };
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    REQUIRE_VK(vkCreateImage(device_, &info, nullptr, &image.image));
    VkMemoryRequirements needed;
    vkGetImageMemoryRequirements(device_, image.image, &needed);
    image.memory = allocate(needed);
    REQUIRE_VK(vkBindImageMemory(device_, image.image, image.memory, 0));
    VkImageViewCreateInfo view { VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO };
    view.image = image.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 };
    REQUIRE_VK(vkCreateImageView(device_, &view, nullptr, &image.view));

    VkCommandBufferBeginInfo begin { VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
    REQUIRE_VK(vkBeginCommandBuffer(commands_, &begin));
    VkImageMemoryBarrier barrier { VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER };
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.image;
    barrier.subresourceRange = view.subresourceRange;
    vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 0,
        nullptr, 0, nullptr, 1, &barrier);
    REQUIRE_VK(vkEndCommandBuffer(commands_));
    submit_and_wait();
    return image;
}

void HeadlessCompute::create_set(Pipeline& pipeline, std::span<const VkDescriptorType> bindings)
{
    std::vector<VkDescriptorSetLayoutBinding> slots;
    for (const VkDescriptorType type : bindings)
        slots.push_back({ uint32_t(slots.size()), type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr });
    VkDescriptorSetLayoutCreateInfo info { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO };
    info.bindingCount = uint32_t(slots.size());
    info.pBindings = slots.data();
    REQUIRE_VK(vkCreateDescriptorSetLayout(device_, &info, nullptr, &pipeline.set_layout));
    VkDescriptorSetAllocateInfo allocation { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO };
    allocation.descriptorPool = descriptors_;
    allocation.descriptorSetCount = 1;
    allocation.pSetLayouts = &pipeline.set_layout;
    REQUIRE_VK(vkAllocateDescriptorSets(device_, &allocation, &pipeline.set));
}

void HeadlessCompute::bind(const Pipeline& pipeline, std::span<const Binding> bindings)
{
    for (uint32_t slot = 0; slot < bindings.size(); slot++) {
        const VkDescriptorImageInfo image { VK_NULL_HANDLE, bindings[slot].image, VK_IMAGE_LAYOUT_GENERAL };
        VkWriteDescriptorSet write { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET };
        write.dstSet = pipeline.set;
        write.dstBinding = slot;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        write.pImageInfo = &image;
        if (!bindings[slot].image) {
            VkBufferViewCreateInfo view { VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO };
            view.buffer = bindings[slot].texels;
            view.format = bindings[slot].format;
            view.range = VK_WHOLE_SIZE;
            REQUIRE_VK(vkCreateBufferView(device_, &view, nullptr, &texel_views_.emplace_back()));
            write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
            write.pTexelBufferView = &texel_views_.back();
        }
        vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
    }
}

HeadlessCompute::Pipeline HeadlessCompute::create_pipeline(std::span<const uint32_t> spirv, uint32_t push_bytes,
    std::span<const uint32_t> specialization, std::span<const VkDescriptorType> bindings)
{
    Pipeline& pipeline = pipelines_.emplace_back();
    pipeline.push_bytes = push_bytes;
    VkShaderModuleCreateInfo module { VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO };
    module.codeSize = spirv.size_bytes();
    module.pCode = spirv.data();
    REQUIRE_VK(vkCreateShaderModule(device_, &module, nullptr, &pipeline.module));
    VkPushConstantRange range { VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes };
    VkPipelineLayoutCreateInfo layout { VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO };
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &range;
    if (!bindings.empty()) {
        create_set(pipeline, bindings);
        layout.setLayoutCount = 1;
        layout.pSetLayouts = &pipeline.set_layout;
    }
    REQUIRE_VK(vkCreatePipelineLayout(device_, &layout, nullptr, &pipeline.layout));

    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t i = 0; i < specialization.size(); i++)
        entries.push_back({ i, i * 4, 4 });
    VkSpecializationInfo constants { uint32_t(entries.size()), entries.data(), specialization.size_bytes(),
        specialization.data() };
    VkComputePipelineCreateInfo info { VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO };
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = pipeline.module;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &constants;
    info.layout = pipeline.layout;
    REQUIRE_VK(vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline.pipeline));
    return pipeline;
}

double HeadlessCompute::dispatch(const Pipeline& pipeline, const void* push, uint32_t groups)
{
    VkCommandBufferBeginInfo begin { VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    REQUIRE_VK(vkBeginCommandBuffer(commands_, &begin));
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    if (pipeline.set)
        vkCmdBindDescriptorSets(
            commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &pipeline.set, 0, nullptr);
    vkCmdPushConstants(commands_, pipeline.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, pipeline.push_bytes, push);
    vkCmdDispatch(commands_, groups, 1, 1);
    VkMemoryBarrier to_host { VK_STRUCTURE_TYPE_MEMORY_BARRIER };
    to_host.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
    to_host.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0,
        nullptr, 0, nullptr);
    REQUIRE_VK(vkEndCommandBuffer(commands_));

    auto start = std::chrono::steady_clock::now();
    submit_and_wait();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void HeadlessCompute::submit_and_wait()
{
    VkSubmitInfo submit { VK_STRUCTURE_TYPE_SUBMIT_INFO };
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    REQUIRE_VK(vkQueueSubmit(queue_, 1, &submit, fence_));
    REQUIRE_VK(vkWaitForFences(device_, 1, &fence_, VK_TRUE, UINT64_MAX));
    REQUIRE_VK(vkResetFences(device_, 1, &fence_));
}

void HeadlessCompute::free_buffers()
{
    for (VkBufferView view : texel_views_)
        vkDestroyBufferView(device_, view, nullptr);
    texel_views_.clear();
    for (const Buffer& buffer : buffers_) {
        vkDestroyBuffer(device_, buffer.buffer, nullptr);
        vkFreeMemory(device_, buffer.memory, nullptr);
    }
    buffers_.clear();
}

void HeadlessCompute::destroy()
{
    for (const Pipeline& pipeline : pipelines_) {
        vkDestroyPipeline(device_, pipeline.pipeline, nullptr);
        vkDestroyPipelineLayout(device_, pipeline.layout, nullptr);
        vkDestroyDescriptorSetLayout(device_, pipeline.set_layout, nullptr);
        vkDestroyShaderModule(device_, pipeline.module, nullptr);
    }
    for (const Image& image : images_) {
        vkDestroyImageView(device_, image.view, nullptr);
        vkDestroyImage(device_, image.image, nullptr);
        vkFreeMemory(device_, image.memory, nullptr);
    }
    free_buffers();
    if (device_) {
        vkDestroyDescriptorPool(device_, descriptors_, nullptr);
        vkDestroyFence(device_, fence_, nullptr);
        vkDestroyCommandPool(device_, pool_, nullptr);
        vkDestroyDevice(device_, nullptr);
    }
    if (messenger_) {
        auto destroy_messenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy_messenger(instance_, messenger_, nullptr);
    }
    if (instance_)
        vkDestroyInstance(instance_, nullptr);
}

} // namespace vkpt::tests

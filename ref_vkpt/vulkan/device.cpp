// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/device.hpp"

#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/engine/errors.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <optional>

namespace vkpt {

namespace {

std::atomic<uint32_t> validation_message_count { 0 };

const char* result_name(VkResult result)
{
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_DEVICE_LOST:
        return "device lost";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialization failed";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "layer not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "extension not present";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "feature not present";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "incompatible driver";
    case VK_ERROR_SURFACE_LOST_KHR:
        return "surface lost";
    case VK_ERROR_OUT_OF_DATE_KHR:
        return "swapchain out of date";
    default:
        return "error";
    }
}

VKAPI_ATTR VkBool32 VKAPI_CALL print_validation_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
    VkDebugUtilsMessageTypeFlagsEXT, const VkDebugUtilsMessengerCallbackDataEXT* data, void*)
{
    validation_message_count++;
    engine::print("vkpt validation: {}", data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info()
{
    VkDebugUtilsMessengerCreateInfoEXT info { VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT };
    info.messageSeverity
        = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = print_validation_message;
    return info;
}

std::vector<VkExtensionProperties> instance_extensions(const char* layer)
{
    uint32_t count = 0;
    VKPT_CHECK(vkEnumerateInstanceExtensionProperties(layer, &count, nullptr));
    std::vector<VkExtensionProperties> extensions(count);
    VKPT_CHECK(vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data()));
    return extensions;
}

bool contains(const std::vector<VkExtensionProperties>& extensions, const char* name)
{
    return std::ranges::any_of(extensions, [&](auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

bool has_layer(const char* name)
{
    uint32_t count = 0;
    VKPT_CHECK(vkEnumerateInstanceLayerProperties(&count, nullptr));
    std::vector<VkLayerProperties> layers(count);
    VKPT_CHECK(vkEnumerateInstanceLayerProperties(&count, layers.data()));
    return std::ranges::any_of(layers, [&](auto& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

std::vector<VkExtensionProperties> device_extensions(VkPhysicalDevice device)
{
    uint32_t count = 0;
    VKPT_CHECK(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr));
    std::vector<VkExtensionProperties> extensions(count);
    VKPT_CHECK(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()));
    return extensions;
}

std::vector<VkQueueFamilyProperties> queue_families_of(VkPhysicalDevice device)
{
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    return families;
}

// A surface of the window while a device is chosen, which may have no window to present to.
class ProbedSurface {
public:
    ProbedSurface(VkInstance instance, const Window* window)
        : instance_(instance)
        , surface_(window && *window ? window->create_surface(instance) : VK_NULL_HANDLE)
    {
    }
    ProbedSurface(const ProbedSurface&) = delete;
    ~ProbedSurface()
    {
        if (surface_)
            vkDestroySurfaceKHR(instance_, surface_, nullptr);
    }

    // Whether this family's queues can present to it; without a window they need not.
    bool serves(VkPhysicalDevice device, uint32_t family) const
    {
        VkBool32 supported = VK_FALSE;
        return !surface_
            || (vkGetPhysicalDeviceSurfaceSupportKHR(device, family, surface_, &supported) >= 0 && supported);
    }

private:
    VkInstance instance_;
    VkSurfaceKHR surface_;
};

// The features every pass relies on, asked of a device in one chain.
struct Features {
    VkPhysicalDeviceFeatures2 core { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2 };
    VkPhysicalDeviceVulkan12Features v12 { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES };
    Features() { core.pNext = &v12; }
    Features(const Features&) = delete;
};

// The name of the first feature that `has` lacks; nullptr: nothing is missing. Copies the needed ones to `use`.
const char* require_features(const Features& has, Features& use)
{
    struct Row {
        const VkBool32* present;
        VkBool32* enable;
        const char* name;
    };
#define VKPT_FEATURE(block, field)                                                                                     \
    Row { &has.block.field, &use.block.field, #field }
    const Row rows[] = {
        VKPT_FEATURE(core.features, shaderInt64),
        VKPT_FEATURE(v12, scalarBlockLayout),
        VKPT_FEATURE(v12, bufferDeviceAddress),
        VKPT_FEATURE(v12, descriptorIndexing),
        VKPT_FEATURE(v12, runtimeDescriptorArray),
        VKPT_FEATURE(v12, shaderSampledImageArrayNonUniformIndexing),
        VKPT_FEATURE(v12, shaderUniformTexelBufferArrayDynamicIndexing),
        VKPT_FEATURE(v12, descriptorBindingPartiallyBound),
        VKPT_FEATURE(v12, descriptorBindingSampledImageUpdateAfterBind),
        VKPT_FEATURE(v12, descriptorBindingUpdateUnusedWhilePending),
    };
#undef VKPT_FEATURE
    for (const Row& row : rows) {
        if (!*row.present)
            return row.name;
        *row.enable = VK_TRUE;
    }
    return nullptr;
}

DriverIdentity identify_driver(VkPhysicalDevice device)
{
    VkPhysicalDeviceIDProperties ids { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES };
    VkPhysicalDeviceProperties2 about { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &ids };
    vkGetPhysicalDeviceProperties2(device, &about);
    const VkPhysicalDeviceProperties& properties = about.properties;
    DriverIdentity identity { {}, {}, properties.vendorID, properties.deviceID, properties.driverVersion,
        properties.apiVersion };
    std::ranges::copy(ids.driverUUID, identity.driver_uuid.begin());
    std::ranges::copy(properties.pipelineCacheUUID, identity.cache_uuid.begin());
    return identity;
}

// Its name stands in a header of beta extensions.
constexpr const char* portability_subset = "VK_KHR_portability_subset";

// What the device's own ray tracing needs, asked for only where its extensions are.
struct RayTracingFeatures {
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structures {
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR
    };
    VkPhysicalDeviceRayQueryFeaturesKHR query { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR };
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline {
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR
    };
};

// What a logical device is made with.
struct Enabled {
    Features& features;
    RayTracingFeatures& rays;
    std::vector<const char*>& extensions;
};

// Links a feature or property struct into the chain behind `head`.
template <class Head, class Link> void chain(Head& head, Link& link)
{
    link.pNext = head.pNext;
    head.pNext = &link;
}

// A physical device, and what keeps us from it.
struct Candidate {
    VkPhysicalDevice device;
    std::string name, why_not; // empty: nothing
    VkPhysicalDeviceType type;
    std::vector<uint32_t> families; // of queues that serve, the best first
    uint32_t family = 0;
};

// `name_part`: pt_device
Candidate examine(VkPhysicalDevice device, const std::string& name_part)
{
    VkPhysicalDeviceProperties2 about { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2 };
    vkGetPhysicalDeviceProperties2(device, &about);
    const VkPhysicalDeviceProperties& properties = about.properties;
    Candidate candidate { device, properties.deviceName, "", properties.deviceType,
        rank_queue_families(queue_families_of(device)) };
    Features has, use;
    if (candidate.name.find(name_part) == std::string::npos)
        candidate.why_not = fmt::format("is not pt_device \"{}\"", name_part);
    else if (properties.apiVersion < VK_API_VERSION_1_2)
        candidate.why_not = "has only Vulkan " + describe_api_version(properties.apiVersion) + ", 1.2 is required";
    else if (candidate.families.empty())
        candidate.why_not = "has no queue for compute";
    else {
        vkGetPhysicalDeviceFeatures2(device, &has.core);
        if (const char* missing = require_features(has, use))
            candidate.why_not = fmt::format("lacks the feature {}", missing);
    }
    return candidate;
}

} // namespace

void check_vulkan(VkResult result, const char* call)
{
    if (result >= 0)
        return;
    std::string_view name(call);
    const std::string text = fmt::format(
        "{} failed: {} ({})", name.substr(0, name.find('(')), result_name(result), static_cast<int>(result));
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY)
        throw LevelError(fmt::format("{}; {}", text, memory_remedy));
    if (result == VK_ERROR_DEVICE_LOST)
        throw DeviceLost(text);
    throw FatalError(text);
}

std::string describe_api_version(uint32_t version)
{
    return fmt::format(
        "{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version), VK_API_VERSION_PATCH(version));
}

uint32_t Device::validation_messages() { return validation_message_count; }

Device::Device(const DeviceSettings& settings)
    : cpu_driver_(std::make_unique<CpuDriverSettings>(settings.cache_directory))
    , windowed_(settings.window && *settings.window)
    , uses_rays_(settings.ray_tracing)
    , wants_statistics_(settings.pipeline_statistics)
{
    check_address_space();
    load_vulkan_library();
    try {
        create_instance(settings);
        choose_physical_device(settings);
        reads_texels_ = choose_texels(properties, settings.table_reads);
        create_logical_device();
    } catch (...) {
        destroy();
        throw;
    }
}

// The entry points of the original serve both, as they belong to the physical device.
Device::Device(Twin, const Device& original)
    : instance(original.instance)
    , physical(original.physical)
    , queue_family(original.queue_family)
    , properties(original.properties)
    , memory(original.memory)
    , driver(original.driver)
    , identity(original.identity)
    , traits(original.traits)
    , maps_all_memory(original.maps_all_memory)
    , timestamp_bits(original.timestamp_bits)
    , has_debug_utils(original.has_debug_utils)
    , max_textures(original.max_textures)
    , windowed_(false)
    , uses_rays_(original.uses_rays_)
    , owns_instance_(false)
    , reads_texels_(original.reads_texels_)
{
    create_logical_device();
}

std::unique_ptr<Device> Device::make_twin(const Device& original)
{
    return std::unique_ptr<Device>(new Device(Twin {}, original));
}

std::string Device::driver_cache_directory() const { return cpu_driver_ ? cpu_driver_->directory() : ""; }

Device::~Device() { destroy(); }

void Device::destroy()
{
    if (handle)
        vkDestroyDevice(handle, nullptr);
    if (messenger_)
        vkDestroyDebugUtilsMessengerEXT(instance, messenger_, nullptr);
    if (instance && owns_instance_)
        vkDestroyInstance(instance, nullptr);
    handle = VK_NULL_HANDLE;
    messenger_ = VK_NULL_HANDLE;
    instance = VK_NULL_HANDLE;
}

void Device::create_instance(const DeviceSettings& settings)
{
    uint32_t version = VK_API_VERSION_1_0;
    VKPT_CHECK(vkEnumerateInstanceVersion(&version));
    if (version < VK_API_VERSION_1_2)
        throw FatalError(fmt::format("Vulkan {} is too old: version 1.2 is required", describe_api_version(version)));

    constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";
    std::vector<const char*> layers;
    std::vector<const char*> extensions;
    if (windowed_)
        extensions = settings.window->instance_extensions();
    const std::vector<VkExtensionProperties> offered = instance_extensions(nullptr);
    // Else surfaces tell of no colour space but sRGB.
    if (windowed_ && contains(offered, VK_EXT_SWAPCHAIN_COLOR_SPACE_EXTENSION_NAME))
        extensions.push_back(VK_EXT_SWAPCHAIN_COLOR_SPACE_EXTENSION_NAME);
    // Devices that lack parts of Vulkan, such as Apple's by MoltenVK, are named only to who asks for them.
    const bool lists_portable = contains(offered, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    if (lists_portable)
        extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    const bool validate = settings.validation && has_layer(validation_layer);
    if (settings.validation && !validate)
        throw FatalError("pt_validation 1 needs the Vulkan validation layers: install vulkan-validationlayers");
    if (validate)
        layers.push_back(validation_layer);
    has_debug_utils = contains(offered, VK_EXT_DEBUG_UTILS_EXTENSION_NAME)
        || (validate && contains(instance_extensions(validation_layer), VK_EXT_DEBUG_UTILS_EXTENSION_NAME));
    if (has_debug_utils)
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (validate)
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);

    VkApplicationInfo application { VK_STRUCTURE_TYPE_APPLICATION_INFO };
    application.pApplicationName = "ref_vkpt";
    application.apiVersion = VK_API_VERSION_1_2;

    const VkValidationFeatureEnableEXT checks[] = { VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT };
    VkValidationFeaturesEXT features { VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT };
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = checks;

    VkInstanceCreateInfo info { VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO };
    info.pNext = validate ? &features : nullptr;
    info.flags = lists_portable ? VkInstanceCreateFlags(VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR) : 0;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = uint32_t(layers.size());
    info.ppEnabledLayerNames = layers.data();
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VKPT_CHECK(vkCreateInstance(&info, nullptr, &instance));
    load_instance_functions(instance);

    if (validate) {
        const VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info();
        VKPT_CHECK(vkCreateDebugUtilsMessengerEXT(instance, &messenger, nullptr, &messenger_));
    }
}

void Device::choose_physical_device(const DeviceSettings& settings)
{
    uint32_t count = 0;
    VKPT_CHECK(vkEnumeratePhysicalDevices(instance, &count, nullptr));
    std::vector<VkPhysicalDevice> devices(count);
    VKPT_CHECK(vkEnumeratePhysicalDevices(instance, &count, devices.data()));
    if (devices.empty())
        throw FatalError(
            "no Vulkan device on this machine: install your card's driver, or mesa-vulkan-drivers for the CPU");

    const ProbedSurface surface(instance, settings.window);
    std::string reasons;
    std::vector<Candidate> candidates;
    std::vector<DeviceFacts> facts;
    for (VkPhysicalDevice device : devices) {
        Candidate candidate = examine(device, settings.name_part);
        if (!candidate.why_not.empty()) {
            reasons += fmt::format("; {} {}", candidate.name, candidate.why_not);
            continue;
        }
        const auto presenting
            = std::ranges::find_if(candidate.families, [&](uint32_t family) { return surface.serves(device, family); });
        const bool can_present = presenting != candidate.families.end();
        candidate.family = can_present ? *presenting : candidate.families.front();
        facts.push_back({ candidate.type, can_present });
        candidates.push_back(std::move(candidate));
    }
    const std::optional<size_t> chosen = choose_device(facts);
    if (!chosen)
        throw FatalError("no usable Vulkan device" + reasons);
    physical = candidates[*chosen].device;
    queue_family = candidates[*chosen].family;
    read_queue_and_memory();
}

std::vector<uint32_t> Device::queue_families() const
{
    if (async_family() == queue_family)
        return { queue_family };
    return { queue_family, async_family() };
}

void Device::read_queue_and_memory()
{
    VkPhysicalDeviceVulkan12Properties v12 { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES };
    VkPhysicalDeviceProperties2 about { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v12 };
    vkGetPhysicalDeviceProperties2(physical, &about);
    properties = about.properties;
    driver = fmt::format("{} {}", v12.driverName, v12.driverInfo);
    max_textures = std::min(
        v12.maxPerStageDescriptorUpdateAfterBindSampledImages, v12.maxDescriptorSetUpdateAfterBindSampledImages);
    traits = find_traits(properties);
    const std::vector<VkQueueFamilyProperties> families = queue_families_of(physical);
    timestamp_bits = families[queue_family].timestampValidBits;
    async_place_ = find_async_queue(families, queue_family);
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    maps_all_memory = vkpt::maps_all_memory(memory);
    identity = identify_driver(physical);
}

// Asks for the device's own ray tracing where it has it, and notes that in it.
static void enable_rays(Device& device, const std::vector<VkExtensionProperties>& offered, const Enabled& use)
{
    const bool structures = contains(offered, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME)
        && contains(offered, VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME);
    VkPhysicalDeviceFeatures2 features { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2 };
    RayTracingFeatures has;
    if (structures)
        chain(features, has.structures);
    if (structures && contains(offered, VK_KHR_RAY_QUERY_EXTENSION_NAME))
        chain(features, has.query);
    if (structures && contains(offered, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME))
        chain(features, has.pipeline);
    vkGetPhysicalDeviceFeatures2(device.physical, &features);

    device.has_ray_query = has.structures.accelerationStructure && has.query.rayQuery;
    device.has_ray_pipeline = has.structures.accelerationStructure && has.pipeline.rayTracingPipeline;
    if (device.has_acceleration_structures()) {
        use.extensions.push_back(VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME);
        use.extensions.push_back(VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME);
        use.rays.structures.accelerationStructure = VK_TRUE;
        chain(use.features.core, use.rays.structures);
    }
    if (device.has_ray_query) {
        use.extensions.push_back(VK_KHR_RAY_QUERY_EXTENSION_NAME);
        use.rays.query.rayQuery = VK_TRUE;
        chain(use.features.core, use.rays.query);
    }
    if (device.has_ray_pipeline) {
        use.extensions.push_back(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
        use.rays.pipeline.rayTracingPipeline = VK_TRUE;
        chain(use.features.core, use.rays.pipeline);
    }
}

void Device::create_logical_device()
{
    const std::vector<VkExtensionProperties> offered = device_extensions(physical);
    std::vector<const char*> extensions;
    has_swapchain = windowed_ && contains(offered, VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    if (has_swapchain)
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    has_hdr_metadata = has_swapchain && contains(offered, VK_EXT_HDR_METADATA_EXTENSION_NAME);
    if (has_hdr_metadata)
        extensions.push_back(VK_EXT_HDR_METADATA_EXTENSION_NAME);
    if (contains(offered, portability_subset)) // a device that has it wants it enabled
        extensions.push_back(portability_subset);

    Features has, use;
    vkGetPhysicalDeviceFeatures2(physical, &has.core);
    require_features(has, use);
    RayTracingFeatures rays;
    if (uses_rays_)
        enable_rays(*this, offered, { use, rays, extensions });
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics {
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR, nullptr, VK_TRUE
    };
    has_pipeline_statistics
        = wants_statistics_ && contains(offered, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    if (has_pipeline_statistics) {
        extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
        chain(use.core, statistics);
    }
    read_ray_tracing_limits();

    constexpr float priorities[] = { 1, 1 };
    std::vector<VkDeviceQueueCreateInfo> queues;
    for (const uint32_t family : queue_families()) {
        VkDeviceQueueCreateInfo& info
            = queues.emplace_back(VkDeviceQueueCreateInfo { VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO });
        info.queueFamilyIndex = family;
        info.queueCount = async_place_ && async_place_->family == family ? async_place_->index + 1 : 1;
        info.pQueuePriorities = priorities;
    }

    VkDeviceCreateInfo info { VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO };
    info.pNext = &use.core;
    info.queueCreateInfoCount = uint32_t(queues.size());
    info.pQueueCreateInfos = queues.data();
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VKPT_CHECK(vkCreateDevice(physical, &info, nullptr, &handle));
    if (owns_instance_)
        load_device_functions(handle);
    vkGetDeviceQueue(handle, queue_family, 0, &queue);
    if (async_place_)
        vkGetDeviceQueue(handle, async_place_->family, async_place_->index, &async_queue);
}

void Device::read_ray_tracing_limits()
{
    VkPhysicalDeviceProperties2 limits { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2 };
    VkPhysicalDeviceAccelerationStructurePropertiesKHR structures {
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR
    };
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR pipeline {
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR
    };
    if (has_acceleration_structures())
        chain(limits, structures);
    if (has_ray_pipeline)
        chain(limits, pipeline);
    vkGetPhysicalDeviceProperties2(physical, &limits);
    scratch_alignment = std::max(structures.minAccelerationStructureScratchOffsetAlignment, 1u);
    shader_group_bytes = pipeline.shaderGroupHandleSize;
    shader_group_alignment = std::max(pipeline.shaderGroupHandleAlignment, 1u);
    shader_table_alignment = std::max(pipeline.shaderGroupBaseAlignment, 1u);
}

void Device::wait_idle() const { VKPT_CHECK(vkDeviceWaitIdle(handle)); }

std::vector<uint32_t> Device::find_memory_types(uint32_t type_bits, const MemoryWish& wish) const
{
    std::vector<uint32_t> types = rank_memory_types(memory, type_bits, wish);
    if (types.empty())
        throw FatalError(
            fmt::format("{} has no memory of the required type (flags {:#x})", properties.deviceName, wish.required));
    return types;
}

double Device::nanoseconds_between(uint64_t begin, uint64_t end) const
{
    return double(ticks_between(begin, end, timestamp_bits)) * double(properties.limits.timestampPeriod);
}

void Device::name_object(VkObjectType type, uint64_t object, std::string_view name) const
{
    if (!vkSetDebugUtilsObjectNameEXT || !has_debug_utils)
        return;
    const std::string text(name);
    VkDebugUtilsObjectNameInfoEXT info { VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT };
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = text.c_str();
    vkSetDebugUtilsObjectNameEXT(handle, &info);
}

DebugLabel::DebugLabel(const Device& device, VkCommandBuffer commands, const char* name)
    : commands_(device.has_debug_utils && vkCmdBeginDebugUtilsLabelEXT ? commands : VK_NULL_HANDLE)
{
    if (!commands_)
        return;
    VkDebugUtilsLabelEXT label { VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT };
    label.pLabelName = name;
    vkCmdBeginDebugUtilsLabelEXT(commands_, &label);
}

DebugLabel::~DebugLabel()
{
    if (commands_)
        vkCmdEndDebugUtilsLabelEXT(commands_);
}

} // namespace vkpt

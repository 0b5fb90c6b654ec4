// SPDX-License-Identifier: GPL-2.0-or-later
// Instance, physical device, logical device, its queue and, where it has one, a second one beside it.
#pragma once

#include "ref_vkpt/files/pipeline_cache_file.hpp"
#include "ref_vkpt/vulkan/device_choice.hpp"
#include "ref_vkpt/vulkan/functions.hpp"
#include "ref_vkpt/vulkan/lavapipe.hpp"
#include "ref_vkpt/vulkan/window.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

// What helps where memory does not suffice.
inline constexpr const char* memory_remedy
    = "lower pt_render_scale or the window's size (r_mode), set r_retexturing 0, or close other programs";
// Throws with the call's text unless the call succeeded: LevelError where memory ran out, DeviceLost, else FatalError.
void check_vulkan(VkResult result, const char* call);
#define VKPT_CHECK(call) ::vkpt::check_vulkan((call), #call)

struct DeviceSettings {
    std::string name_part; // empty: the best device
    bool validation = false;
    const Window* window = nullptr; // what is to be presented to, if it is one
    bool pipeline_statistics = false; // for Pipelines::statistics()
    bool ray_tracing = true; // enable the device's own ray tracing where it has it
    TableReads table_reads = TableReads::automatic;
    std::string cache_directory; // for the driver's shader cache; empty: the driver's own place
};

class Device {
public:
    // Throws FatalError: no Vulkan, no device, or a feature that device X lacks.
    explicit Device(const DeviceSettings& settings);
    // Another logical device of the same physical one, without a window: for work beside the original's queue. The
    // original outlives it.
    static std::unique_ptr<Device> make_twin(const Device& original);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice handle = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t queue_family = 0;
    // For compute, beside `queue`; VK_NULL_HANDLE: the device has no other.
    VkQueue async_queue = VK_NULL_HANDLE;
    // The families whose queues use our buffers: one or two.
    std::vector<uint32_t> queue_families() const;
    uint32_t async_family() const { return async_place_ ? async_place_->family : queue_family; }

    VkPhysicalDeviceProperties properties {};
    VkPhysicalDeviceMemoryProperties memory {};
    std::string driver;
    DriverIdentity identity;
    DeviceTraits traits;
    // Whether shaders read tables and screen buffers as texels (lib/device/texels.glsl) or by address.
    bool reads_texels() const { return reads_texels_; }
    const char* table_reads() const { return reads_texels_ ? "texels" : "address"; }
    // A discrete GPU without a resizable BAR lets the CPU see a small part of its memory (256 MiB): there what is large
    // is copied to the device instead of written right into its memory.
    bool maps_all_memory = true;
    // Of timestamps on our queue; 0: it has none.
    uint32_t timestamp_bits = 0;
    bool has_pipeline_statistics = false; // VK_KHR_pipeline_executable_properties, where it was asked for
    bool has_swapchain = false;
    bool has_hdr_metadata = false; // VK_EXT_hdr_metadata
    bool has_debug_utils = false;
    uint32_t max_textures = 0;

    // The device's own ray tracing. Shaders read acceleration structures through addresses.
    bool has_ray_query = false;
    bool has_ray_pipeline = false;
    bool has_acceleration_structures() const { return has_ray_query || has_ray_pipeline; }
    VkDeviceSize scratch_alignment = 1; // of acceleration structure builds
    uint32_t shader_group_bytes = 0, shader_group_alignment = 1, shader_table_alignment = 1; // of ray tracing pipelines
    // Where our shaders run.
    VkPipelineStageFlags shader_stages() const
    {
        return VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT
            | (has_ray_pipeline ? VkPipelineStageFlags(VK_PIPELINE_STAGE_RAY_TRACING_SHADER_BIT_KHR) : 0);
    }

    // Where Mesa's CPU driver keeps what it has compiled, if that is a folder of ours; else empty.
    std::string driver_cache_directory() const;

    // How many validation messages have been printed.
    static uint32_t validation_messages();

    void wait_idle() const;
    // The memory types among `type_bits` with all that is required, the best first. Throws FatalError: there is none.
    std::vector<uint32_t> find_memory_types(uint32_t type_bits, const MemoryWish& wish) const;
    // Nanoseconds between two timestamps of our queue, which may have wrapped around once.
    double nanoseconds_between(uint64_t begin, uint64_t end) const;
    void name_object(VkObjectType type, uint64_t object, std::string_view name) const;

private:
    struct Twin { };
    Device(Twin, const Device& original);
    void create_instance(const DeviceSettings& settings);
    void choose_physical_device(const DeviceSettings& settings);
    void read_queue_and_memory();
    void create_logical_device();
    void read_ray_tracing_limits();
    void destroy();

    std::optional<QueuePlace> async_place_;
    std::unique_ptr<CpuDriverSettings> cpu_driver_;
    bool windowed_;
    bool uses_rays_; // the device's own, where it has them
    bool wants_statistics_ = false;
    bool owns_instance_ = true;
    bool reads_texels_ = false;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

// What is recorded while it lives is a group of its own in tools such as RenderDoc, by this name.
class DebugLabel {
public:
    DebugLabel(const Device& device, VkCommandBuffer commands, const char* name);
    ~DebugLabel();
    DebugLabel(const DebugLabel&) = delete;
    DebugLabel& operator=(const DebugLabel&) = delete;

private:
    VkCommandBuffer commands_;
};

// "1.2.131"
std::string describe_api_version(uint32_t version);

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The device with everything that lives as long as it: memory, bindings, pipelines, the window's images, the frames
// in flight.
#pragma once

#include "ref_vkpt/frame/frame_timer.hpp"
#include "ref_vkpt/frame/pass_markers.hpp"
#include "ref_vkpt/frame/view_buffers.hpp"
#include "ref_vkpt/vulkan/pipelines.hpp"
#include "ref_vkpt/vulkan/swapchain.hpp"
#include "ref_vkpt/vulkan/uploader.hpp"

#include <cstdint>
#include <functional>
#include <optional>

namespace vkpt {

// The image that is shown: a word for each pixel, RGBA with red in the lowest byte, sRGB-encoded. A buffer rather
// than an image, whose texels Mesa's CPU driver stores one after the other.
struct OutputImage {
    Buffer words;
    Buffer highlights; // FrameUniforms::highlights, where the window shows HDR
    VkExtent2D size {};

    explicit operator bool() const { return bool(words); }
};

struct GraphicsSettings {
    void* sdl_window = nullptr; // nullptr: images only
    VkExtent2D size { 640, 480 }; // of the images without a window
    std::string device_name_part;
    std::string cache_directory;
    bool validation = false;
    bool ray_tracing = true; // use the device's own where it has it
    bool pipeline_statistics = false; // registers and the like of what is compiled
    TableReads table_reads = TableReads::automatic;
    WindowWishes window;
};

class Graphics {
public:
    explicit Graphics(const GraphicsSettings& settings);
    ~Graphics();
    Graphics(const Graphics&) = delete;
    Graphics& operator=(const Graphics&) = delete;

    // Waits for the slot's last frame, follows the window's size, and starts recording. The output image is cleared.
    // True: it is another one than before.
    bool begin_frame();
    // Submits, then takes an image of the window and shows. Nothing happens without a begun frame.
    void end_frame();
    bool is_recording() const { return recording_; }
    // Whether nobody can see what is drawn now: the window is minimised.
    bool is_hidden() const;
    VkCommandBuffer commands() const { return slots_[slot_].commands; }
    // For what the frame's shaders need and the last frame's do not touch: runs beside the last frame where the device
    // has a queue for it, and is done before this frame's shaders run.
    VkCommandBuffer async_commands();
    uint32_t slot() const { return slot_; }
    // Frames submitted since the start.
    uint64_t frame_number() const { return frame_number_; }

    void set_window_wishes(const WindowWishes& wishes);
    // How many times as bright as paper white the window's screen can be; 1: it shows no HDR.
    float headroom() const;
    bool is_vsync_active() const { return swapchain_ && swapchain_->vsync() != VSync::off; }
    // The size of images without a window.
    void set_size(VkExtent2D size) { headless_size_ = size; }
    // Of the image; before the first frame: what it will have.
    VkExtent2D size() const;

    // Waits for everything submitted.
    void finish();
    // Records, submits and waits, between frames.
    void run_once(const std::function<void(VkCommandBuffer)>& record);
    // The first bytes of what was written on the device, copied to where the CPU reads them; between frames.
    Buffer read_back(const Buffer& source, VkDeviceSize bytes);

private:
    Window window_;

public:
    Device device;
    MemoryAllocator memory { device };
    Gpu gpu { device, memory };
    Uploader uploader { gpu };
    Bindings bindings { gpu };
    Pipelines pipelines;
    OutputImage output;
    FrameTimer timer { device };
    PassMarkers markers { gpu };

private:
    struct Slot {
        CommandPool pool;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkCommandBuffer show_commands = VK_NULL_HANDLE; // the copy into the window's image
        Fence finished, shown;
        // Of the device's other queue, where it has one.
        CommandPool async_pool;
        VkCommandBuffer async_commands = VK_NULL_HANDLE;
        Semaphore async_done;
        bool has_async = false; // something was recorded
    };
    void create_slot(Slot& slot);
    void renew_fence(Fence& fence);
    void renew_async_semaphore(Slot& slot);
    void submit(const VkSubmitInfo& info, Fence& fence);
    bool can_show() const;
    void show(Slot& slot);
    bool follow_window();
    bool shows_hdr() const;
    void resize_output(VkExtent2D size);
    void clear_output();
    void record_present_words();

    std::optional<Swapchain> swapchain_;
    Buffer present_words_; // the image in the window's format
    VkExtent2D headless_size_;
    WindowWishes wishes_;
    bool told_of_no_hdr_ = false;
    bool swapchain_outdated_ = true;
    bool recording_ = false;
    Slot slots_[frames_in_flight];
    uint32_t slot_ = 0;
    uint64_t frame_number_ = 0;
};

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The window's images. The frame is made in an image of our own and copied into the window's at its end.
#pragma once

#include "ref_vkpt/vulkan/resources.hpp"
#include "ref_vkpt/vulkan/window.hpp"
#include "ref_vkpt/vulkan/window_format.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace vkpt {

inline constexpr uint32_t frames_in_flight = 2;

// What the player asks the window for.
struct WindowWishes {
    VSync vsync = VSync::on;
    bool hdr = false;
    float peak = 1000, paper_white = 200; // of an HDR screen, in cd/m^2
    bool operator==(const WindowWishes&) const = default;
};

// An image was taken; none was free in time, this frame is not shown; the window changed, recreate.
enum class Acquired { image, none, outdated };

class Swapchain {
public:
    Swapchain(const Gpu& gpu, const Window& window);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    // Makes the images for the window's size now, and the surface where it was lost. False: there is nothing to show
    // (minimised), or the surface is gone again. The device must be idle.
    bool recreate(const WindowWishes& wishes);
    bool is_usable() const { return swapchain_ != VK_NULL_HANDLE; }
    VSync vsync() const { return wishes_.vsync; }

    Acquired acquire(uint32_t frame_slot);
    // Copies words in the window's format, row by row, written by the passes before, into the image taken.
    void record_copy(VkCommandBuffer commands, const Buffer& words);
    VkExtent2D extent() const { return extent_; }
    const WindowFormat& format() const { return format_; }
    VkSemaphore acquired(uint32_t frame_slot) const { return acquired_[frame_slot]; }
    VkSemaphore finished() const { return finished_[image_]; }
    // False: the window changed, recreate. Images that are merely not the best for the window (VK_SUBOPTIMAL_KHR) are
    // kept as long as new ones would be made the same way: some drivers say so of every image.
    bool present();

private:
    void create_surface();
    void renew_surface();
    bool make_images();
    void tell_screen() const;
    // Whether the surface still is. Throws for other failures.
    bool check(VkResult result, const char* call);
    VkExtent2D extent_for(const VkSurfaceCapabilitiesKHR& surface) const;
    bool has_changed();
    void destroy_images();
    // What the surface offers. False: it is gone.
    template <class Item, class Query> bool list(Query query, const char* call, std::vector<Item>& items);

    Gpu gpu_;
    const Window& window_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    Handle<VkSwapchainKHR, vkDestroySwapchainKHR> swapchain_;
    VkExtent2D extent_ {};
    VkSurfaceTransformFlagBitsKHR transform_ = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    bool surface_lost_ = false;
    WindowFormat format_;
    WindowWishes wishes_;
    std::vector<VkImage> images_;
    std::vector<Semaphore> finished_; // one per image: it may be presented
    std::array<Semaphore, frames_in_flight> acquired_;
    uint32_t image_ = 0;
};

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/swapchain.hpp"

#include "ref_vkpt/engine/engine.hpp"

#include <algorithm>

namespace vkpt {

namespace {

// Compositors may keep all images of a window that nobody sees; the game goes on without.
constexpr uint64_t acquire_nanoseconds = 1'000'000'000;

void renew(Semaphore& semaphore, VkDevice device)
{
    const VkSemaphoreCreateInfo info { VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO };
    VKPT_RENEW(semaphore, vkCreateSemaphore, device, info);
}

} // namespace

Swapchain::Swapchain(const Gpu& gpu, const Window& window)
    : gpu_(gpu)
    , window_(window)
{
    if (!gpu.device.has_swapchain)
        throw FatalError(
            std::string(gpu.device.properties.deviceName) + " cannot present to a window (no VK_KHR_swapchain)");
    create_surface();
}

void Swapchain::create_surface()
{
    surface_ = window_.create_surface(gpu_.device.instance);
    VkBool32 supported = VK_FALSE;
    if (!check(
            vkGetPhysicalDeviceSurfaceSupportKHR(gpu_.device.physical, gpu_.device.queue_family, surface_, &supported),
            "vkGetPhysicalDeviceSurfaceSupportKHR"))
        return;
    if (!supported)
        throw FatalError(std::string(gpu_.device.properties.deviceName)
            + " cannot present to this window; choose another "
              "device with pt_device");
}

// Displays and their drivers may take a surface away: a monitor unplugged, a compositor started anew.
void Swapchain::renew_surface()
{
    engine::print("ref_vkpt: the window's surface was lost; creating another one");
    destroy_images();
    swapchain_ = {};
    vkDestroySurfaceKHR(gpu_.device.instance, surface_, nullptr);
    surface_ = VK_NULL_HANDLE;
    surface_lost_ = false;
    create_surface();
}

bool Swapchain::check(VkResult result, const char* call)
{
    if (result == VK_ERROR_SURFACE_LOST_KHR) {
        surface_lost_ = true;
        return false;
    }
    check_vulkan(result, call);
    return true;
}

Swapchain::~Swapchain()
{
    swapchain_ = {};
    vkDestroySurfaceKHR(gpu_.device.instance, surface_, nullptr);
}

void Swapchain::destroy_images()
{
    finished_.clear();
    images_.clear();
}

template <class Item, class Query> bool Swapchain::list(Query query, const char* call, std::vector<Item>& items)
{
    uint32_t count = 0;
    if (!check(query(gpu_.device.physical, surface_, &count, nullptr), call))
        return false;
    items.resize(count);
    return check(query(gpu_.device.physical, surface_, &count, items.data()), call);
}

bool Swapchain::recreate(const WindowWishes& wishes)
{
    wishes_ = wishes;
    if (surface_lost_)
        renew_surface();
    return !surface_lost_ && make_images();
}

VkExtent2D Swapchain::extent_for(const VkSurfaceCapabilitiesKHR& surface) const
{
    if (surface.currentExtent.width != UINT32_MAX)
        return surface.currentExtent;
    const VkExtent2D wanted = window_.drawable_size(); // the window takes the images' size
    return { std::clamp(wanted.width, surface.minImageExtent.width, surface.maxImageExtent.width),
        std::clamp(wanted.height, surface.minImageExtent.height, surface.maxImageExtent.height) };
}

// Whether new images would be others than those that there are.
bool Swapchain::has_changed()
{
    VkSurfaceCapabilitiesKHR surface;
    if (!check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu_.device.physical, surface_, &surface),
            "vkGetPhysicalDeviceSurfaceCapabilitiesKHR"))
        return true;
    const VkExtent2D extent = extent_for(surface);
    return extent.width != extent_.width || extent.height != extent_.height || surface.currentTransform != transform_;
}

bool Swapchain::make_images()
{
    destroy_images();
    // A failed submission leaves one signalled, which then cannot be waited for again.
    for (Semaphore& semaphore : acquired_)
        renew(semaphore, gpu_.device.handle);
    VkSurfaceCapabilitiesKHR surface;
    if (!check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu_.device.physical, surface_, &surface),
            "vkGetPhysicalDeviceSurfaceCapabilitiesKHR"))
        return false;
    extent_ = extent_for(surface);
    transform_ = surface.currentTransform;
    const auto old = std::move(swapchain_);
    if (extent_.width > 0 && extent_.height > 0) {
        std::vector<VkSurfaceFormatKHR> formats;
        std::vector<VkPresentModeKHR> modes;
        if (!list(vkGetPhysicalDeviceSurfaceFormatsKHR, "vkGetPhysicalDeviceSurfaceFormatsKHR", formats)
            || !list(vkGetPhysicalDeviceSurfacePresentModesKHR, "vkGetPhysicalDeviceSurfacePresentModesKHR", modes))
            return false;
        format_ = choose_window_format(formats, wishes_.hdr);
        VkSwapchainCreateInfoKHR info { VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR };
        info.surface = surface_;
        info.minImageCount = surface.minImageCount + 1;
        if (surface.maxImageCount > 0)
            info.minImageCount = std::min(info.minImageCount, surface.maxImageCount);
        info.imageFormat = format_.format;
        info.imageColorSpace = format_.color_space;
        info.imageExtent = extent_;
        info.imageArrayLayers = 1;
        info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        info.preTransform = surface.currentTransform;
        info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
        info.presentMode = choose_present_mode(modes, wishes_.vsync);
        info.clipped = VK_TRUE;
        info.oldSwapchain = old;
        if (!check(swapchain_.renew(vkCreateSwapchainKHR, gpu_.device.handle, info), "vkCreateSwapchainKHR"))
            return false;
        uint32_t count = 0;
        VKPT_CHECK(vkGetSwapchainImagesKHR(gpu_.device.handle, swapchain_, &count, nullptr));
        images_.resize(count);
        VKPT_CHECK(vkGetSwapchainImagesKHR(gpu_.device.handle, swapchain_, &count, images_.data()));
        finished_.resize(count);
        for (Semaphore& semaphore : finished_)
            renew(semaphore, gpu_.device.handle);
        tell_screen();
    }
    return is_usable();
}

// What the images may hold, so that the screen need not compress it further.
void Swapchain::tell_screen() const
{
    if (!format_.is_hdr() || !gpu_.device.has_hdr_metadata)
        return;
    VkHdrMetadataEXT metadata { VK_STRUCTURE_TYPE_HDR_METADATA_EXT };
    metadata.displayPrimaryRed = { 0.708f, 0.292f }; // BT.2020
    metadata.displayPrimaryGreen = { 0.170f, 0.797f };
    metadata.displayPrimaryBlue = { 0.131f, 0.046f };
    metadata.whitePoint = { 0.3127f, 0.3290f };
    metadata.maxLuminance = metadata.maxContentLightLevel = wishes_.peak;
    metadata.maxFrameAverageLightLevel = std::min(wishes_.paper_white, wishes_.peak);
    const VkSwapchainKHR swapchain = swapchain_;
    vkSetHdrMetadataEXT(gpu_.device.handle, 1, &swapchain, &metadata);
}

Acquired Swapchain::acquire(uint32_t frame_slot)
{
    const VkResult result = vkAcquireNextImageKHR(
        gpu_.device.handle, swapchain_, acquire_nanoseconds, acquired_[frame_slot], VK_NULL_HANDLE, &image_);
    if (result == VK_TIMEOUT || result == VK_NOT_READY)
        return Acquired::none;
    return result != VK_ERROR_OUT_OF_DATE_KHR && check(result, "vkAcquireNextImageKHR") ? Acquired::image
                                                                                        : Acquired::outdated;
}

void Swapchain::record_copy(VkCommandBuffer commands, const Buffer& words)
{
    const VkImage image = images_[image_];
    constexpr VkPipelineStageFlags transfer = VK_PIPELINE_STAGE_TRANSFER_BIT;
    record_barrier(commands,
        { image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, transfer, transfer, 0,
            VK_ACCESS_TRANSFER_WRITE_BIT });
    VkBufferImageCopy region {};
    region.imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 };
    region.imageExtent = { extent_.width, extent_.height, 1 };
    vkCmdCopyBufferToImage(commands, words.handle(), image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    record_barrier(commands,
        { image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, transfer,
            VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, 0 });
}

bool Swapchain::present()
{
    const VkSemaphore ready = finished();
    const VkSwapchainKHR swapchain = swapchain_;
    VkPresentInfoKHR info { VK_STRUCTURE_TYPE_PRESENT_INFO_KHR };
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &ready;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain;
    info.pImageIndices = &image_;
    const VkResult result = vkQueuePresentKHR(gpu_.device.queue, &info);
    if (result == VK_SUBOPTIMAL_KHR)
        return !has_changed();
    return result != VK_ERROR_OUT_OF_DATE_KHR && check(result, "vkQueuePresentKHR");
}

} // namespace vkpt

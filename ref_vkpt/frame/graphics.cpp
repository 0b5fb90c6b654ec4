// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/graphics.hpp"

#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/engine/errors.hpp"
#include "ref_vkpt/vulkan/commands.hpp"
#include "shaders/shared/present.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace vkpt {

namespace {

// Of frames that are not shown: a server goes on, and nothing runs as fast as it can.
constexpr std::chrono::milliseconds unseen_frame_time { 10 };

DeviceSettings device_settings(const GraphicsSettings& settings, const Window& window)
{
    DeviceSettings result;
    result.name_part = settings.device_name_part;
    result.validation = settings.validation;
    result.ray_tracing = settings.ray_tracing;
    result.table_reads = settings.table_reads;
    result.window = &window;
    result.pipeline_statistics = settings.pipeline_statistics;
    result.cache_directory = settings.cache_directory;
    return result;
}

} // namespace

Graphics::Graphics(const GraphicsSettings& settings)
    : window_(settings.sdl_window)
    , device(device_settings(settings, window_))
    , pipelines(gpu, bindings, settings.cache_directory.empty() ? "" : settings.cache_directory + "/pipelines.bin")
    , headless_size_(settings.size)
    , wishes_(settings.window)
{
    if (window_)
        swapchain_.emplace(gpu, window_);
    for (Slot& slot : slots_)
        create_slot(slot);
}

Graphics::~Graphics() { vkDeviceWaitIdle(device.handle); }

void Graphics::create_slot(Slot& slot)
{
    slot.pool = make_command_pool(device, device.queue_family);
    slot.commands = make_command_buffer(device, slot.pool);
    slot.show_commands = make_command_buffer(device, slot.pool);
    renew_fence(slot.finished);
    renew_fence(slot.shown);
    if (!device.async_queue)
        return;
    slot.async_pool = make_command_pool(device, device.async_family());
    slot.async_commands = make_command_buffer(device, slot.async_pool);
    renew_async_semaphore(slot);
}

void Graphics::renew_async_semaphore(Slot& slot)
{
    const VkSemaphoreCreateInfo info { VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO };
    VKPT_RENEW(slot.async_done, vkCreateSemaphore, device.handle, info);
}

void Graphics::renew_fence(Fence& fence)
{
    VkFenceCreateInfo info { VK_STRUCTURE_TYPE_FENCE_CREATE_INFO };
    info.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    VKPT_RENEW(fence, vkCreateFence, device.handle, info);
}

void Graphics::submit(const VkSubmitInfo& info, Fence& fence)
{
    const VkFence reset = fence;
    VKPT_CHECK(vkResetFences(device.handle, 1, &reset));
    if (const VkResult result = vkQueueSubmit(device.queue, 1, &info, fence); result < 0) {
        renew_fence(fence); // which nothing signals now
        swapchain_outdated_ = true; // nor is its image given back
        if (device.async_queue) { // nor does anything wait for the other queue
            vkDeviceWaitIdle(device.handle);
            renew_async_semaphore(slots_[slot_]);
        }
        check_vulkan(result, "vkQueueSubmit");
    }
}

VkCommandBuffer Graphics::async_commands()
{
    Slot& slot = slots_[slot_];
    if (!device.async_queue)
        return slot.commands;
    if (!std::exchange(slot.has_async, true)) {
        VKPT_CHECK(vkResetCommandPool(device.handle, slot.async_pool, 0));
        begin_commands(slot.async_commands);
        // What the other queue wrote before: the map's structures.
        record_memory_barrier(slot.async_commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
            VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
    }
    return slot.async_commands;
}

VkExtent2D Graphics::size() const
{
    if (output)
        return output.size;
    // Not what the engine asked for: on displays of high density a window has more pixels than that.
    const VkExtent2D window = window_ ? window_.drawable_size() : VkExtent2D {};
    return window.width > 0 && window.height > 0 ? window : headless_size_;
}

void Graphics::set_window_wishes(const WindowWishes& wishes)
{
    swapchain_outdated_ |= wishes != wishes_;
    told_of_no_hdr_ &= wishes.hdr;
    wishes_ = wishes;
}

bool Graphics::shows_hdr() const { return swapchain_ && swapchain_->is_usable() && swapchain_->format().is_hdr(); }

float Graphics::headroom() const { return output.highlights ? std::max(wishes_.peak / wishes_.paper_white, 1.0f) : 1; }

void Graphics::finish() { device.wait_idle(); }

// The output image has the window's size; a minimised window keeps the last one.
bool Graphics::follow_window()
{
    VkExtent2D wanted = headless_size_;
    if (swapchain_) {
        wanted = window_.drawable_size();
        if (wanted.width == 0 || wanted.height == 0 || window_.is_minimised()) {
            wanted = size();
        } else if (swapchain_outdated_) {
            device.wait_idle();
            const bool is_usable = swapchain_->recreate(wishes_);
            present_words_ = Buffer();
            const VkExtent2D extent = swapchain_->extent();
            const VkDeviceSize pixel = swapchain_->format().words * sizeof(uint32_t);
            present_words_ = Buffer(
                gpu, pixel * extent.width * extent.height, BufferHome::device, MemoryKind::images, "present words");
            swapchain_outdated_ = !is_usable;
            if (is_usable && wishes_.hdr && !shows_hdr() && !std::exchange(told_of_no_hdr_, true))
                engine::print("ref_vkpt: pt_hdr 1: the desktop offers this window no HDR format; switch HDR on in the "
                              "desktop's display settings, and play full screen where it asks for that");
        }
    }
    const bool fits = output && output.size.width == wanted.width && output.size.height == wanted.height;
    if (fits && bool(output.highlights) == shows_hdr())
        return false;
    device.wait_idle();
    swapchain_outdated_ |= output && swapchain_ && !fits;
    resize_output(wanted);
    return true;
}

// The device must be idle.
void Graphics::resize_output(VkExtent2D size)
{
    output.words = Buffer(); // given back before the new one is asked for
    output.highlights = Buffer();
    output.words = Buffer(gpu, VkDeviceSize(size.width) * size.height * sizeof(uint32_t), BufferHome::device,
        MemoryKind::images, "output");
    if (shows_hdr())
        output.highlights = Buffer(gpu, VkDeviceSize(size.width) * size.height * 2 * sizeof(uint32_t),
            BufferHome::device, MemoryKind::images, "highlights");
    output.size = size;
}

void Graphics::clear_output()
{
    constexpr uint32_t black = 0xff000000;
    record_memory_barrier(commands(), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
        VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
        VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdFillBuffer(commands(), output.words.handle(), 0, VK_WHOLE_SIZE, black);
    record_memory_barrier(commands(), VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
        VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
}

void Graphics::record_present_words()
{
    const VkExtent2D extent = swapchain_->extent();
    const WindowFormat& format = swapchain_->format();
    const shared::PresentPush push { output.words.address(), output.highlights ? output.highlights.address() : 0,
        present_words_.address(), { output.size.width, output.size.height }, { extent.width, extent.height },
        format.packing, output.highlights ? format.transfer : shared::PRESENT_SDR, wishes_.paper_white, wishes_.peak };
    constexpr VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    record_memory_barrier(commands(), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
        VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT, compute,
        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    const DebugLabel label(device, commands(), "present");
    bindings.bind(commands(), VK_PIPELINE_BIND_POINT_COMPUTE, 0);
    vkCmdBindPipeline(commands(), VK_PIPELINE_BIND_POINT_COMPUTE, pipelines.compute("present.comp"));
    vkCmdPushConstants(commands(), bindings.pipeline_layout(), VK_SHADER_STAGE_ALL, 0, sizeof(push), &push);
    const glm::uvec2 groups = pixel_groups(device, { extent.width, extent.height });
    vkCmdDispatch(commands(), groups.x, groups.y, 1);
    record_memory_barrier(
        commands(), compute, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
}

bool Graphics::begin_frame()
{
    if (recording_) // the engine left a frame by its error exit
        end_frame();
    Slot& slot = slots_[slot_];
    const VkFence fences[] = { slot.finished, slot.shown };
    VKPT_CHECK(vkWaitForFences(device.handle, 2, fences, VK_TRUE, UINT64_MAX));
    const bool is_new = follow_window();
    VKPT_CHECK(vkResetCommandPool(device.handle, slot.pool, 0));
    begin_commands(slot.commands);
    recording_ = true;
    timer.begin_frame(slot.commands, slot_);
    clear_output();
    markers.begin_frame(slot_, frame_number_);
    return is_new;
}

bool Graphics::is_hidden() const { return swapchain_ && window_.is_minimised(); }

bool Graphics::can_show() const
{
    return swapchain_ && swapchain_->is_usable() && !swapchain_outdated_ && !window_.is_minimised();
}

void Graphics::end_frame()
{
    if (!recording_)
        return;
    Slot& slot = slots_[slot_];
    recording_ = false;
    const bool shows = can_show();
    if (shows)
        record_present_words();
    timer.end_frame(slot.commands, shows ? "present" : "2d");
    markers.end_frame();
    VKPT_CHECK(vkEndCommandBuffer(slot.commands));
    VkSubmitInfo info { VK_STRUCTURE_TYPE_SUBMIT_INFO };
    info.commandBufferCount = 1;
    info.pCommandBuffers = &slot.commands;
    const VkSemaphore async_done = slot.async_done;
    const VkPipelineStageFlags shaders = device.shader_stages();
    if (std::exchange(slot.has_async, false)) {
        // Waits for nothing: what it uses belongs to the slot, whose last frame has finished.
        submit_commands(device.async_queue, slot.async_commands, async_done);
        info.waitSemaphoreCount = 1;
        info.pWaitSemaphores = &async_done;
        info.pWaitDstStageMask = &shaders;
    }
    submit(info, slot.finished);
    if (shows)
        show(slot);
    else if (swapchain_) // no display paces the frames now
        std::this_thread::sleep_for(unseen_frame_time);
    slot_ = (slot_ + 1) % frames_in_flight;
    frame_number_++;
}

// Only now is an image taken: waiting for one keeps neither the CPU from recording nor the device from the frame, and
// is no part of the frame's time.
void Graphics::show(Slot& slot)
{
    const Acquired taken = swapchain_->acquire(slot_);
    swapchain_outdated_ |= taken == Acquired::outdated;
    if (taken != Acquired::image)
        return;
    begin_commands(slot.show_commands);
    swapchain_->record_copy(slot.show_commands, present_words_);
    VKPT_CHECK(vkEndCommandBuffer(slot.show_commands));
    const VkPipelineStageFlags copies = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkSemaphore acquired = swapchain_->acquired(slot_), finished = swapchain_->finished();
    VkSubmitInfo info { VK_STRUCTURE_TYPE_SUBMIT_INFO };
    info.commandBufferCount = 1;
    info.pCommandBuffers = &slot.show_commands;
    info.waitSemaphoreCount = info.signalSemaphoreCount = 1;
    info.pWaitSemaphores = &acquired;
    info.pWaitDstStageMask = &copies;
    info.pSignalSemaphores = &finished;
    submit(info, slot.shown);
    swapchain_outdated_ |= !swapchain_->present();
}

void Graphics::run_once(const std::function<void(VkCommandBuffer)>& record)
{
    finish();
    Slot& slot = slots_[slot_];
    VKPT_CHECK(vkResetCommandPool(device.handle, slot.pool, 0));
    begin_commands(slot.commands);
    record(slot.commands);
    submit_commands(device.queue, slot.commands);
    finish();
}

Buffer Graphics::read_back(const Buffer& source, VkDeviceSize bytes)
{
    Buffer copy(gpu, bytes, BufferHome::readback, MemoryKind::staging, "readback");
    run_once([&](VkCommandBuffer commands) {
        record_memory_barrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
            VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
        const VkBufferCopy region { 0, 0, bytes };
        vkCmdCopyBuffer(commands, source.handle(), copy.handle(), 1, &region);
        record_memory_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    });
    return copy;
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/uploads.hpp"

#include "ref_vkpt/frame/changes.hpp"

#include <algorithm>
#include <cstring>

namespace vkpt {

namespace {

constexpr VkDeviceSize first_size = 1u << 20;
// Every table starts on its own cache line; more than any of our records needs.
constexpr VkDeviceSize alignment = 64;

void copy(std::byte* to, std::span<const std::byte> from)
{
    if (!from.empty())
        std::memcpy(to, from.data(), from.size());
}

} // namespace

void FrameUploads::begin_frame(uint32_t frame_slot)
{
    slot_ = frame_slot;
    Slot& slot = slots_[slot_];
    if (slot.buffers.size() > 1)
        slot.buffers.clear();
    if (slot.buffers.empty())
        slot.buffers.emplace_back(
            gpu_, std::max(first_size, slot.total + slot.total / 2), BufferHome::upload, kind_, "frame uploads");
    slot.used = slot.total = 0;
}

Upload FrameUploads::reserve(size_t bytes)
{
    Slot& slot = slots_[slot_];
    VkDeviceSize offset = (slot.used + alignment - 1) & ~(alignment - 1);
    if (offset + bytes > slot.buffers.back().size()) {
        slot.buffers.emplace_back(
            gpu_, std::max<VkDeviceSize>(first_size, bytes * 2), BufferHome::upload, kind_, "frame uploads");
        offset = 0;
    }
    Buffer& buffer = slot.buffers.back();
    slot.used = offset + bytes;
    slot.total += bytes + alignment;
    return { buffer.mapped() + offset, buffer.address() + offset };
}

VkDeviceAddress FrameUploads::push(std::span<const std::byte> bytes)
{
    const Upload upload = reserve(bytes.size());
    copy(upload.mapped, bytes);
    return upload.address;
}

bool make_room(Buffer& buffer, const Gpu& gpu, VkDeviceSize bytes, MemoryKind kind, const char* name, BufferHome home)
{
    constexpr VkDeviceSize min_spare = 16384;
    if (buffer && bytes <= buffer.size())
        return false;
    buffer = Buffer(); // first, so that both need not fit
    buffer = Buffer(gpu, bytes + bytes / 4 + min_spare, home, kind, name);
    return true;
}

Upload PrefixedUpload::reserve(
    uint32_t frame_slot, std::span<const std::byte> prefix, uint64_t prefix_version, size_t rest_bytes)
{
    Slot& slot = slots_[frame_slot];
    if (!gpu_.device.maps_all_memory)
        return reserve_staged(slot, prefix, prefix_version, rest_bytes);
    const VkDeviceSize bytes = prefix.size() + rest_bytes;
    if (make_room(slot.buffer, gpu_, bytes, kind_, name_))
        slot.version = 0;
    if (slot.version != prefix_version) {
        copy(slot.buffer.mapped(), prefix);
        slot.version = prefix_version;
    }
    return { slot.buffer.mapped() + prefix.size(), slot.buffer.address() };
}

Upload PrefixedUpload::reserve_staged(
    Slot& slot, std::span<const std::byte> prefix, uint64_t prefix_version, VkDeviceSize rest_bytes)
{
    slot.prefix_bytes = 0;
    slot.prefix_staging = Buffer(); // the device has finished with it
    if (make_room(slot.buffer, gpu_, prefix.size() + rest_bytes, kind_, name_, BufferHome::device))
        slot.version = 0;
    if (slot.version != prefix_version && !prefix.empty()) {
        slot.prefix_staging
            = Buffer(gpu_, prefix.size(), BufferHome::staging, MemoryKind::staging, "staged for the device");
        copy(slot.prefix_staging.mapped(), prefix);
        slot.prefix_bytes = prefix.size();
    }
    slot.version = prefix_version;
    make_room(slot.rest_staging, gpu_, rest_bytes, MemoryKind::staging, name_, BufferHome::staging);
    slot.rest_bytes = rest_bytes;
    slot.rest_start = prefix.size();
    return { slot.rest_staging.mapped(), slot.buffer.address() };
}

void PrefixedUpload::record_copies(VkCommandBuffer commands, uint32_t frame_slot)
{
    Slot& slot = slots_[frame_slot];
    const auto record = [&](const Buffer& from, VkDeviceSize start, VkDeviceSize& bytes) {
        const VkBufferCopy region { 0, start, bytes };
        if (bytes > 0)
            vkCmdCopyBuffer(commands, from.handle(), slot.buffer.handle(), 1, &region);
        bytes = 0;
    };
    record(slot.prefix_staging, 0, slot.prefix_bytes);
    record(slot.rest_staging, slot.rest_start, slot.rest_bytes);
}

VkDeviceAddress KeptUpload::write(uint32_t frame_slot, std::span<const std::byte> bytes)
{
    Slot& slot = slots_[frame_slot];
    if (make_room(slot.buffer, gpu_, bytes.size(), kind_, name_))
        slot.held.clear();
    write_changes(slot.buffer.mapped(), slot.held, bytes);
    return slot.buffer.address();
}

} // namespace vkpt

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

bool make_room(Buffer& buffer, const Gpu& gpu, VkDeviceSize bytes, MemoryKind kind, const char* name)
{
    constexpr VkDeviceSize min_spare = 16384;
    if (buffer && bytes <= buffer.size())
        return false;
    buffer = Buffer(); // first, so that both need not fit
    buffer = Buffer(gpu, bytes + bytes / 4 + min_spare, BufferHome::upload, kind, name);
    return true;
}

Upload PrefixedUpload::reserve(
    uint32_t frame_slot, std::span<const std::byte> prefix, uint64_t prefix_version, size_t rest_bytes)
{
    Slot& slot = slots_[frame_slot];
    const VkDeviceSize bytes = prefix.size() + rest_bytes;
    if (make_room(slot.buffer, gpu_, bytes, kind_, name_))
        slot.version = 0;
    if (slot.version != prefix_version) {
        copy(slot.buffer.mapped(), prefix);
        slot.version = prefix_version;
    }
    return { slot.buffer.mapped() + prefix.size(), slot.buffer.address() };
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

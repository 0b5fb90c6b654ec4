// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/screen.hpp"

#include <algorithm>
#include <utility>

namespace vkpt {

namespace {

size_t pixel_count(glm::uvec2 size) { return size_t(size.x) * size.y; }

} // namespace

uint32_t pixel_groups(glm::uvec2 size)
{
    const uint32_t tiles = (size.x + 7) / 8 * ((size.y + 7) / 8);
    return (tiles + shared::PIXEL_TILES_PER_GROUP - 1) / shared::PIXEL_TILES_PER_GROUP;
}

bool Screen::resize_output(VkExtent2D size)
{
    if (output_ && output_.width() == size.width && output_.height() == size.height)
        return false;
    ImageSettings settings;
    settings.width = size.width;
    settings.height = size.height;
    settings.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT
        | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    settings.kind = MemoryKind::images;
    output_ = Image();
    output_ = Image(gpu_, settings, "output");
    return true;
}

bool Screen::must_grow(glm::uvec2 size) const { return pixel_count(size) > pixels_ || pixel_groups(size) > groups_; }

bool Screen::reserve_pixels(glm::uvec2 size)
{
    if (!must_grow(size))
        return false;
    pixels_ = std::max(pixels_, pixel_count(size));
    groups_ = std::max(groups_, pixel_groups(size));
    const auto renew = [&](Buffer& buffer, size_t bytes, const char* name) {
        buffer = Buffer(); // given back before the new one is asked for
        buffer = Buffer(gpu_, bytes, BufferHome::device, MemoryKind::images, name);
        return buffer.address();
    };
    using namespace shared;
    // However the pixels are arranged, and with blocks that the edge cuts.
    const size_t strata = pixels_ / 3 + 1;
#define VKPT_SCREEN_BUFFER(type, name) addresses_.name = renew(buffers_[row_##name], pixels_ * sizeof(type), #name);
#define VKPT_STRATUM_BUFFER(type, name) addresses_.name = renew(buffers_[row_##name], strata * sizeof(type), #name);
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
    const size_t lanes = size_t(groups_) * PIXEL_GROUP_SIZE;
    renew(trace_stack_, lanes * TRACE_STACK_BYTES_PER_LANE, "trace stack");
    return true;
}

void Screen::exchange_history()
{
#define VKPT_SCREEN_BUFFER(type, name)
#define VKPT_HISTORY_BUFFER(type, name) std::swap(addresses_.name, addresses_.previous_##name);
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
}

void Screen::exchange(ViewBuffers& other)
{
    std::swap(pixels_, other.pixels);
    std::swap(groups_, other.groups);
    std::swap(buffers_, other.buffers);
    std::swap(trace_stack_, other.trace_stack);
    std::swap(addresses_, other.addresses);
}

const Buffer& Screen::accumulated() const { return buffers_[row_accumulated]; }

const Buffer& Screen::radiance() const { return buffers_[row_radiance]; }

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/view_buffers.hpp"

#include <algorithm>

namespace vkpt {

namespace {

uint32_t area(glm::uvec2 size) { return size.x * size.y; }

// By name.
namespace bytes_of {
using namespace shared;
#define VKPT_SCREEN_BUFFER(type, name) constexpr size_t name = sizeof(type);
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
} // namespace bytes_of
// What is read as texels is read as its lender's.
#define VKPT_SCREEN_BUFFER(type, name)
#define VKPT_BORROWED_BUFFER(type, name, lender)                                                                       \
    static_assert(bytes_of::name == bytes_of::lender || bytes_of::name == sizeof(uint32_t));
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER

glm::uvec2 count_tiles(glm::uvec2 size) { return count_blocks(size, glm::uvec2(8)); }

// Of PIXEL_TILES_PER_GROUP tiles.
uint32_t tile_groups(glm::uvec2 size)
{
    const glm::uvec2 tiles = count_tiles(size);
    return (tiles.x * tiles.y + shared::PIXEL_TILES_PER_GROUP - 1) / shared::PIXEL_TILES_PER_GROUP;
}

} // namespace

glm::uvec2 count_blocks(glm::uvec2 size, glm::uvec2 block) { return (size + block - 1u) / block; }

glm::uvec2 pixel_groups(const Device& device, glm::uvec2 size)
{
    return device.traits.gpu_lanes ? count_tiles(size) : glm::uvec2(tile_groups(size), 1);
}

TexelSet make_screen_texels(const Gpu& gpu, const Bindings& bindings)
{
    return TexelSet(gpu, bindings.screen_layout(), TexelShape::array, shared::SCREEN_BUFFER_COUNT);
}

ViewBuffers::Room ViewBuffers::room_of(glm::uvec2 size, Extras extras)
{
    return { area(size), area(count_blocks(size, glm::uvec2(shared::STRATUM_BLOCKS))),
        extras.trace_stacks ? tile_groups(size) : 0, extras.ray_counts ? area(size) : 0 };
}

ViewBuffers::Room ViewBuffers::with(const Room& wanted) const
{
    return { std::max(room_.pixels, wanted.pixels), std::max(room_.strata, wanted.strata),
        std::max(room_.trace_groups, wanted.trace_groups), std::max(room_.counted_pixels, wanted.counted_pixels) };
}

bool ViewBuffers::must_grow(glm::uvec2 size, Extras extras) const { return with(room_of(size, extras)) != room_; }

void ViewBuffers::reserve_pixels(const Gpu& gpu, const Bindings& bindings, glm::uvec2 size, Extras extras)
{
    if (!must_grow(size, extras))
        return;
    const Room room = with(room_of(size, extras));
    room_ = Room(); // until all of it is there
    if (!texels_)
        texels_ = make_screen_texels(gpu, bindings);
    const auto renew = [&](Buffer& buffer, size_t bytes, const char* name) {
        buffer = Buffer(); // given back before the new one is asked for
        buffer = Buffer(gpu, bytes, BufferHome::device, MemoryKind::images, name);
    };
    const auto renew_row = [&](Row row, size_t elements, size_t element_bytes, const char* name) {
        Buffer& buffer = buffers_[row];
        renew(buffer, std::max(elements, size_t(1)) * element_bytes, name);
        if (gpu.device.reads_texels())
            texels_.bind(gpu, row, &buffer, uint32_t(element_bytes / sizeof(uint32_t)));
        return shared::ScreenBuffer { buffer.address(), row, 0 };
    };
    using namespace shared;
#define VKPT_ROW(type, name, elements) rows_.name = renew_row(row_##name, elements, sizeof(type), #name);
#define VKPT_SCREEN_BUFFER(type, name) VKPT_ROW(type, name, room.pixels)
#define VKPT_STRATUM_BUFFER(type, name) VKPT_ROW(type, name, room.strata)
#define VKPT_COUNTED_BUFFER(type, name) VKPT_ROW(type, name, room.counted_pixels)
#define VKPT_BORROWED_BUFFER(type, name, lender)
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
#undef VKPT_ROW
    lend();
    // Updates of the light cache may be more lanes than a small image's pixels.
    const uint32_t cache_groups = tile_groups({ CACHE_ROW, CACHE_MAX_UPDATED / CACHE_ROW });
    const size_t lanes = size_t(std::max(room.trace_groups, cache_groups)) * PIXEL_GROUP_SIZE;
    trace_stack_ = Buffer();
    if (room.trace_groups > 0)
        renew(trace_stack_, lanes * TRACE_STACK_BYTES_PER_LANE, "trace stack");
    room_ = room;
}

void ViewBuffers::exchange_history()
{
#define VKPT_SCREEN_BUFFER(type, name)
#define VKPT_HISTORY_BUFFER(type, name) std::swap(rows_.name, rows_.previous_##name);
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
    lend();
}

void ViewBuffers::lend()
{
#define VKPT_SCREEN_BUFFER(type, name)
#define VKPT_BORROWED_BUFFER(type, name, lender) rows_.name = rows_.lender;
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/view_buffers.hpp"

#include <algorithm>
#include <bit>
#include <type_traits>

namespace vkpt {

namespace {

size_t pixel_count(glm::uvec2 size) { return size_t(size.x) * size.y; }

// Shaders read and write 64-bit words.
template <class Element>
constexpr size_t element_bytes = std::is_same_v<Element, glm::vec3> ? sizeof(glm::vec4) : sizeof(Element);

// By name.
namespace bytes_of {
using namespace shared;
#define VKPT_SCREEN_BUFFER(type, name) constexpr size_t name = element_bytes<type>;
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
} // namespace bytes_of
#define VKPT_SCREEN_BUFFER(type, name)
#define VKPT_BORROWED_BUFFER(type, name, lender) static_assert(bytes_of::name == bytes_of::lender);
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

bool ViewBuffers::must_grow(glm::uvec2 size, bool with_stacks) const
{
    return pixel_count(size) > pixels_ || (with_stacks && tile_groups(size) > groups_);
}

void ViewBuffers::reserve_pixels(const Gpu& gpu, const Bindings& bindings, glm::uvec2 size, bool with_stacks)
{
    if (!must_grow(size, with_stacks))
        return;
    const size_t pixels = std::max(pixels_, pixel_count(size));
    const uint32_t groups = std::max(groups_, tile_groups(size));
    pixels_ = groups_ = 0; // until all of it is there
    if (!texels_)
        texels_ = make_screen_texels(gpu, bindings);
    const auto renew = [&](Buffer& buffer, size_t bytes, const char* name) {
        buffer = Buffer(); // given back before the new one is asked for
        buffer = Buffer(gpu, bytes, BufferHome::device, MemoryKind::images, name);
    };
    const auto renew_row = [&](Row row, size_t elements, size_t element_bytes, const char* name) {
        Buffer& buffer = buffers_[row];
        renew(buffer, elements * element_bytes, name);
        const bool as_texels = gpu.device.reads_texels() && std::has_single_bit(element_bytes);
        if (as_texels)
            texels_.bind(gpu, row, &buffer, uint32_t(element_bytes / sizeof(uint32_t)));
        return shared::ScreenBuffer { buffer.address(), row, 0 };
    };
    using namespace shared;
    // However the pixels are arranged, and with blocks that the edge cuts.
    const size_t strata = pixels / 3 + 1;
#define VKPT_SCREEN_BUFFER(type, name) rows_.name = renew_row(row_##name, pixels, element_bytes<type>, #name);
#define VKPT_STRATUM_BUFFER(type, name) rows_.name = renew_row(row_##name, strata, element_bytes<type>, #name);
#define VKPT_BORROWED_BUFFER(type, name, lender)
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
    lend();
    // Updates of the light cache may be more lanes than a small image's pixels.
    const uint32_t cache_groups = tile_groups({ CACHE_ROW, CACHE_MAX_UPDATED / CACHE_ROW });
    const size_t lanes = size_t(std::max(groups, cache_groups)) * PIXEL_GROUP_SIZE;
    trace_stack_ = Buffer();
    if (with_stacks)
        renew(trace_stack_, lanes * TRACE_STACK_BYTES_PER_LANE, "trace stack");
    pixels_ = pixels;
    groups_ = with_stacks ? groups : 0;
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

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/screen.hpp"

#include <algorithm>
#include <bit>
#include <type_traits>

namespace vkpt {

namespace {

size_t pixel_count(glm::uvec2 size) { return size_t(size.x) * size.y; }

// Shaders read and write 64-bit words.
template <class Element>
constexpr size_t element_bytes = std::is_same_v<Element, glm::vec3> ? sizeof(glm::vec4) : sizeof(Element);

} // namespace

glm::uvec2 count_blocks(glm::uvec2 size, glm::uvec2 block) { return (size + block - 1u) / block; }

uint32_t pixel_groups(glm::uvec2 size)
{
    const glm::uvec2 tiles = count_blocks(size, glm::uvec2(8));
    return (tiles.x * tiles.y + shared::PIXEL_TILES_PER_GROUP - 1) / shared::PIXEL_TILES_PER_GROUP;
}

TexelSet make_screen_texels(const Gpu& gpu, const Bindings& bindings)
{
    return TexelSet(gpu, bindings.screen_layout(), TexelShape::array, shared::SCREEN_BUFFER_COUNT);
}

void Screen::resize_output(VkExtent2D size)
{
    output_.words = Buffer(); // given back before the new one is asked for
    output_.words = Buffer(gpu_, pixel_count({ size.width, size.height }) * sizeof(uint32_t), BufferHome::device,
        MemoryKind::images, "output");
    output_.size = size;
}

bool Screen::must_grow(glm::uvec2 size) const
{
    return pixel_count(size) > view_.pixels || pixel_groups(size) > view_.groups;
}

bool Screen::reserve_pixels(glm::uvec2 size)
{
    if (!must_grow(size))
        return false;
    const size_t pixels = std::max(view_.pixels, pixel_count(size));
    const uint32_t groups = std::max(view_.groups, pixel_groups(size));
    view_.pixels = view_.groups = 0; // until all of it is there
    if (!view_.texels)
        view_.texels = make_screen_texels(gpu_, bindings_);
    const auto renew = [&](Buffer& buffer, size_t bytes, const char* name) {
        buffer = Buffer(); // given back before the new one is asked for
        buffer = Buffer(gpu_, bytes, BufferHome::device, MemoryKind::images, name);
    };
    const auto renew_row = [&](Row row, size_t elements, size_t element_bytes, const char* name) {
        Buffer& buffer = view_.buffers[row];
        renew(buffer, elements * element_bytes, name);
        const bool as_texels = gpu_.device.reads_texels() && std::has_single_bit(element_bytes);
        if (as_texels)
            view_.texels.bind(gpu_, row, &buffer, uint32_t(element_bytes / sizeof(uint32_t)));
        return shared::ScreenBuffer { buffer.address(), row, 0 };
    };
    using namespace shared;
    // However the pixels are arranged, and with blocks that the edge cuts.
    const size_t strata = pixels / 3 + 1;
#define VKPT_SCREEN_BUFFER(type, name)                                                                                 \
    view_.rows.name = renew_row(row_##name, pixels, element_bytes<type>, #name);
#define VKPT_STRATUM_BUFFER(type, name) view_.rows.name = renew_row(row_##name, strata, element_bytes<type>, #name);
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
    const size_t lanes = size_t(groups) * PIXEL_GROUP_SIZE;
    renew(view_.trace_stack, lanes * TRACE_STACK_BYTES_PER_LANE, "trace stack");
    view_.pixels = pixels;
    view_.groups = groups;
    return true;
}

void Screen::exchange_history()
{
#define VKPT_SCREEN_BUFFER(type, name)
#define VKPT_HISTORY_BUFFER(type, name) std::swap(view_.rows.name, view_.rows.previous_##name);
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The device's side of the 2D layer: quads sorted into tiles, memory of the frames in flight, command recording.
#include "ref_vkpt/draw2d/draw2d.hpp"

#include <algorithm>
#include <cstring>

namespace vkpt {

namespace {

constexpr int tile_pixels = int(shared::QUAD_TILE_SIZE);
constexpr VkDeviceSize smallest_memory = 256 << 10;

// Everything that may use the output image before or after the 2D layer.
constexpr VkPipelineStageFlags other_stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT
    | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT
    | VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr VkAccessFlags other_writes
    = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags other_reads
    = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT;

struct TileRange {
    int first_x = 0, last_x = -1, first_y = 0, last_y = -1;
};

// The tiles whose pixels the quad may cover.
TileRange find_tiles(const shared::Quad& quad, int columns, int rows)
{
    const auto to_tile = [](float pixel, int count) {
        // Clamped before the conversion: the engine's numbers may be anything.
        return int(std::clamp(pixel / float(tile_pixels), -1.0f, float(count)));
    };
    TileRange range;
    if (!(quad.corner_max.x > 0 && quad.corner_max.y > 0 && quad.corner_max.x > quad.corner_min.x
            && quad.corner_max.y > quad.corner_min.y))
        return range;
    range.first_x = std::max(to_tile(quad.corner_min.x, columns), 0);
    range.first_y = std::max(to_tile(quad.corner_min.y, rows), 0);
    range.last_x = std::min(to_tile(quad.corner_max.x, columns), columns - 1);
    range.last_y = std::min(to_tile(quad.corner_max.y, rows), rows - 1);
    return range;
}

template <class Visit> void visit_tiles(const TileRange& range, int columns, Visit visit)
{
    for (int y = range.first_y; y <= range.last_y; y++)
        for (int x = range.first_x; x <= range.last_x; x++)
            visit(size_t(y) * size_t(columns) + size_t(x));
}

// Whether nothing below the quad is seen in the pixels of the tile with this corner.
bool hides(const shared::Quad& quad, glm::vec2 tile, VkExtent2D output)
{
    const glm::vec2 first = tile + 0.5f;
    const glm::vec2 last = glm::min(tile + float(tile_pixels), glm::vec2(output.width, output.height)) - 0.5f;
    return (quad.flags & shared::QUAD_OPAQUE) && quad.corner_min.x <= first.x && quad.corner_min.y <= first.y
        && quad.corner_max.x > last.x && quad.corner_max.y > last.y;
}

VkDeviceSize align(VkDeviceSize bytes) { return (bytes + 15) & ~VkDeviceSize(15); }

} // namespace

Draw2d::Draw2d(const Gpu& gpu, Bindings& bindings, Pipelines& pipelines, TextureStore& textures, uint32_t frames)
    : gpu_(gpu)
    , bindings_(bindings)
    , textures_(textures)
    , pipelines_(pipelines)
    , frames_(frames)
{
}

Draw2d::~Draw2d()
{
    vkDeviceWaitIdle(gpu_.device.handle);
    for (const RawImage& image : raw_images_)
        if (image.image)
            bindings_.remove_texture(image.slot);
    for (const FrameMemory& frame : frames_)
        for (const RawImage& image : frame.retired_images)
            bindings_.remove_texture(image.slot);
}

void Draw2d::set_output(VkDeviceAddress words, VkExtent2D size)
{
    output_ = words;
    size_ = size;
}

void Draw2d::record(VkCommandBuffer commands)
{
    sort_into_tiles();
    if (!tiles_.empty()) {
        record_raw_copies(commands);
        record_memory_barrier(commands, other_stages, other_writes, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
        const shared::QuadPush push = upload_lists();
        const DebugLabel label(gpu_.device, commands, "draw_quads");
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_.compute("draw_quads.comp"));
        bindings_.bind(commands, VK_PIPELINE_BIND_POINT_COMPUTE, 0);
        vkCmdPushConstants(commands, bindings_.pipeline_layout(), VK_SHADER_STAGE_ALL, 0, sizeof(push), &push);
        vkCmdDispatch(commands, uint32_t(tiles_.size()), 1, 1);
        record_memory_barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT, other_stages,
            other_writes | other_reads);
    }
    quads_.clear();
    raw_copies_.clear();
}

// A counting sort: quads stay in drawing order within each tile; tiles without quads are left out, and quads that are
// hidden all over a tile.
void Draw2d::sort_into_tiles()
{
    tiles_.clear();
    const int columns = (int(size_.width) + tile_pixels - 1) / tile_pixels;
    const int rows = (int(size_.height) + tile_pixels - 1) / tile_pixels;
    ends_.assign(size_t(columns) * size_t(rows), 0);
    lowest_.assign(ends_.size(), 0);
    const auto place_of = [&](size_t tile) {
        return glm::uvec2(tile % size_t(columns), tile / size_t(columns)) * shared::QUAD_TILE_SIZE;
    };
    for (size_t quad = 0; quad < quads_.size(); quad++)
        visit_tiles(find_tiles(quads_[quad], columns, rows), columns, [&](size_t tile) {
            if (hides(quads_[quad], place_of(tile), size_)) {
                ends_[tile] = 0;
                lowest_[tile] = uint32_t(quad);
            }
            ends_[tile]++;
        });
    uint32_t total = 0;
    for (size_t tile = 0; tile < ends_.size(); tile++) {
        const uint32_t count = ends_[tile];
        ends_[tile] = total;
        if (count == 0)
            continue;
        tiles_.push_back({ place_of(tile), total, count, hides(quads_[lowest_[tile]], place_of(tile), size_) });
        total += count;
    }
    quad_indices_.resize(total);
    for (size_t quad = 0; quad < quads_.size(); quad++)
        visit_tiles(find_tiles(quads_[quad], columns, rows), columns, [&](size_t tile) {
            if (quad >= lowest_[tile])
                quad_indices_[ends_[tile]++] = uint32_t(quad);
        });
}

// Appends to what this frame has used already; a buffer that is too small stays alive until the frame is done.
shared::QuadPush Draw2d::upload_lists()
{
    FrameMemory& frame = frames_[frame_];
    const auto quads = std::as_bytes(std::span(quads_));
    const auto tiles = std::as_bytes(std::span(tiles_));
    const auto indices = std::as_bytes(std::span(quad_indices_));
    const VkDeviceSize bytes = align(quads.size()) + align(tiles.size()) + align(indices.size());
    if (!frame.lists || frame.used + bytes > frame.lists.size()) {
        const VkDeviceSize size = std::max({ smallest_memory, 2 * bytes, frame.lists ? 2 * frame.lists.size() : 0 });
        if (frame.lists)
            frame.retired.push_back(std::move(frame.lists));
        frame.lists = Buffer(gpu_, size, BufferHome::upload, MemoryKind::staging, "2D lists");
        frame.used = 0;
    }
    const auto append = [&](std::span<const std::byte> list) {
        std::memcpy(frame.lists.mapped() + frame.used, list.data(), list.size());
        const VkDeviceAddress address = frame.lists.address() + frame.used;
        frame.used += align(list.size());
        return address;
    };
    shared::QuadPush push {};
    push.quads = append(quads);
    push.tiles = append(tiles);
    push.quad_indices = append(indices);
    push.output_words = output_;
    push.output_size = { size_.width, size_.height };
    push.intensity = brightness_.intensity;
    push.exponent = 1 / brightness_.gamma;
    return push;
}

void Draw2d::record_raw_copies(VkCommandBuffer commands)
{
    for (RawCopy& copy : raw_copies_) {
        const Image& image = raw_images_[copy.image].image;
        record_barrier(commands,
            { image.handle(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                VK_ACCESS_TRANSFER_WRITE_BIT });
        VkBufferImageCopy region {};
        region.imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 };
        region.imageExtent = { image.width(), image.height(), 1 };
        vkCmdCopyBufferToImage(
            commands, copy.staging.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        record_barrier(commands,
            { image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_ACCESS_SHADER_READ_BIT });
        frames_[frame_].retired.push_back(std::move(copy.staging));
    }
}

} // namespace vkpt

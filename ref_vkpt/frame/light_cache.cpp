// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/light_cache.hpp"

#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/frame/frame.hpp"
#include "ref_vkpt/frame/frame_flags.hpp"
#include "ref_vkpt/lights/guides.hpp"
#include "ref_vkpt/vulkan/shaders.hpp"
#include "shaders/shared/light_sampler.h"

#include <algorithm>
#include <cstring>

namespace vkpt {

namespace {

// Samples of each cell that the map begins with, but not more in all.
constexpr uint32_t first_samples = 16, max_first_samples = 1u << 20;
// Cells that a frame takes a sample of.
constexpr uint32_t cells_per_frame = 2048;
static_assert(cells_per_frame <= shared::CACHE_MAX_UPDATED);
// Updates that rays do not see. A-SVGF takes each change of what a repeated sample brings for a change of the light,
// and cells that change a little with every frame would shorten all histories.
constexpr uint32_t frames_per_publication = 32;

// What stands out in the values, which are written anew for that: they also tell which cells are guides.
void upload_guides(Graphics& graphics, const World& world, const std::vector<float>& lightstyles, GpuLightCache& gpu)
{
    const size_t count = world.light_cache.value_count;
    const Buffer copy = graphics.read_back(gpu.values, 2 * count * sizeof(shared::CacheValue));
    std::vector<shared::CacheValue> values(count);
    std::memcpy(values.data(), copy.mapped() + count * sizeof(shared::CacheValue), count * sizeof(shared::CacheValue));
    std::vector<glm::vec3> colours;
    for (const FaceTexture& texture : world.textures)
        colours.push_back(texture.average);
    const LightCacheGuides guides
        = choose_guides({ world.bsp, world.light_cache, world.light_lists, lightstyles, colours }, values);
    engine::print_developer("light cache: {} cells of {} units with {} values, {} guides in {} entries of lists",
        world.light_cache.cells.size(), world.light_cache.cell_size, count, guides.blocks.size(),
        guides.entries.size());
    Uploader& uploader = graphics.uploader;
    gpu.guides = uploader.make_buffer(guides.guides, MemoryKind::lights, "light cache guides");
    gpu.guide_blocks = uploader.make_buffer(guides.blocks, MemoryKind::lights, "light cache blocks");
    gpu.guide_lists = uploader.make_buffer(guides.lists, MemoryKind::lights, "light cache guide lists");
    gpu.guide_entries = uploader.make_buffer(guides.entries, MemoryKind::lights, "light cache guide entries");
    values.insert(values.begin(), count, shared::CacheValue {}); // publish writes what rays read
    gpu.values = uploader.make_buffer(values, MemoryKind::lights, "light cache values");
    uploader.flush();
}

void publish(VkCommandBuffer commands, const GpuLightCache& cache)
{
    record_memory_barrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
        VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    for (const Buffer* table : { &cache.values, &cache.lobes }) {
        const VkDeviceSize half = table->size() / 2;
        const VkBufferCopy region { half, 0, half };
        vkCmdCopyBuffer(commands, table->handle(), table->handle(), 1, &region);
    }
}

bool shows_cache_bias() { return cvars::shader_values().pt_debug_view == shared::DEBUG_VIEW_CACHE_BIAS; }

} // namespace

PassWork cache_update_work(const shared::FrameUniforms& uniforms)
{
    return { { shared::CACHE_ROW, (uniforms.scene.cache.updated + shared::CACHE_ROW - 1) / shared::CACHE_ROW } };
}

shared::LightCacheView GpuLightCache::addresses() const
{
    shared::LightCacheView view {};
    view.faces = faces.address();
    view.planes = planes.address();
    view.cells = cells.address();
    view.corners = corners.address();
    view.values = values.address();
    view.lobes = lobes.address();
    view.guides = guides.address();
    view.guide_blocks = guide_blocks.address();
    view.guide_lists = guide_lists.address();
    view.guide_entries = guide_entries.address();
    view.cell_count = cell_count;
    view.value_count = value_count;
    return view;
}

uint32_t light_cache_needs()
{
    // VKPT_ALWAYS_SUBSET_PPS of update_light_cache.comp
    return uses_light_cache() ? find_light_sampler("subset_pps")->traits & shared::SAMPLER_NEEDS : 0;
}

GpuLightCache upload_light_cache(const LightCacheLayout& layout, Uploader& uploader)
{
    GpuLightCache gpu;
    gpu.faces = uploader.make_buffer(layout.faces, MemoryKind::lights, "light cache faces");
    gpu.planes = uploader.make_buffer(layout.planes, MemoryKind::lights, "light cache planes");
    gpu.cells = uploader.make_buffer(layout.cells, MemoryKind::lights, "light cache cells");
    gpu.corners = uploader.make_buffer(layout.corners, MemoryKind::lights, "light cache corners");
    gpu.values = uploader.make_buffer(
        std::vector<shared::CacheValue>(2 * layout.value_count), MemoryKind::lights, "light cache values");
    gpu.lobes = uploader.make_buffer(std::vector<shared::CacheLobe>(2 * layout.value_count * shared::CACHE_LOBES),
        MemoryKind::lights, "light cache lobes");
    gpu.cell_count = uint32_t(layout.cells.size());
    gpu.value_count = uint32_t(layout.value_count);
    return gpu;
}

// Filtered images read the cache; averaged ones, which are to be right, only aim by it, or correct what they read.
bool LightCacheKeeper::wants_filling(const GpuWorld& gpu_world) const
{
    const CvarValues& cvars = cvars::values();
    return uses_light_cache() && gpu_world.light_cache.cell_count > 0 && world_ != gpu_world.version
        && !(light_cache_needs() & ~gpu_world.sampler_needs)
        && (cvars.pt_accumulate != 0 || cvars::shader_values().flt_denoiser != shared::DENOISER_OFF);
}

void LightCacheKeeper::fill(Graphics& graphics, Frame& frame, View& view, GpuWorld& gpu_world)
{
    const uint32_t count = gpu_world.light_cache.cell_count;
    const uint32_t samples = std::clamp(
        max_first_samples / count, shared::CACHE_MIN_SAMPLES, std::max(first_samples, shared::CACHE_MIN_SAMPLES));
    graphics.finish();
    const uint32_t frames = view.accumulated_frames;
    for (uint32_t first = 0; first < count; first += shared::CACHE_MAX_UPDATED)
        graphics.run_once([&](VkCommandBuffer commands) {
            shared::FrameUniforms uniforms
                = frame.begin_query(commands, view, view.viewpoint, *view.snapshot, gpu_world);
            uniforms.scene.cache.first_updated = first;
            uniforms.scene.cache.updated = std::min(shared::CACHE_MAX_UPDATED, count - first);
            uniforms.scene.cache.samples = samples;
            frame.bind(commands, view, frame.write_uniforms(uniforms));
            record_memory_barrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
                graphics.device.shader_stages(), VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
            const Pass& pass = find_pass(PassId::update_light_cache);
            frame.recorder().record(pass, pass_steps(pass, uniforms)[0]);
        });
    // What was averaged before is an image, and no bias.
    view.accumulated_frames = shows_cache_bias() ? 0 : frames;
    upload_guides(graphics, *view.snapshot->world, view.snapshot->lightstyles, gpu_world.light_cache);
    graphics.run_once([&](VkCommandBuffer commands) { publish(commands, gpu_world.light_cache); });
    world_ = gpu_world.version;
    next_cell_ = 0;
    rounds_ = samples;
    frames_ = 0;
    publications_++;
}

void LightCacheKeeper::begin_frame(
    VkCommandBuffer commands, shared::FrameUniforms& uniforms, const GpuWorld& gpu_world, bool average)
{
    const bool filters = (uniforms.flags & shared::FRAME_DENOISED) != 0;
    if (world_ != gpu_world.version || !uses_light_cache() || !(filters || average))
        return;
    uniforms.flags |= shared::FRAME_GUIDES;
    if (!filters && !corrects_light_cache())
        return;
    uniforms.flags |= shared::FRAME_LIGHT_CACHE;
    if (!filters && shows_cache_bias())
        uniforms.flags |= shared::FRAME_CACHE_BIAS;
    if (frames_++ == frames_per_publication) {
        publish(commands, gpu_world.light_cache);
        publications_++;
        frames_ = 1;
    }
    shared::LightCacheView& cache = uniforms.scene.cache;
    cache.first_updated = next_cell_;
    cache.updated = std::min(cells_per_frame, cache.cell_count);
    cache.first_sample = rounds_;
    cache.samples = 1;
    next_cell_ += cache.updated;
    if (next_cell_ >= cache.cell_count) {
        next_cell_ -= cache.cell_count;
        rounds_++;
    }
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The part of the frame that works across frames: the denoiser and its history. docs/denoiser.md explains the passes.
#include "ref_vkpt/frame/frame.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vkpt {

namespace {

// To the first tap of each further level of the spatial filter, of which the last is part of `accumulate`: pixels.
const glm::ivec2 spread_ways[] = { { 2, 1 }, { -1, 5 }, { 8, 6 }, { -12, 16 } };
// Of the gradient's; odd, so that the result lies in gradient_b.
constexpr uint32_t gradient_levels = 3;

// Of the bloom's pyramid in a picture of so many lines (or columns, where they are fewer). Larger pictures have finer
// levels before the result's, which only hand on; smaller ones lack the finest: so light spreads over the same share of
// all of them.
constexpr int bloom_levels = 5;
constexpr float bloom_lines = 360;
// Below it bloom is left out.
constexpr uint32_t least_bloom_size = 32;

// How many finer levels there are before the result's; negative: how many are left out.
int finer_bloom_levels(glm::uvec2 picture)
{
    return int(std::lround(std::log2(float(std::min(picture.x, picture.y)) / bloom_lines)));
}

// Camera rays pass through so many places of each pixel of the result, one after the other.
constexpr uint32_t offsets_per_pixel = 8;

// Halton's sequence (radical inverse of index + 1).
float halton(uint32_t index, uint32_t base)
{
    float value = 0, digit = 1;
    for (uint32_t rest = index + 1; rest > 0; rest /= base) {
        digit /= float(base);
        value += digit * float(rest % base);
    }
    return value;
}

// Fewer rendered pixels have more places each, so that all pixels of the result get their samples.
glm::vec2 offset_in_pixel(uint32_t index, glm::uvec2 rendered, glm::uvec2 resolved)
{
    const uint64_t pixels = std::max<uint64_t>(1, uint64_t(rendered.x) * rendered.y);
    const uint64_t places = offsets_per_pixel * uint64_t(resolved.x) * resolved.y / pixels;
    index = uint32_t(index % std::clamp<uint64_t>(places, offsets_per_pixel, 16 * offsets_per_pixel));
    return { halton(index, 2), halton(index, 3) };
}

// Pixels that share a bounce ray.
glm::uvec2 bounce_block(const Device& device)
{
    const std::string& pixels = cvars::values().pt_bounce_pixels;
    if (cvars::values().pt_bounces == 0 || pixels == "all")
        return glm::uvec2(1); // without bounces there is next to nothing to share
    return { 2, pixels == "quarter" || (pixels == "auto" && device.is_cpu) ? 2 : 1 };
}

uint32_t stratum_groups(const shared::FrameUniforms& uniforms)
{
    return pixel_groups(count_blocks(uniforms.size, uniforms.bounce_block * shared::STRATUM_BLOCKS));
}

// Whether anything is seen through something that is lit itself: glass, water, translucent models.
bool has_layers(const SceneSnapshot& scene)
{
    return std::ranges::any_of(scene.materials, [](const shared::Material& material) {
        return (material.flags & (shared::MATERIAL_TRANSLUCENT | shared::MATERIAL_FULLBRIGHT))
            == shared::MATERIAL_TRANSLUCENT;
    });
}

} // namespace

// Fills what the filters' passes ask of the uniforms. An averaged view, and one without a world, stays as it is
// sampled.
void Frame::begin_filters(
    shared::FrameUniforms& uniforms, const SceneSnapshot& scene, const GpuWorld* gpu_world, bool average)
{
    const bool upscales = cvars::values().flt_taa == "upscale",
               antialiases = upscales || cvars::values().flt_taa == "on",
               denoises = uniforms.cvars.flt_denoiser != shared::DENOISER_OFF;
    if (!scene.world)
        return;
    if (average || !(antialiases || denoises)) {
        state_.history.forget();
        return;
    }
    if (denoises)
        uniforms.bounce_block = bounce_block(graphics_.device);
    if (upscales)
        uniforms.resolved_size = uniforms.output_size;
    if (antialiases)
        uniforms.pixel_offset = offset_in_pixel(state_.offset_index++, uniforms.size, uniforms.resolved_size);
    uniforms.flags |= shared::FRAME_REPROJECTED | (has_layers(scene) ? shared::FRAME_LAYERED : 0)
        | (antialiases ? shared::FRAME_ANTIALIASED : 0) | (denoises ? shared::FRAME_DENOISED : 0)
        | (uniforms.cvars.flt_denoiser == shared::DENOISER_ASVGF ? shared::FRAME_REPLAYED : 0);
    ViewHistory::Key key;
    key.camera = uniforms.camera;
    key.pixel_offset = uniforms.pixel_offset;
    key.size = uniforms.size;
    key.output_size = uniforms.output_size;
    key.resolved_size = uniforms.resolved_size;
    key.world = gpu_world ? gpu_world->version : 0;
    key.time = scene.time;
    key.denoiser = uniforms.cvars.flt_denoiser;
    key.antialiases = antialiases;
    const ViewHistory::Key& last = state_.history.continues_into(key) ? state_.history.last() : key;
    uniforms.flags |= &last != &key ? shared::FRAME_HISTORY : 0;
    uniforms.previous_camera = last.camera;
    uniforms.previous_size = last.size;
    uniforms.previous_scale = glm::vec2(last.size) / glm::vec2(key.size);
    uniforms.offset_change = last.pixel_offset - 0.5f - (key.pixel_offset - 0.5f) * uniforms.previous_scale;
    state_.history.keep(key);
    graphics_.screen.exchange_history();
    uniforms.screen = graphics_.screen.rows();
}

void Frame::record_denoiser(const shared::FrameUniforms& uniforms)
{
    const uint32_t groups = pixel_groups(uniforms.size);
    if (uniforms.flags & shared::FRAME_REPLAYED)
        record_gradient(uniforms);
    record_pass("denoise_temporal", groups);
    if (uniforms.cvars.flt_denoiser != shared::DENOISER_TEMPORAL)
        record_spatial_filter(groups);
}

// The picture's radiance, and with it the last level of the spatial filter.
void Frame::record_composition(const shared::FrameUniforms& uniforms)
{
    const shared::SpreadPush push { graphics_.screen.rows().filter_b, {}, spread_ways[3] };
    record_level("accumulate", push, pixel_groups(uniforms.size));
    if (uniforms.flags & shared::FRAME_LAYERED)
        record_pass("blend_layers", pixel_groups(uniforms.size));
}

// Before the light passes.
void Frame::record_replay(const shared::FrameUniforms& uniforms)
{
    if ((uniforms.flags & shared::FRAME_REPLAYED) && (uniforms.flags & shared::FRAME_HISTORY))
        record_pass("replay_samples", stratum_groups(uniforms));
}

void Frame::record_gradient(const shared::FrameUniforms& uniforms)
{
    if (!(uniforms.flags & shared::FRAME_HISTORY))
        return;
    const shared::ScreenBuffers& screen = graphics_.screen.rows();
    const uint32_t groups = stratum_groups(uniforms);
    record_pass("denoise_gradient", groups);
    shared::ScreenBuffer source = screen.gradient_a, target = screen.gradient_b;
    for (uint32_t level = 0; level < gradient_levels; level++) {
        record_level("denoise_gradient_filter", shared::FilterPush { source, target, 1u << level, level }, groups);
        std::swap(source, target);
    }
}

// A pyramid of averages, mixed from its top downwards; the result is its first level, which tone_map reads.
void Frame::record_bloom(const shared::FrameUniforms& uniforms)
{
    struct Level {
        uint64_t address;
        glm::uvec2 size;
    };
    const int finer = finer_bloom_levels(uniforms.resolved_size);
    const size_t result = size_t(std::max(finer, 0));
    std::vector<Level> levels(size_t(bloom_levels + finer));
    glm::uvec2 size = count_blocks(uniforms.resolved_size, glm::uvec2(shared::BLOOM_FIRST_STEP));
    for (Level& level : levels) {
        level.size = size;
        size = count_blocks(size, glm::uvec2(2));
    }
    uint64_t address
        = uniforms.screen.bloom.address; // of the result, as its reader expects; the finer levels come last
    for (size_t i = 0; i < levels.size(); i++) {
        Level& level = levels[(result + i) % levels.size()];
        level.address = address;
        address += sizeof(glm::uvec2) * level.size.x * level.size.y;
    }
    const auto record = [&](const char* name, const Level& source, const Level& target, float own_share) {
        record_level(name, shared::BloomPush { source.address, target.address, source.size, target.size, own_share },
            pixel_groups(target.size));
    };
    record("bloom_shrink", { 0, uniforms.resolved_size }, levels[0], 0);
    for (size_t level = 1; level < levels.size(); level++)
        record("bloom_shrink", levels[level - 1], levels[level], 0);
    // Each level counts half as much as the next finer one, and the finest also for those that are left out.
    for (size_t level = levels.size() - 1; level > result; level--)
        record("bloom_grow", levels[level], levels[level - 1],
            level - 1 == result ? 1 - std::exp2(float(std::min(finer, 0) - 1)) : 0.5f);
}

// Leaves bloom out where `uniforms` have none.
void Frame::begin_bloom(shared::FrameUniforms& uniforms)
{
    const glm::uvec2 size = uniforms.resolved_size;
    if (uniforms.cvars.pt_bloom <= 0 || std::min(size.x, size.y) < least_bloom_size)
        return;
    uniforms.flags |= shared::FRAME_BLOOM;
    const uint32_t step = shared::BLOOM_FIRST_STEP << uint32_t(std::max(finer_bloom_levels(size), 0));
    uniforms.bloom_size = count_blocks(size, glm::uvec2(step));
}

// All but the last level. The first level's result is what the next view accumulates on.
void Frame::record_spatial_filter(uint32_t groups)
{
    const shared::ScreenBuffers& screen = graphics_.screen.rows();
    record_level("denoise_filter", shared::FilterPush { screen.filter_a, screen.filtered, 1, 0 }, groups);
    record_level(
        "denoise_spread_first", shared::SpreadPush { screen.filtered, screen.filter_b, spread_ways[0] }, groups);
    record_level("denoise_spread", shared::SpreadPush { screen.filter_b, screen.filter_a, spread_ways[1] }, groups);
    record_level("denoise_spread", shared::SpreadPush { screen.filter_a, screen.filter_b, spread_ways[2] }, groups);
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/bloom.hpp"

#include <algorithm>
#include <cmath>

namespace vkpt {

namespace {

// Of the pyramid in an image of so many lines (or columns, where they are fewer). Larger images have finer levels
// before the result's, which only hand on; smaller ones lack the finest: so light spreads over the same share of all of
// them.
constexpr int bloom_levels = 5;
constexpr float bloom_lines = 360;
// Below it bloom is left out.
constexpr uint32_t min_bloom_size = 32;

// How many finer levels there are before the result's; negative: how many are left out.
int count_finer_levels(glm::uvec2 image)
{
    return int(std::lround(std::log2(float(std::min(image.x, image.y)) / bloom_lines)));
}

struct Level {
    uint64_t address = 0;
    glm::uvec2 size { 0 };
};

struct Pyramid {
    std::vector<Level> levels; // the finest first
    size_t result = 0; // among them: what tone_map reads
};

Pyramid make_pyramid(const shared::FrameUniforms& uniforms)
{
    const int finer = count_finer_levels(uniforms.resolved_size);
    Pyramid pyramid { std::vector<Level>(size_t(bloom_levels + finer)), size_t(std::max(finer, 0)) };
    glm::uvec2 size = count_blocks(uniforms.resolved_size, glm::uvec2(shared::BLOOM_FIRST_STEP));
    for (Level& level : pyramid.levels) {
        level.size = size;
        size = count_blocks(size, glm::uvec2(2));
    }
    // Of the result, as its reader expects; the finer levels come last.
    uint64_t address = uniforms.screen.bloom.address;
    for (size_t i = 0; i < pyramid.levels.size(); i++) {
        Level& level = pyramid.levels[(pyramid.result + i) % pyramid.levels.size()];
        level.address = address;
        address += sizeof(glm::uvec2) * level.size.x * level.size.y;
    }
    return pyramid;
}

PassStep make_level_step(const Level& source, const Level& target, float own_share)
{
    return make_step(shared::BloomPush { source.address, target.address, source.size, target.size, own_share },
        PassWork { target.size });
}

} // namespace

void begin_bloom(shared::FrameUniforms& uniforms)
{
    const glm::uvec2 size = uniforms.resolved_size;
    if (uniforms.cvars.pt_bloom <= 0 || std::min(size.x, size.y) < min_bloom_size)
        return;
    uniforms.flags |= shared::FRAME_BLOOM;
    const uint32_t step = shared::BLOOM_FIRST_STEP << uint32_t(std::max(count_finer_levels(size), 0));
    uniforms.bloom_size = count_blocks(size, glm::uvec2(step));
}

std::vector<PassStep> bloom_shrink_steps(const shared::FrameUniforms& uniforms)
{
    const std::vector<Level> levels = make_pyramid(uniforms).levels;
    std::vector<PassStep> steps { make_level_step({ 0, uniforms.resolved_size }, levels[0], 0) };
    for (size_t level = 1; level < levels.size(); level++)
        steps.push_back(make_level_step(levels[level - 1], levels[level], 0));
    return steps;
}

// Each level counts half as much as the next finer one, and the finest also for those that are left out.
std::vector<PassStep> bloom_grow_steps(const shared::FrameUniforms& uniforms)
{
    const Pyramid pyramid = make_pyramid(uniforms);
    const int left_out = std::min(count_finer_levels(uniforms.resolved_size), 0);
    std::vector<PassStep> steps;
    for (size_t level = pyramid.levels.size() - 1; level > pyramid.result; level--)
        steps.push_back(make_level_step(pyramid.levels[level], pyramid.levels[level - 1],
            level - 1 == pyramid.result ? 1 - std::exp2(float(left_out - 1)) : 0.5f));
    return steps;
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/noise.hpp"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <initializer_list>

namespace vkpt::tools {

namespace {
int wrap(int value, int period)
{
    const int rest = value % period;
    return rest < 0 ? rest + period : rest;
}
}

uint32_t hash_integers(uint32_t x, uint32_t y, uint32_t seed)
{
    uint32_t h = seed * 0x9e3779b9u + 0x7f4a7c15u;
    for (const uint32_t word : { x, y }) {
        h ^= word * 0x85ebca6bu;
        h = (h << 13 | h >> 19) * 5u + 0xe6546b64u;
    }
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    return h ^ h >> 16;
}

float hash_unit(int x, int y, uint32_t seed)
{
    return float(hash_integers(uint32_t(x), uint32_t(y), seed) >> 8) / float(1u << 24);
}

float smooth_noise(glm::vec2 uv, glm::ivec2 cells, uint32_t seed)
{
    const glm::vec2 p = uv * glm::vec2(cells);
    const glm::vec2 base = glm::floor(p);
    const glm::vec2 f = p - base;
    const glm::vec2 w = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
    const int x0 = wrap(int(base.x), cells.x), x1 = x0 + 1 < cells.x ? x0 + 1 : 0;
    const int y0 = wrap(int(base.y), cells.y), y1 = y0 + 1 < cells.y ? y0 + 1 : 0;
    return glm::mix(glm::mix(hash_unit(x0, y0, seed), hash_unit(x1, y0, seed), w.x),
        glm::mix(hash_unit(x0, y1, seed), hash_unit(x1, y1, seed), w.x), w.y);
}

float fractal_noise(glm::vec2 uv, glm::ivec2 cells, int octaves, uint32_t seed)
{
    float sum = 0, weight = 1, total = 0;
    for (int i = 0; i < octaves; i++) {
        sum += weight * smooth_noise(uv, cells, seed + uint32_t(i) * 101u);
        total += weight;
        weight *= 0.5f;
        cells *= 2;
    }
    return sum / total;
}

CellNoise cell_noise(glm::vec2 uv, int cells, uint32_t seed)
{
    const glm::vec2 p = uv * float(cells);
    const glm::ivec2 base(glm::floor(p));
    CellNoise result { 1e9f, 1e9f, 0 };
    for (int dy = -1; dy <= 1; dy++) {
        for (int dx = -1; dx <= 1; dx++) {
            const glm::ivec2 cell = base + glm::ivec2(dx, dy);
            const int x = wrap(cell.x, cells), y = wrap(cell.y, cells);
            const glm::vec2 point = glm::vec2(cell) + glm::vec2(hash_unit(x, y, seed), hash_unit(x, y, seed + 1));
            const float distance = glm::length(point - p);
            if (distance < result.nearest) {
                result.second = result.nearest;
                result.nearest = distance;
                result.id = hash_integers(uint32_t(x), uint32_t(y), seed + 2);
            } else if (distance < result.second) {
                result.second = distance;
            }
        }
    }
    return result;
}

} // namespace vkpt::tools

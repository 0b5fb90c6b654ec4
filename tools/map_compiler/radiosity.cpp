// SPDX-License-Identifier: GPL-2.0-or-later
// Light that is reflected from patch to patch.
#include "common/parallel.hpp"
#include "tools/map_compiler/light_scene.hpp"

#include <algorithm>

namespace vkpt::tools {

namespace {

// Two patches that see each other; stored with the lower one.
struct Exchange {
    uint32_t other;
    float geometry; // (n.w)(-n'.w) / d^2, the same both ways
};

// A smaller part of what leaves a patch is not followed (the classic tool stores transfers in 16 bits).
constexpr double min_transfer = 3.14159265 / 65536;

std::vector<Exchange> find_exchanges(const LightScene& scene, size_t index)
{
    const Patch& a = scene.patches[index];
    std::vector<Exchange> result;
    if (a.cluster < 0)
        return result;
    for (size_t k = index + 1; k < scene.patches.size(); k++) {
        const Patch& b = scene.patches[k];
        if (!scene.is_visible(a.cluster, b.cluster))
            continue;
        const dvec3 way = b.position - a.position;
        const double from = glm::dot(way, a.normal), to = -glm::dot(way, b.normal);
        if (from <= 0 || to <= 0)
            continue;
        const double squared = glm::dot(way, way);
        const double geometry = from * to / (squared * squared);
        if (geometry * std::max(a.area, b.area) < min_transfer || scene.occlusion.is_blocked(a.position, b.position))
            continue;
        result.push_back({ uint32_t(k), float(geometry) });
    }
    return result;
}

} // namespace

size_t bounce_light(LightScene& scene, unsigned threads)
{
    std::vector<Patch>& patches = scene.patches;
    const size_t count = patches.size();
    std::vector<std::vector<Exchange>> exchanges(count);
    parallel_for(count, threads, [&](size_t i) { exchanges[i] = find_exchanges(scene, i); });
    std::vector<double> total(count); // of a patch's transfers: near pi where nothing is hidden
    size_t pair_count = 0;
    for (size_t i = 0; i < count; i++) {
        pair_count += exchanges[i].size();
        for (const Exchange& exchange : exchanges[i]) {
            total[i] += double(exchange.geometry) * patches[exchange.other].area;
            total[exchange.other] += double(exchange.geometry) * patches[i].area;
        }
    }
    std::vector<dvec3> leaving(count), arriving(count, dvec3(0)); // light times area
    for (size_t i = 0; i < count; i++)
        leaving[i] = patches[i].absorbs ? dvec3(0) : patches[i].direct * patches[i].reflectivity * patches[i].area;
    for (int bounce = 0; bounce < bounce_count; bounce++) {
        for (size_t i = 0; i < count; i++)
            for (const Exchange& exchange : exchanges[i]) {
                const size_t k = exchange.other;
                arriving[k] += leaving[i] * (exchange.geometry * patches[k].area / total[i]);
                arriving[i] += leaving[k] * (exchange.geometry * patches[i].area / total[k]);
            }
        for (size_t i = 0; i < count; i++) {
            patches[i].bounced += arriving[i] / patches[i].area;
            leaving[i] = patches[i].absorbs ? dvec3(0) : arriving[i] * patches[i].reflectivity;
            arriving[i] = dvec3(0);
        }
    }
    return pair_count;
}

} // namespace vkpt::tools

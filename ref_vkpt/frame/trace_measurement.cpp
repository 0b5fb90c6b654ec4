// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/trace_measurement.hpp"

#include <glm/geometric.hpp>
#include <random>
#include <vector>

namespace vkpt {

namespace {

// Of rays, in whole tiles of 8 x 8.
struct Grid {
    uint32_t width, height, rounds;
};
// A million on GPUs, as long as the screen buffers that there are have room for them.
constexpr Grid cpu_grid { 320, 184, 5 }, gpu_grid { 1280, 800, 2 }, small_gpu_grid { 640, 400, 4 };

Grid choose_grid(const SceneQueries& queries)
{
    if (!queries.graphics.device.traits.traces_in_parallel)
        return cpu_grid;
    return queries.rays_at_once() >= gpu_grid.width * gpu_grid.height ? gpu_grid : small_gpu_grid;
}

constexpr float ray_far = 1e6f;
constexpr uint32_t ray_mask = shared::MASK_OPAQUE | shared::MASK_ALPHA_TEST | shared::MASK_SKY;

std::vector<TracedRay> camera_rays(const shared::Camera& camera, const Grid& grid)
{
    std::vector<TracedRay> rays;
    for (uint32_t y = 0; y < grid.height; y++)
        for (uint32_t x = 0; x < grid.width; x++) {
            const glm::vec2 at = (glm::vec2(x, y) + 0.5f) / glm::vec2(grid.width, grid.height) * 2.0f - 1.0f;
            rays.push_back(
                { camera.eye, 0, glm::normalize(camera.forward + camera.right * at.x - camera.up * at.y), ray_far });
        }
    return rays;
}

// From what each ray met, a ray back to the side that it came from: towards a random direction, or up to another such
// place.
std::vector<TracedRay> next_rays(std::span<const TracedRay> rays, std::span<const TracedHit> hits, bool shadows)
{
    std::minstd_rand random(1);
    std::uniform_real_distribution<float> uniform(-1, 1);
    const auto place
        = [&](size_t i) { return rays[i].origin + rays[i].direction * (std::min(hits[i].t, ray_far) * 0.999f - 0.1f); };
    std::vector<TracedRay> next;
    for (size_t i = 0; i < rays.size(); i++) {
        const glm::vec3 from = place(i);
        glm::vec3 way(uniform(random), uniform(random), uniform(random));
        if (shadows)
            way = place(random() % rays.size()) - from;
        else if (glm::dot(way, rays[i].direction) > 0)
            way = -way;
        const float length = std::max(glm::length(way), 1e-3f);
        next.push_back({ from, 0, way / length, shadows ? length : ray_far });
    }
    return next;
}

} // namespace

double measure_trace_backend(const SceneQueries& queries, TraceBackend backend)
{
    const TraceBackend before = queries.frame.trace_backend();
    queries.frame.set_trace_backend(backend);
    TraceRequest request;
    request.ray_mask = ray_mask;
    const Grid grid = choose_grid(queries);
    request.row_length = grid.width;
    request.rounds = grid.rounds;
    double seconds = 0;
    const auto trace = [&](const std::vector<TracedRay>& rays) {
        std::vector<TracedHit> hits(rays.size());
        seconds += queries.trace_rays(rays, request, hits.data());
        return hits;
    };
    const std::vector<TracedRay> primary = camera_rays(queries.view.viewpoint.camera, grid);
    const std::vector<TracedHit> hits = trace(primary);
    trace(next_rays(primary, hits, false));
    request.visibility = true;
    trace(next_rays(primary, hits, true));
    queries.frame.set_trace_backend(before);
    return seconds * 1e9 / (3.0 * grid.width * grid.height);
}

} // namespace vkpt

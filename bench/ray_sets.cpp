// SPDX-License-Identifier: GPL-2.0-or-later
#include "bench/ray_sets.hpp"

#include "shaders/shared/trace.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace vkpt::tests {
namespace {

using namespace shared;

constexpr float far_away = 1e5f;

struct SurfacePoint {
    glm::vec3 position, normal; // the normal on the ray's side; the position a little off the surface
};

SurfacePoint surface_point(const MapScene& scene, const TestRay& ray, const TestHit& hit)
{
    const auto& p = scene.triangles[hit.triangle].positions;
    glm::vec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    if (!hit.front)
        normal = -normal;
    return { ray.origin + ray.direction * hit.t + normal * 0.0625f, normal };
}

TestRay bounce_ray(Random& random, const SurfacePoint& from)
{
    glm::vec3 direction = from.normal + random_direction(random); // cosine-distributed
    return { from.position, 0.01f, glm::normalize(direction + from.normal * 1e-3f), far_away };
}

TestRay shadow_ray(Random& random, const MapScene& scene, const SurfacePoint& from)
{
    size_t light
        = scene.lights.empty() ? random() % scene.triangles.size() : scene.lights[random() % scene.lights.size()];
    const auto& p = scene.triangles[light].positions;
    float a = std::sqrt(uniform(random, 0, 1)), b = uniform(random, 0, 1) * a;
    glm::vec3 way = p[0] * (1.0f - a) + p[1] * (a - b) + p[2] * b - from.position;
    float distance = std::max(glm::length(way), 1.0f);
    return { from.position, 0.01f, way / distance, distance - 0.25f };
}

double cpu_seconds()
{
    timespec time {};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) + double(time.tv_nsec) * 1e-9;
}

} // namespace

glm::uvec2 pixel_of(uint32_t index, uint32_t width)
{
    uint32_t tile = index / 64, in_tile = index % 64, tiles_across = width / 8;
    uint32_t x = tile % tiles_across * 8 + in_tile / 16 % 2 * 4 + in_tile % 4;
    uint32_t y = tile / tiles_across * 8 + in_tile / 32 * 4 + in_tile / 4 % 4;
    return { x, y };
}

std::vector<TestRay> camera_rays(const MapScene& scene, glm::uvec2 size)
{
    float yaw = glm::radians(scene.yaw), aspect = float(size.y) / float(size.x);
    glm::vec3 forward(std::cos(yaw), std::sin(yaw), 0), right(std::sin(yaw), -std::cos(yaw), 0), up(0, 0, 1);
    std::vector<TestRay> rays;
    for (uint32_t i = 0; i < size.x * size.y; i++) {
        glm::vec2 at = (glm::vec2(pixel_of(i, size.x)) + 0.5f) / glm::vec2(size);
        glm::vec3 direction = forward + right * (2.0f * at.x - 1.0f) + up * ((1.0f - 2.0f * at.y) * aspect);
        rays.push_back({ scene.eye, 0.0f, glm::normalize(direction), far_away });
    }
    return rays;
}

std::vector<RaySet> make_ray_sets(const MapScene& scene, std::vector<TestRay> camera, std::span<const TestHit> hits)
{
    RaySet primary { "primary", false, {}, {} }, bounce { "bounce", false, {}, {} }, shadow { "shadow", true, {}, {} };
    Random random(1);
    for (uint32_t i = 0; i < camera.size(); i++) {
        primary.places.push_back(i);
        if (hits[i].triangle == TRACE_MISS)
            continue;
        SurfacePoint point = surface_point(scene, camera[i], hits[i]);
        bounce.rays.push_back(bounce_ray(random, point));
        shadow.rays.push_back(shadow_ray(random, scene, point));
        bounce.places.push_back(i);
        shadow.places.push_back(i);
    }
    primary.rays = std::move(camera);
    return { std::move(primary), std::move(bounce), std::move(shadow) };
}

double cpu_seconds_of(const std::function<void()>& work)
{
    double start = cpu_seconds();
    work();
    return cpu_seconds() - start;
}

} // namespace vkpt::tests

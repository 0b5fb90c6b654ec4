// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/module/picture.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace vkpt::tests {

glm::vec3 Radiance::mean(glm::ivec2 first, glm::ivec2 end) const
{
    glm::dvec3 sum(0);
    for (int y = first.y; y < end.y; y++)
        for (int x = first.x; x < end.x; x++)
            sum += glm::dvec3(at(x, y));
    return glm::vec3(sum / double((end.x - first.x) * (end.y - first.y)));
}

size_t count_broken(const Radiance& picture)
{
    size_t count = 0;
    for (const glm::vec3& pixel : picture.pixels)
        for (int i = 0; i < 3; i++)
            count += !(std::isfinite(pixel[i]) && pixel[i] >= 0);
    return count;
}

bool is_black(const Radiance& picture)
{
    return std::ranges::all_of(picture.pixels, [](const glm::vec3& pixel) { return pixel == glm::vec3(0); });
}

double error_between(const Radiance& picture, const Radiance& reference)
{
    double sum = 0;
    for (size_t i = 0; i < picture.pixels.size(); i++)
        sum += std::pow(double(luminance(picture.pixels[i])) - double(luminance(reference.pixels[i])), 2);
    return sum / double(picture.pixels.size());
}

double relative_error(std::span<const float> picture, std::span<const float> reference)
{
    double sum = 0;
    const auto map_tone = [](double x) { return x / (1 + x); };
    for (size_t i = 0; i < picture.size(); i++) {
        const double t = map_tone(double(reference[i])), d = map_tone(double(picture[i])) - t;
        sum += d * d / (t * t + 0.01);
    }
    return sum / double(picture.size());
}

double relative_error(const Radiance& picture, const Radiance& reference)
{
    const auto numbers
        = [](const Radiance& radiance) { return std::span(&radiance.pixels.data()->x, 3 * radiance.pixels.size()); };
    return relative_error(numbers(picture), numbers(reference));
}

CameraRay camera_ray(const engine::RefDef& view, glm::vec2 place)
{
    const float pitch = glm::radians(view.view_angles[0]), yaw = glm::radians(view.view_angles[1]);
    const glm::vec3 forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), -std::sin(pitch));
    const glm::vec3 right(std::sin(yaw), -std::cos(yaw), 0), up = glm::cross(right, forward);
    const glm::vec2 screen = place / glm::vec2(view.width, view.height) * 2.0f - 1.0f;
    const glm::vec3 direction = forward + right * screen.x * std::tan(glm::radians(view.fov_x) / 2)
        - up * screen.y * std::tan(glm::radians(view.fov_y) / 2);
    return { { view.view_origin[0], view.view_origin[1], view.view_origin[2] }, glm::normalize(direction) };
}

bool meets_box(const CameraRay& ray, glm::vec3 mins, glm::vec3 maxs)
{
    float first = 0, last = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        const float a = (mins[axis] - ray.origin[axis]) / ray.direction[axis];
        const float b = (maxs[axis] - ray.origin[axis]) / ray.direction[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last;
}

} // namespace vkpt::tests

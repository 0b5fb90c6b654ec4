// SPDX-License-Identifier: GPL-2.0-or-later
// Captured pictures, and where their pixels look.
#pragma once

#include "common/colour.hpp"
#include "formats/image.hpp"
#include "ref_vkpt/engine/contract.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace vkpt::tests {

struct Radiance {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels; // from the top left
    const glm::vec3& at(int x, int y) const { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
    glm::vec3 mean() const { return mean({ 0, 0 }, { width, height }); }
    glm::vec3 mean(glm::ivec2 first, glm::ivec2 end) const;
    bool operator==(const Radiance&) const = default; // bit for bit, as far as there are no NaN
};

// Values that are not finite, or negative.
size_t count_broken(const Radiance& picture);
bool is_black(const Radiance& picture);
// Mean square difference of luminance; both are of one size.
double error_between(const Radiance& picture, const Radiance& reference);

// Relative squared error of x / (1 + x), so that neither lamps nor a single bright path decide alone
// (docs/denoiser.md). Radiance, all components.
double relative_error(std::span<const float> picture, std::span<const float> reference);
double relative_error(const Radiance& picture, const Radiance& reference);

struct CameraRay {
    glm::vec3 origin, direction;
};
// Through a place of the view in pixels: (0.5, 0.5) is the middle of the first pixel.
CameraRay camera_ray(const engine::RefDef& view, glm::vec2 place);
// Whether the ray meets the box.
bool meets_box(const CameraRay& ray, glm::vec3 mins, glm::vec3 maxs);

} // namespace vkpt::tests

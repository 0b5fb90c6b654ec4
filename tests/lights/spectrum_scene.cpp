// SPDX-License-Identifier: GPL-2.0-or-later
#include "spectrum_scene.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace vkpt::test {

namespace {

constexpr float floor_size = 256; // units
constexpr size_t coarse_step = 4, coarse_side = SpectrumScene::side / coarse_step + 1;
constexpr int quadrature = 4; // points across a light

shared::Emitter make_lamp(std::mt19937& rng)
{
    const auto between = [&](float low, float high) { return low + (high - low) * draw_unit(rng); };
    const glm::vec3 centre(between(-40, floor_size + 40), between(-40, floor_size + 40), between(60, 140));
    const float size = between(4, 16), angle = between(0, 6.28f);
    const glm::vec3 along = size * glm::vec3(std::cos(angle), std::sin(angle), between(-0.3f, 0.3f));
    const glm::vec3 across = size * glm::vec3(-std::sin(angle), std::cos(angle), between(-0.3f, 0.3f));
    shared::Emitter e {};
    e.type = shared::EMITTER_TRIANGLE;
    e.p0 = centre - along - across;
    e.p1 = centre + across;
    e.p2 = centre + along - across;
    if (glm::cross(e.p1 - e.p0, e.p2 - e.p0).z > 0)
        std::swap(e.p1, e.p2);
    e.area = 0.5f * glm::length(glm::cross(e.p1 - e.p0, e.p2 - e.p0));
    e.radiance = glm::vec3(std::exp(between(-1, 1)));
    return e;
}

} // namespace

SpectrumScene::SpectrumScene(size_t light_count, float roughness, uint32_t seed)
{
    std::mt19937 rng(seed);
    for (size_t i = 0; i < light_count; i++) {
        list_.emitters.push_back(make_lamp(rng));
        list_.static_indices.push_back(uint32_t(i));
    }
    list_.range.static_count = uint32_t(light_count);
    list_.make_tables({ 0, uint32_t(light_count) });
    list_.point.roughness = roughness;
    for (size_t y = 0; y < coarse_side; y++)
        for (size_t x = 0; x < coarse_side; x++)
            truth_.push_back(all_samplers().front().integrate(list_at(x * coarse_step, y * coarse_step), quadrature));
}

const ListCase& SpectrumScene::list_at(size_t x, size_t y) const
{
    list_.point.position = glm::vec3(float(x), float(y), 0) * (floor_size / float(side));
    list_.point.view = glm::normalize(glm::vec3(floor_size / 2, -floor_size, 300) - list_.point.position);
    return list_;
}

double SpectrumScene::truth_at(size_t x, size_t y) const
{
    const size_t cx = x / coarse_step, cy = y / coarse_step;
    const double fx = double(x % coarse_step) / coarse_step, fy = double(y % coarse_step) / coarse_step;
    const double* corner = &truth_[cy * coarse_side + cx];
    return (corner[0] * (1 - fx) + corner[1] * fx) * (1 - fy)
        + (corner[coarse_side] * (1 - fx) + corner[coarse_side + 1] * fx) * fy;
}

SpectrumScene::Error SpectrumScene::measure(
    const Sampler& sampler, const SamplerOptions& options, const uint32_t* masks, int frames) const
{
    Error error;
    std::vector<std::vector<double>> pictures(size_t(frames), std::vector<double>(side * side));
    for (int frame = 0; frame < frames; frame++)
        for (size_t y = 0; y < side; y++)
            for (size_t x = 0; x < side; x++) {
                // Frames far apart are independent.
                const PixelNumbers numbers { glm::uvec2(x, y), uint32_t(frame) * 37, 3, masks };
                const double relative = sampler.light_pixel(list_at(x, y), numbers, options) / truth_at(x, y) - 1;
                pictures[size_t(frame)][y * side + x] = relative;
                error.bias += relative / double(side * side) / frames;
                error.variance += relative * relative / double(side * side) / frames;
            }
    error.spectrum = analysis::measure_spectrum(pictures, side);
    return error;
}

} // namespace vkpt::test

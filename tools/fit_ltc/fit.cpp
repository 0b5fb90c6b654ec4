// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/fit_ltc/fit.hpp"

#include "shaders/shared/functions.h"
#include "shaders/shared/ltc.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <numbers>

namespace vkpt::ltc {

namespace {

using namespace shared;
using namespace glm;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "shaders/lib/bsdf.glsl"
#pragma GCC diagnostic pop

constexpr int grid = 32; // samples along each axis of a technique
constexpr int simplex_steps = 160;

using Parameters = std::array<double, 3>; // xx, yy, xz of the matrix in the frame of the lobe's mean direction

// A direction drawn for the lobe, and what the lobe has there.
struct LobeSample {
    vec3 direction;
    double density; // it was drawn with
    double value; // lobe times cosine
};

Surface make_mirror_surface(double roughness, double view_cosine, float albedo)
{
    const float c = float(view_cosine);
    return { vec3(0), vec3(0, 0, 1), vec3(0, 0, 1), vec3(std::sqrt(1 - c * c), 0, c), vec3(albedo), float(roughness),
        1.0f };
}

class Lobe {
public:
    Lobe(double roughness, double view_cosine)
        : white_(make_mirror_surface(roughness, view_cosine, 1)) // a metal of albedo 1: Fresnel factor 1
    {
        Surface black = white_;
        black.albedo = vec3(0); // Fresnel factor (1 - cosine)^5
        dvec3 sum(0);
        for (int i = 0; i < grid * grid; i++) {
            const vec2 xi((float(i % grid) + 0.5f) / grid, (float(i / grid) + 0.5f) / grid);
            const BsdfSample drawn = sample_bsdf(white_, xi, 0);
            if (!(drawn.pdf > 0))
                continue;
            samples_.push_back({ drawn.direction, drawn.pdf, drawn.value.specular.x });
            const double weight = drawn.value.specular.x / drawn.pdf / (grid * grid);
            albedo_ += weight;
            grazing_ += evaluate_bsdf(black, drawn.direction).specular.x / drawn.pdf / (grid * grid);
            sum += dvec3(drawn.direction) * weight;
        }
        mean_ = sum / glm::length(sum);
    }

    double value(vec3 direction) const { return evaluate_bsdf(white_, direction).specular.x / albedo_; }
    double density(vec3 direction) const { return pdf_bsdf(white_, direction); }
    double albedo() const { return albedo_; }
    double grazing() const { return grazing_; }
    dvec3 mean() const { return mean_; }
    const std::vector<LobeSample>& samples() const { return samples_; }

private:
    Surface white_;
    std::vector<LobeSample> samples_;
    double albedo_ = 0, grazing_ = 0;
    dvec3 mean_ { 0, 0, 1 };
};

dmat3 make_matrix(const Lobe& lobe, const Parameters& p)
{
    const dvec3 z = lobe.mean(), x(z.z, 0, -z.x);
    return dmat3(x, dvec3(0, 1, 0), z) * dmat3(p[0], 0, 0, 0, p[1], 0, p[2], 0, 1);
}

// Equation 1 of the paper: the cosine density, transformed.
class TransformedCosine {
public:
    explicit TransformedCosine(const dmat3& matrix)
        : matrix_(matrix)
        , inverse_(glm::inverse(matrix))
        , determinant_(std::abs(glm::determinant(inverse_)))
    {
    }
    double value(dvec3 direction) const
    {
        const dvec3 original = inverse_ * direction;
        const double length = glm::length(original);
        return std::max(original.z / length, 0.0) / std::numbers::pi * determinant_ / (length * length * length);
    }
    dvec3 transform(dvec3 cosine_direction) const { return glm::normalize(matrix_ * cosine_direction); }
    const dmat3& inverse() const { return inverse_; }

private:
    dmat3 matrix_, inverse_;
    double determinant_;
};

double fit_error(const Lobe& lobe, const Parameters& p)
{
    if (p[0] < 1e-4 || p[1] < 1e-4)
        return 2 + std::abs(p[0]) + std::abs(p[1]);
    const TransformedCosine fit(make_matrix(lobe, p));
    double sum = 0;
    const auto add = [&](double wanted, double found, double density) {
        if (wanted + found > 0)
            sum += (wanted - found) * (wanted - found) / (wanted + found) / density;
    };
    for (const LobeSample& sample : lobe.samples()) {
        const double found = fit.value(dvec3(sample.direction));
        add(sample.value / lobe.albedo(), found, sample.density + found);
    }
    for (int i = 0; i < grid * grid; i++) {
        const vec2 xi((float(i % grid) + 0.5f) / grid, (float(i / grid) + 0.5f) / grid);
        const dvec3 direction = fit.transform(dvec3(sample_cosine_direction(vec3(0, 0, 1), xi)));
        const double found = fit.value(direction);
        add(lobe.value(vec3(direction)), found, lobe.density(vec3(direction)) + found);
    }
    return sum / (grid * grid);
}

// Nelder and Mead 1965.
Parameters minimise(const Lobe& lobe, const Parameters& start, double& error)
{
    struct Vertex {
        Parameters p;
        double error;
    };
    std::array<Vertex, 4> simplex;
    simplex[0] = { start, fit_error(lobe, start) };
    for (size_t i = 0; i < 3; i++) {
        Parameters p = start;
        p[i] += i == 2 ? 0.1 : 0.2 * p[i];
        simplex[i + 1] = { p, fit_error(lobe, p) };
    }
    for (int step = 0; step < simplex_steps; step++) {
        std::ranges::sort(simplex, {}, &Vertex::error);
        Parameters centre { 0, 0, 0 };
        for (size_t i = 0; i < 3; i++)
            for (size_t k = 0; k < 3; k++)
                centre[k] += simplex[i].p[k] / 3;
        const auto along = [&](double factor) {
            Parameters p;
            for (size_t k = 0; k < 3; k++)
                p[k] = centre[k] + factor * (simplex[3].p[k] - centre[k]);
            return Vertex { p, fit_error(lobe, p) };
        };
        const Vertex reflected = along(-1);
        if (reflected.error < simplex[0].error) {
            const Vertex expanded = along(-2);
            simplex[3] = expanded.error < reflected.error ? expanded : reflected;
        } else if (reflected.error < simplex[2].error) {
            simplex[3] = reflected;
        } else {
            const Vertex contracted = along(0.5);
            if (contracted.error < simplex[3].error) {
                simplex[3] = contracted;
                continue;
            }
            for (size_t i = 1; i < 4; i++) {
                for (size_t k = 0; k < 3; k++)
                    simplex[i].p[k] = simplex[0].p[k] + 0.5 * (simplex[i].p[k] - simplex[0].p[k]);
                simplex[i].error = fit_error(lobe, simplex[i].p);
            }
        }
    }
    const Vertex& best = *std::ranges::min_element(simplex, {}, &Vertex::error);
    error = best.error;
    return best.p;
}

} // namespace

Entry fit_lobe(double roughness, double view_cosine)
{
    const Lobe lobe(roughness, view_cosine);
    const double alpha = roughness * roughness;
    Entry entry {};
    const Parameters best = minimise(lobe, { alpha, alpha, 0 }, entry.error);
    const dmat3 inverse = TransformedCosine(make_matrix(lobe, best)).inverse();
    const double scale = 1 / inverse[2][2];
    entry.xx = scale * inverse[0][0];
    entry.xz = scale * inverse[2][0];
    entry.yy = scale * inverse[1][1];
    entry.zx = scale * inverse[0][2];
    entry.albedo = lobe.albedo();
    entry.grazing = lobe.grazing();
    return entry;
}

std::vector<Entry> fit_table()
{
    constexpr double last = LTC_SIZE - 1, min_cosine = 0.01; // at 0 there is no lobe
    std::vector<Entry> table;
    for (uint row = 0; row < LTC_SIZE; row++)
        for (uint column = 0; column < LTC_SIZE; column++) {
            const double x = column / last;
            table.push_back(fit_lobe(
                LTC_MIN_ROUGHNESS + (1 - double(LTC_MIN_ROUGHNESS)) * row / last, std::max(1 - x * x, min_cosine)));
        }
    return table;
}

} // namespace vkpt::ltc

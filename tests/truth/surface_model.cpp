// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/truth/surface_model.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace vkpt::truth {

using glm::dvec3;
using std::numbers::pi;

namespace {

double alpha_of(const SurfacePoint& s) { return std::max(s.roughness * s.roughness, 1e-3); }

double fifth_power(double x) { return x * x * x * x * x; }

// Trowbridge-Reitz.
double distribution(double cosine, double alpha)
{
    const double d = cosine * cosine * (alpha * alpha - 1) + 1;
    return cosine > 0 ? alpha * alpha / (pi * d * d) : 0;
}

// Height-correlated masking and shadowing over 4 nl nv (Heitz 2014, equations 99 and 72).
double visibility(double nl, double nv, double alpha)
{
    const auto lambda = [&](double cosine) {
        const double tangent2 = 1 / (cosine * cosine) - 1;
        return (std::sqrt(1 + alpha * alpha * tangent2) - 1) / 2;
    };
    return 1 / (1 + lambda(nl) + lambda(nv)) / (4 * nl * nv);
}

// The coat's reflectance by Schlick's formula; it fades out over the last fifth of roughness.
double coat(const SurfacePoint& s, double power)
{
    const double strength = s.specular * std::clamp(5 * (1 - s.roughness), 0.0, 1.0), f0 = 0.04;
    return strength * (f0 + (1 - f0) * power);
}

// What the base reflects through the coat, both ways.
double base(const SurfacePoint& s, double nl, double nv)
{
    const double rise = 1 - 0.9 * s.roughness * s.roughness;
    const double in = 1 - coat(s, rise * fifth_power(1 - nl)), out = 1 - coat(s, rise * fifth_power(1 - nv));
    const double mean = coat(s, rise / 21);
    return (1 - s.metallic) * in * out / ((1 - mean) * pi);
}

} // namespace

dvec3 turn_to(dvec3 axis, dvec3 local)
{
    const dvec3 other = std::abs(axis.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 tangent = glm::normalize(glm::cross(axis, other));
    return tangent * local.x + glm::cross(axis, tangent) * local.y + axis * local.z;
}

dvec3 reflect_light(const SurfacePoint& s, dvec3 light)
{
    const double nl = glm::dot(s.normal, light), nv = glm::dot(s.normal, s.view);
    if (nl <= 0 || nv <= 0 || glm::dot(s.geometric_normal, light) <= 0)
        return dvec3(0);
    const dvec3 half = glm::normalize(light + s.view);
    const double power = fifth_power(1 - std::min(glm::dot(s.view, half), 1.0)), alpha = alpha_of(s);
    const dvec3 metal = s.albedo + (1.0 - s.albedo) * power;
    const dvec3 fresnel = glm::mix(dvec3(coat(s, power)), metal, s.metallic);
    const double lobe = distribution(glm::dot(s.normal, half), alpha) * visibility(nl, nv, alpha);
    return nl * (s.albedo * base(s, nl, nv) + fresnel * lobe);
}

ScatteredRay scatter(const SurfacePoint& s, dvec3 xi)
{
    const bool is_matte = s.roughness >= 1 && s.metallic <= 0;
    const double share = is_matte ? 0 : s.metallic >= 1 ? 1 : 0.5, around = 2 * pi * xi.y, alpha = alpha_of(s);
    ScatteredRay ray;
    if (xi.z < share) {
        const double cosine = std::sqrt((1 - xi.x) / (1 + (alpha * alpha - 1) * xi.x));
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        const dvec3 half = turn_to(s.normal, { sine * std::cos(around), sine * std::sin(around), cosine });
        ray.direction = glm::normalize(half * (2 * glm::dot(s.view, half)) - s.view);
    } else {
        const double sine = std::sqrt(xi.x);
        ray.direction = turn_to(s.normal, { sine * std::cos(around), sine * std::sin(around), std::sqrt(1 - xi.x) });
    }
    if (glm::dot(ray.direction, s.normal) <= 0)
        return ray;
    const dvec3 half = glm::normalize(ray.direction + s.view);
    const double nh = glm::dot(s.normal, half), vh = std::max(glm::dot(s.view, half), 1e-12);
    ray.pdf = share * distribution(nh, alpha) * nh / (4 * vh) + (1 - share) * glm::dot(ray.direction, s.normal) / pi;
    return ray;
}

} // namespace vkpt::truth

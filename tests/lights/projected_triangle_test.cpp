// SPDX-License-Identifier: GPL-2.0-or-later
// Points on triangles, evenly spread over the projected solid angle.
#include "glsl_libraries.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace vkpt::test {
namespace {

using namespace glsl;

constexpr LightOptions projected { 8, LIGHT_WEIGHT_BRDF_CENTRE, LIGHT_POINT_PROJECTED, {}, {} };
constexpr LightOptions by_area { 8, LIGHT_WEIGHT_BRDF_CENTRE, LIGHT_POINT_AREA, {}, {} };

struct Case {
    Emitter emitter;
    Surface surface;
};

Case make_random_case(std::mt19937& rng)
{
    std::normal_distribution<float> gauss;
    const auto vector = [&] { return vec3(gauss(rng), gauss(rng), gauss(rng)); };
    Case c {};
    const vec3 normal = normalize(vector());
    c.surface = Surface { vector() * 100.0f, normal, normal, normal, vec3(0.5f), 1, 0 };
    const vec3 centre = c.surface.position + normalize(vector() + normal) * 50.0f;
    const float size = std::exp(4 * (float(rng() % 1000) / 1000) - 1);
    c.emitter.p0 = centre + vector() * size;
    c.emitter.p1 = centre + vector() * size;
    c.emitter.p2 = centre + vector() * size;
    if (view_triangle(c.emitter, c.surface.position).volume < 0)
        std::swap(c.emitter.p1, c.emitter.p2);
    c.emitter.radiance = vec3(1);
    c.emitter.area = 0.5f * length(cross(c.emitter.p1 - c.emitter.p0, c.emitter.p2 - c.emitter.p0));
    return c;
}

ProjectedTriangle project(const Case& c)
{
    const TriangleAspect t = view_triangle(c.emitter, c.surface.position);
    return project_triangle(t.a, t.b, t.c, c.surface.normal);
}

// On a matte surface each point is worth the same: no variance.
TEST(ProjectedTriangle, EverySampleIsWorthTheWhole)
{
    std::mt19937 rng(1);
    std::uniform_real_distribution<float> unit(0, 1);
    int told = 0;
    for (int i = 0; i < 3000; i++) {
        const Case c = make_random_case(rng);
        const float area = project(c).area;
        if (area < min_projected_angle)
            continue;
        told++;
        for (int k = 0; k < 8; k++) {
            const EmitterSample drawn
                = sample_emitter_point(c.emitter, c.surface, vec2(unit(rng), unit(rng)), projected);
            ASSERT_GT(drawn.pdf, 0);
            const float cosine = dot(drawn.direction, c.surface.normal);
            ASSERT_NEAR(cosine / drawn.pdf, area, 1e-5f * area) << "case " << i;
            ASSERT_NEAR(drawn.pdf, pdf_emitter_point(c.emitter, c.surface, drawn.point, projected), 0.01f * drawn.pdf);
        }
    }
    EXPECT_GT(told, 1500);
}

// Equal parts of the triangle's projection receive equal numbers of samples: chi-square over parts cut through its
// middle.
TEST(ProjectedTriangle, SamplesSpreadEvenly)
{
    std::mt19937 rng(2);
    constexpr int n = 96;
    int told = 0;
    for (int i = 0; i < 300; i++) {
        const Case c = make_random_case(rng);
        const float whole = project(c).area;
        if (whole < 0.01f)
            continue;
        told++;
        const vec3 corners[3] = { c.emitter.p0, c.emitter.p1, c.emitter.p2 };
        const vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0f;
        double shares[3];
        for (int k = 0; k < 3; k++) {
            Case part = c;
            part.emitter.p0 = middle;
            part.emitter.p1 = corners[k];
            part.emitter.p2 = corners[(k + 1) % 3];
            shares[k] = project(part).area / whole;
        }
        ASSERT_NEAR(shares[0] + shares[1] + shares[2], 1, 2e-3) << i;
        double counts[3] = { 0, 0, 0 };
        for (int x = 0; x < n; x++)
            for (int y = 0; y < n; y++) {
                const vec2 xi((float(x) + 0.5f) / n, (float(y) + 0.5f) / n);
                const EmitterSample drawn = sample_emitter_point(c.emitter, c.surface, xi, projected);
                const vec3 p = drawn.point;
                const vec3 across = cross(c.emitter.p1 - c.emitter.p0, c.emitter.p2 - c.emitter.p0);
                int part = 0;
                for (int k = 0; k < 3; k++) {
                    const bool after = dot(cross(corners[k] - middle, p - middle), across) >= 0;
                    const bool before = dot(cross(p - middle, corners[(k + 1) % 3] - middle), across) >= 0;
                    if (after && before)
                        part = k;
                }
                counts[part] += 1.0 / (n * n);
            }
        for (int k = 0; k < 3; k++)
            ASSERT_NEAR(counts[k], shares[k], 0.02) << "case " << i << ", part " << k;
    }
    EXPECT_GT(told, 50);
}

TEST(ProjectedTriangle, SamplesLieOnTheTriangleAboveTheHorizon)
{
    std::mt19937 rng(3);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 3000; i++) {
        const Case c = make_random_case(rng);
        if (project(c).area < min_projected_angle)
            continue;
        for (const float xi : { 0.0f, unit(rng), 0.99999994f }) {
            const EmitterSample drawn = sample_emitter_point(c.emitter, c.surface, vec2(xi, unit(rng)), projected);
            ASSERT_GE(dot(drawn.direction, c.surface.normal), 0);
            const vec3 p = drawn.point;
            const Emitter& e = c.emitter;
            const double areas = length(cross(dvec3(e.p1 - p), dvec3(e.p2 - p)))
                + length(cross(dvec3(e.p2 - p), dvec3(e.p0 - p))) + length(cross(dvec3(e.p0 - p), dvec3(e.p1 - p)));
            ASSERT_NEAR(areas / (2 * e.area), 1, 0.03) << "case " << i;
        }
    }
}

TEST(PointsByArea, HaveTheDensityOfTheArea)
{
    std::mt19937 rng(4);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 1000; i++) {
        const Case c = make_random_case(rng);
        if (view_triangle(c.emitter, c.surface.position).solid_angle < 1e-5f)
            continue;
        const vec2 xi(unit(rng), unit(rng));
        const EmitterSample drawn = sample_emitter_point(c.emitter, c.surface, xi, by_area);
        const vec3 normal = normalize(cross(c.emitter.p1 - c.emitter.p0, c.emitter.p2 - c.emitter.p0));
        const float cosine = -dot(drawn.direction, normal);
        ASSERT_NEAR(drawn.pdf * cosine * c.emitter.area / (drawn.distance * drawn.distance), 1, 2e-3) << i;
    }
}

} // namespace
} // namespace vkpt::test

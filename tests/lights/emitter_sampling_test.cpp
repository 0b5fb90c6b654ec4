// SPDX-License-Identifier: GPL-2.0-or-later
#include "glsl_libraries.hpp"

#include "ref_vkpt/lights/spot_cone.hpp"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

namespace vkpt::test {
namespace {

using namespace glsl;

Emitter make_triangle(vec3 p0, vec3 p1, vec3 p2)
{
    Emitter e {};
    e.type = EMITTER_TRIANGLE;
    e.p0 = p0;
    e.p1 = p1;
    e.p2 = p2;
    e.area = 0.5f * length(cross(p1 - p0, p2 - p0));
    e.radiance = vec3(2);
    return e;
}

Emitter make_sphere(vec3 centre, float radius)
{
    Emitter e {};
    e.type = EMITTER_SPHERE;
    e.p0 = centre;
    e.p1 = vec3(radius, 0, 0);
    e.area = 4 * emitter_pi * radius * radius;
    e.radiance = vec3(2);
    return e;
}

Surface make_surface(vec3 position, vec3 normal)
{
    return Surface { position, normal, normal, normal, vec3(0.5f), 0.5f, 0 };
}

constexpr LightOptions by_solid_angle { 8, LIGHT_WEIGHT_BRDF_CENTRE, LIGHT_POINT_SOLID_ANGLE, {}, {} };

EmitterSample sample_point(const Emitter& e, vec3 receiver, vec2 xi)
{
    return sample_emitter_point(e, make_surface(receiver, vec3(0, 0, 1)), xi, by_solid_angle);
}
float pdf_point(const Emitter& e, vec3 receiver, vec3 point)
{
    return pdf_emitter_point(e, make_surface(receiver, vec3(0, 0, 1)), point, by_solid_angle);
}
float contribution_of(const Surface& s, const Emitter& e)
{
    return light_contribution(make_predictor(s, by_solid_angle), e);
}

std::vector<dvec3> clip_polygon_to_horizon(const std::vector<dvec3>& polygon, dvec3 normal)
{
    std::vector<dvec3> kept;
    for (size_t i = 0; i < polygon.size(); i++) {
        const dvec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double ha = dot(a, normal), hb = dot(b, normal);
        if (ha > 0)
            kept.push_back(a);
        if ((ha > 0) != (hb > 0))
            kept.push_back(a + (b - a) * (ha / (ha - hb)));
    }
    return kept;
}

// Lambert's formula: E = L / 2 |sum over edges of angle * n . unit(v_i x v_j)|, over the part above the horizon.
double irradiance_of_polygon(const Emitter& e, vec3 receiver, vec3 normal)
{
    const dvec3 origin(receiver), n(normal);
    const std::vector<dvec3> polygon
        = clip_polygon_to_horizon({ dvec3(e.p0) - origin, dvec3(e.p1) - origin, dvec3(e.p2) - origin }, n);
    double sum = 0;
    for (size_t i = 0; i < polygon.size(); i++) {
        const dvec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const dvec3 across = cross(a, b);
        if (length(across) > 0)
            sum += std::atan2(length(across), dot(a, b)) * dot(n, across) / length(across);
    }
    return std::abs(sum) * 0.5 * e.radiance.x;
}

double estimate_irradiance(const Emitter& e, vec3 receiver, vec3 normal, int n = 512)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            const vec2 xi((float(i) + 0.5f) / float(n), (float(j) + 0.5f) / float(n));
            const EmitterSample drawn = sample_point(e, receiver, xi);
            if (drawn.pdf > 0)
                sum += drawn.radiance.x * std::max(0.0f, dot(normal, drawn.direction)) / drawn.pdf;
        }
    return sum / (double(n) * n);
}

struct TriangleCase {
    const char* name;
    Emitter emitter;
    vec3 receiver, normal;
};

std::vector<TriangleCase> triangle_cases()
{
    const vec3 up(0, 0, 1), far_away(3000, -2000, 500);
    const auto facing_down = [](vec3 a, vec3 b, vec3 c) { return make_triangle(a, c, b); };
    return {
        { "overhead", facing_down({ -32, -32, 64 }, { 32, -32, 64 }, { 0, 32, 64 }), vec3(0), up },
        { "huge and near", facing_down({ -900, -900, 4 }, { 900, -900, 4 }, { 0, 900, 4 }), vec3(0), up },
        { "touching nearly", facing_down({ -100, -100, 0.1f }, { 100, -100, 0.1f }, { 0, 100, 0.1f }), vec3(0), up },
        { "oblique", facing_down({ 100, 0, 40 }, { 180, 20, 50 }, { 120, 90, 60 }), vec3(3, 4, 0), up },
        { "crossing the horizon", make_triangle({ 64, -40, -50 }, { 64, 0, 80 }, { 64, 40, -30 }), vec3(0), up },
        { "sliver", facing_down({ -200, 0, 64 }, { 200, 0, 64 }, { 200, 1, 64 }), vec3(10, 20, 0), up },
        { "small", facing_down({ 0, 0, 256 }, { 4, 0, 256 }, { 0, 4, 256 }), vec3(30, 0, 0), up },
        { "tiny and far from the origin",
            facing_down(far_away + vec3(0, 0, 900), far_away + vec3(2, 0, 900), far_away + vec3(0, 2, 900)), far_away,
            up },
        { "tilted normal", facing_down({ -32, -32, 64 }, { 32, -32, 64 }, { 0, 32, 64 }), vec3(0),
            normalize(vec3(1, 0.5f, 0.3f)) },
    };
}

TEST(EmitterSampling, TriangleMatchesLambertsFormula)
{
    for (const TriangleCase& c : triangle_cases()) {
        const double truth = irradiance_of_polygon(c.emitter, c.receiver, c.normal);
        ASSERT_GT(truth, 0) << c.name;
        EXPECT_NEAR(estimate_irradiance(c.emitter, c.receiver, c.normal), truth, 0.005 * truth) << c.name;
    }
}

TEST(EmitterSampling, TrianglePointsLieOnTheTriangleWithTheReportedDensity)
{
    std::mt19937 rng(3);
    std::uniform_real_distribution<float> unit(0, 1);
    for (const TriangleCase& c : triangle_cases()) {
        const Emitter& e = c.emitter;
        const vec3 across = cross(e.p1 - e.p0, e.p2 - e.p0);
        const float size = std::sqrt(e.area);
        for (int i = 0; i < 2000; i++) {
            const EmitterSample drawn = sample_point(e, c.receiver, vec2(unit(rng), unit(rng)));
            ASSERT_GT(drawn.pdf, 0) << c.name;
            ASSERT_NEAR(drawn.pdf, pdf_point(e, c.receiver, drawn.point), 2e-3f * drawn.pdf) << c.name;
            const vec3 p = drawn.point;
            const float tolerance = 2e-3f * size + 2e-6f * length(p);
            ASSERT_LT(std::abs(dot(p - e.p0, normalize(across))), tolerance) << c.name;
            const float areas = length(cross(e.p1 - p, e.p2 - p)) + length(cross(e.p2 - p, e.p0 - p))
                + length(cross(e.p0 - p, e.p1 - p));
            ASSERT_NEAR(areas, 2 * e.area, 0.01f * e.area + 4 * size * tolerance) << c.name;
        }
    }
}

// Uniform in solid angle: the share of points in a part of the triangle is the part's share of the solid angle.
TEST(EmitterSampling, TrianglePointsAreUniformInSolidAngle)
{
    const vec3 receiver(0);
    const vec3 a(-50, -60, 30), b(80, -20, 40), c(10, 90, 120);
    const vec3 cut = (a + c) * 0.5f;
    const Emitter whole = make_triangle(a, c, b), part = make_triangle(a, cut, b);
    const double share = view_triangle(part, receiver).solid_angle / view_triangle(whole, receiver).solid_angle;
    constexpr int n = 1000;
    int inside = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            const EmitterSample drawn
                = sample_point(whole, receiver, vec2((float(i) + 0.5f) / n, (float(j) + 0.5f) / n));
            // In `part` if on a's side of the plane through the receiver, the cut and b.
            inside += dot(drawn.direction, cross(cut, b)) * dot(a, cross(cut, b)) > 0;
        }
    EXPECT_NEAR(double(inside) / (double(n) * n), share, 0.002);
}

TEST(EmitterSampling, TrianglesAreOneSided)
{
    const Emitter e = make_triangle({ -32, -32, 64 }, { 32, -32, 64 }, { 0, 32, 64 }); // faces up
    EXPECT_EQ(sample_point(e, vec3(0), vec2(0.3f, 0.6f)).pdf, 0);
    EXPECT_EQ(pdf_point(e, vec3(0), vec3(0, 0, 64)), 0);
    EXPECT_EQ(contribution_of(make_surface(vec3(0), vec3(0, 0, 1)), e), 0);
    EXPECT_EQ(sample_point(e, vec3(5, 5, 64), vec2(0.3f, 0.6f)).pdf, 0); // in its plane
}

TEST(EmitterSampling, SphereMatchesTheFormula)
{
    for (const float radius : { 0.5f, 4.0f, 40.0f })
        for (const float distance : { 41.0f, 100.0f, 2000.0f })
            for (const float cosine : { 1.0f, 0.99f }) {
                const vec3 receiver(500, -300, 100), normal = normalize(vec3(1, 2, 3));
                const vec3 axis = normalize(normal * cosine + any_tangent(normal) * std::sqrt(1 - cosine * cosine));
                const Emitter e = make_sphere(receiver + axis * distance, radius);
                const bool above_horizon = distance * dot(axis, normal) > radius;
                const double truth
                    = M_PI * 2 * double(radius) * radius / (double(distance) * distance) * dot(axis, normal);
                if (above_horizon) {
                    EXPECT_NEAR(estimate_irradiance(e, receiver, normal), truth, 0.005 * truth)
                        << radius << ' ' << distance;
                }
            }
}

TEST(EmitterSampling, SphereAroundTheReceiverLightsFromEverywhere)
{
    const Emitter e = make_sphere(vec3(1, 2, 3), 8);
    EXPECT_NEAR(estimate_irradiance(e, vec3(0), vec3(0, 0, 1)), 2 * M_PI, 0.005 * 2 * M_PI);
    const EmitterSample drawn = sample_point(e, vec3(0), vec2(0.2f, 0.7f));
    EXPECT_NEAR(length(drawn.point - e.p0), 8, 1e-3);
}

TEST(EmitterSampling, SpherePointsLieOnItsNearSide)
{
    std::mt19937 rng(5);
    std::uniform_real_distribution<float> unit(0, 1);
    const Emitter e = make_sphere(vec3(100, 50, 70), 12);
    for (int i = 0; i < 2000; i++) {
        const EmitterSample drawn = sample_point(e, vec3(0), vec2(unit(rng), unit(rng)));
        ASSERT_NEAR(length(drawn.point - e.p0), 12, 0.01);
        ASSERT_LT(dot(drawn.point - e.p0, drawn.direction), 0.01f);
        ASSERT_FLOAT_EQ(drawn.pdf, pdf_point(e, vec3(0), drawn.point));
    }
}

TEST(EmitterSampling, LightEndsAtItsReach)
{
    Emitter e = make_sphere(vec3(0, 0, 50), 4);
    e.reach = 100;
    const Surface near_by = make_surface(vec3(0), vec3(0, 0, 1)),
                  beyond = make_surface(vec3(0, 0, -50.1f), vec3(0, 0, 1));
    EXPECT_NEAR(emitted_radiance(e, near_by.position).x, 2 * 0.9375f * 0.9375f, 1e-5);
    EXPECT_GT(contribution_of(near_by, e), 0);
    EXPECT_EQ(emitted_radiance(e, beyond.position).x, 0);
    EXPECT_EQ(contribution_of(beyond, e), 0);
}

// A spot by the cosine at which its light begins to fade, and ends.
Emitter make_spot(vec3 centre, float radius, vec3 axis, float inner, float outer)
{
    Emitter e = make_sphere(centre, radius);
    set_cone(e, axis, inner, outer);
    return e;
}

TEST(EmitterSampling, SpotsShineInTheirConesOnly)
{
    const Emitter spot = make_spot(vec3(0, 0, 100), 2, vec3(0, 0, -1), 0.95f, 0.85f);
    const Emitter ball = make_sphere(vec3(0, 0, 100), 2);
    for (const float angle : { 0.0f, 0.2f, 0.4f, 0.5f, 0.6f, 1.0f, 2.0f }) {
        const vec3 receiver(100 * std::sin(angle), 0, 100 - 100 * std::cos(angle));
        const vec3 normal = normalize(spot.p0 - receiver);
        const double share = std::clamp((std::cos(double(angle)) - 0.85) / 0.1, 0.0, 1.0);
        const double whole = estimate_irradiance(ball, receiver, normal, 64);
        EXPECT_NEAR(estimate_irradiance(spot, receiver, normal, 64), share * whole, 1e-4 * whole) << angle;
        const Surface s = make_surface(receiver, normal);
        const double weight = contribution_of(s, spot), weight_of_ball = contribution_of(s, ball);
        EXPECT_NEAR(weight, share * weight_of_ball, 0.01 * weight_of_ball) << angle;
        EXPECT_TRUE(weight > 0 || share == 0) << angle;
    }
}

Emitter make_random_emitter(std::mt19937& rng)
{
    std::normal_distribution<float> gauss;
    const float scale = std::exp(2 * gauss(rng)), spread = std::exp(2 * gauss(rng));
    const auto point = [&] { return vec3(gauss(rng), gauss(rng), gauss(rng)); };
    const vec3 centre = point() * scale * 10.0f;
    if (rng() % 3 == 0)
        return make_sphere(centre, scale * spread);
    if (rng() % 6 == 0) {
        const float outer = 1 - 2 * float(rng() % 1000) / 1001;
        return make_spot(centre, scale * spread, normalize(-centre + 0.5f * length(centre) * point()),
            outer + 0.02f * (1 - outer), outer);
    }
    return make_triangle(centre + point() * spread, centre + point() * spread, centre + point() * spread);
}

// A weight of 0 where light arrives would be bias.
TEST(LightContribution, IsNeverZeroWhereLightArrives)
{
    std::mt19937 rng(6);
    std::uniform_real_distribution<float> unit(0, 1);
    std::normal_distribution<float> gauss;
    int lit = 0;
    for (int i = 0; i < 20000; i++) {
        const Emitter e = make_random_emitter(rng);
        Surface s = make_surface(vec3(0), normalize(vec3(gauss(rng), gauss(rng), gauss(rng))));
        s.view = normalize(s.normal + 0.9f * normalize(vec3(gauss(rng), gauss(rng), gauss(rng))));
        s.geometric_normal = normalize(s.normal + 0.2f * vec3(gauss(rng), gauss(rng), gauss(rng)));
        s.roughness = unit(rng);
        s.metallic = i % 4 == 0 ? 1.0f : 0.0f;
        s.albedo = i % 8 == 0 ? vec3(0) : vec3(unit(rng));
        bool receives = false;
        for (int j = 0; j < 64; j++) {
            const EmitterSample drawn = sample_point(e, s.position, vec2(unit(rng), unit(rng)));
            const vec3 light = reflected_radiance(s, evaluate_bsdf(s, drawn.direction), drawn.radiance);
            receives |= drawn.pdf > 0 && light.x > 0;
        }
        const float weight = contribution_of(s, e);
        ASSERT_TRUE(std::isfinite(weight) && weight >= 0);
        ASSERT_TRUE(weight > 0 || !receives) << "case " << i;
        lit += receives;
    }
    EXPECT_GT(lit, 5000);
}

// On diffuse surfaces the prediction must follow the truth within a factor, for lights well above the horizon.
TEST(LightContribution, FollowsTheTruthOnDiffuseSurfaces)
{
    std::mt19937 rng(7);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int i = 0; i < 500; i++) {
        const vec3 centre(100 * unit(rng), 100 * unit(rng), 150);
        const auto corner = [&] { return centre + vec3(10 * unit(rng), 10 * unit(rng), 10 * unit(rng)); };
        Emitter e = make_triangle(corner(), corner(), corner());
        if (view_triangle(e, vec3(0)).volume < 0)
            std::swap(e.p1, e.p2);
        if (view_triangle(e, vec3(0)).solid_angle < 1e-4f)
            continue;
        Surface s = make_surface(vec3(0), vec3(0, 0, 1));
        s.roughness = 1;
        const double truth = estimate_irradiance(e, vec3(0), s.normal, 16) * 0.5 / M_PI;
        const double ratio = contribution_of(s, e) / truth;
        ASSERT_GT(ratio, 0.8);
        ASSERT_LT(ratio, 1.8);
    }
}

} // namespace
} // namespace vkpt::test

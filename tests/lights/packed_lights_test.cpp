// SPDX-License-Identifier: GPL-2.0-or-later
// What lights are weighed by: small records that say nearly what the emitter says, and never that a light cannot be
// seen which can.
#include "glsl_libraries.hpp"

#include "ref_vkpt/lights/spot_cone.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace vkpt::test {
namespace {

using namespace glsl;

TEST(QuickFloats, OrderAsTheBuiltInOnesUnlessBothAreNegative)
{
    std::mt19937 rng(1);
    std::uniform_real_distribution<float> exponent(-30, 30), unit(-1, 1);
    for (int i = 0; i < 100000; i++) {
        const float a = std::exp(exponent(rng)), b = std::copysign(std::exp(exponent(rng)), unit(rng));
        EXPECT_EQ(quick_max(a, b), std::max(a, b));
        EXPECT_EQ(quick_min(a, b), std::min(a, b));
        EXPECT_EQ(quick_max(b, a), std::max(a, b));
        EXPECT_EQ(quick_min(b, a), std::min(a, b));
        EXPECT_EQ(quick_clamp(b, 0.25f, 3.0f), std::clamp(b, 0.25f, 3.0f));
        EXPECT_LT(quick_max(-a, -1.0f), 0);
    }
    EXPECT_EQ(quick_max(-0.0f, 0.0f), 0.0f);
    EXPECT_EQ(quick_max(INFINITY, 1.0f), INFINITY);
    EXPECT_EQ(quick_min(-INFINITY, 1.0f), -INFINITY);
}

TEST(QuickFloats, RootsAndAnglesAreAsGoodAsTheySay)
{
    for (double x = 1e-20; x < 1e20; x *= 1.0003)
        ASSERT_NEAR(quick_inversesqrt(float(x)) * std::sqrt(x), 1, 9e-4) << x;
    for (double angle = 1e-6; angle < 3.1; angle *= 1.0005)
        for (const double length : { 1e-10, 1.0, 3.7, 1e9 })
            ASSERT_NEAR(
                quick_angle_above_axis(float(length * std::sin(angle)), float(length * std::cos(angle))) / angle, 1,
                6.5e-3)
                << angle << ", " << length;
}

Emitter make_random_triangle(std::mt19937& rng)
{
    std::uniform_real_distribution<float> unit(-1, 1), exponent(-2, 8);
    const auto vector = [&] { return vec3(unit(rng), unit(rng), unit(rng)); };
    Emitter e {};
    e.p0 = 4096.0f * vector();
    e.p1 = e.p0 + std::exp(exponent(rng)) * vector();
    e.p2 = e.p0 + std::exp(exponent(rng)) * vector();
    e.radiance = vec3(3, 1, 0.5f);
    return e;
}

TEST(Outlines, KeepTheShape)
{
    std::mt19937 rng(2);
    for (int i = 0; i < 10000; i++) {
        const Emitter e = make_random_triangle(rng);
        const LightShape found = unpack_light_shape(pack_light_shape(e, 0.5f));
        EXPECT_FALSE(found.is_sphere);
        EXPECT_EQ(found.p0, e.p0);
        EXPECT_NEAR(found.radiance / (0.5f * luminance(e.radiance)), 1, std::exp2(-14.0f));
        const float rounding = 4096 * 6e-8f;
        float longest = 0;
        for (int axis = 0; axis < 3; axis++) {
            const float first = e.p1[axis] - e.p0[axis], second = e.p2[axis] - e.p0[axis];
            EXPECT_NEAR(found.first[axis], first, PACKED_LIGHT_ERROR * std::abs(first) + rounding);
            EXPECT_NEAR(found.second[axis], second, PACKED_LIGHT_ERROR * std::abs(second) + rounding);
            longest = std::max({ longest, std::abs(first), std::abs(second) });
        }
        EXPECT_GE(found.side, longest);
        EXPECT_LE(found.side, 2 * longest);
    }
}

TEST(Outlines, KeepSpheresExactly)
{
    Emitter e {};
    e.type = EMITTER_SPHERE;
    e.p0 = vec3(1.1f, -2.2f, 3.3f);
    e.p1 = vec3(4.7f, 0, 0);
    e.reach = 312.3f;
    e.radiance = vec3(2);
    const LightShape found = unpack_light_shape(pack_light_shape(e, 1));
    EXPECT_TRUE(found.is_sphere);
    EXPECT_EQ(found.p0, e.p0);
    EXPECT_EQ(found.radius, e.p1.x);
    EXPECT_EQ(found.reach, e.reach);
    EXPECT_FLOAT_EQ(found.radiance, 2);
    EXPECT_EQ(unpack_light_shape(pack_light_shape(e, 0)).radiance, 0);
    EXPECT_TRUE(unpack_light_shape(pack_light_shape(e, 0)).is_sphere);
}

// Directions at the very edge of cones of every width.
TEST(Outlines, NeverHideASpotThatCanBeSeen)
{
    std::mt19937 rng(9);
    std::uniform_real_distribution<float> unit(-1, 1);
    int seen = 0;
    for (int i = 0; i < 100000; i++) {
        Emitter e {};
        e.type = EMITTER_SPHERE;
        e.p0 = 4096.0f * vec3(unit(rng), unit(rng), unit(rng));
        e.p1 = vec3(4, 0, 0);
        e.radiance = vec3(2);
        const vec3 axis = normalize(vec3(unit(rng), unit(rng), unit(rng)) + 1e-4f);
        const float outer = 0.999f * unit(rng), width = 1e-3f + 0.1f * (1 - outer) * (0.5f + 0.5f * unit(rng));
        set_cone(e, axis, std::min(outer + width, 1.0f), outer);
        const float cosine = outer + 2e-4f * unit(rng), sine = std::sqrt(1 - cosine * cosine);
        const vec3 to_receiver = axis * cosine + any_tangent(axis) * sine;
        Surface s {};
        s.position = e.p0 + 300.0f * to_receiver;
        s.normal = s.geometric_normal = s.view = -to_receiver;
        s.albedo = vec3(0.5f);
        s.roughness = 0.7f;
        const LightOptions options { 8, LIGHT_WEIGHT_BRDF_CENTRE, LIGHT_POINT_SOLID_ANGLE, {} };
        const LightShape found = unpack_light_shape(pack_light_shape(e, 1));
        const bool arrives = emitted_radiance(e, s.position).x > 0;
        seen += arrives;
        ASSERT_TRUE(!arrives || light_contribution(make_predictor(s, options), found) > 0) << i;
    }
    EXPECT_GT(seen, 20000);
    EXPECT_LT(seen, 80000);
}

// Triangles of which only the last bit stands above the surface's horizon, and surfaces that see an emitter nearly from
// its side.
TEST(Outlines, NeverHideALightThatCanBeSeen)
{
    std::mt19937 rng(3);
    std::uniform_real_distribution<float> unit(-1, 1), exponent(-12, 0);
    const LightOptions options { 8, LIGHT_WEIGHT_BRDF_CENTRE, LIGHT_POINT_SOLID_ANGLE, {} };
    int seen = 0, slivers = 0;
    for (int i = 0; i < 200000; i++) {
        Emitter e = make_random_triangle(rng);
        const float extent = length(e.p1 - e.p0) + length(e.p2 - e.p0);
        Surface s {};
        s.normal = s.geometric_normal = normalize(vec3(unit(rng), unit(rng), unit(rng)));
        s.view = s.normal;
        s.albedo = vec3(0.5f);
        s.roughness = 1;
        // The highest corner a little above the horizon, or the surface a little before the emitter's plane.
        const float little = extent * std::exp(exponent(rng));
        const vec3 front = normalize(cross(e.p1 - e.p0, e.p2 - e.p0)),
                   beside = cross(front, normalize(vec3(unit(rng), unit(rng), unit(rng))));
        if (i % 2)
            s.position = e.p0 + extent * beside + little * front;
        else
            s.position = e.p0 + extent * vec3(unit(rng), unit(rng), unit(rng));
        if (i % 2 == 0) {
            const float highest = std::max({ dot(s.normal, e.p0), dot(s.normal, e.p1), dot(s.normal, e.p2) });
            s.position += s.normal * (highest - little - dot(s.normal, s.position));
        }
        const float highest = std::max(
            { dot(s.normal, e.p0 - s.position), dot(s.normal, e.p1 - s.position), dot(s.normal, e.p2 - s.position) });
        if (view_triangle(e, s.position).volume <= 0 || highest <= 0)
            continue;
        seen++;
        const LightShape found = unpack_light_shape(pack_light_shape(e, 1));
        Emitter seen_as = e;
        seen_as.p1 = found.p0 + found.first;
        seen_as.p2 = found.p0 + found.second;
        slivers += view_triangle(seen_as, s.position).volume <= 0;
        ASSERT_GT(light_contribution(make_predictor(s, options), found), 0) << i;
    }
    EXPECT_GT(seen, 20000);
    EXPECT_GT(slivers, 10); // that is, the test has what it is about
}

TEST(Outlines, CostWhatHasChanged)
{
    std::mt19937 rng(4);
    std::vector<Emitter> emitters;
    for (uint32_t i = 0; i < 1000; i++) {
        emitters.push_back(make_random_triangle(rng));
        emitters.back().lightstyle = i % 10 == 0 ? 5 : 0;
    }
    const PackedLightWriter writer(emitters);
    std::vector<PackedLight> packed_lights(emitters.size());
    std::vector<float> held, scales(8, 1.0f);
    const auto expect_all = [&] {
        for (size_t i = 0; i < emitters.size(); i++) {
            const PackedLight expected = pack_light_shape(emitters[i], scales[emitters[i].lightstyle]);
            ASSERT_EQ(packed_lights[i].radiance, expected.radiance) << i;
            ASSERT_EQ(packed_lights[i].p0, expected.p0) << i;
        }
    };
    EXPECT_EQ(writer.update(packed_lights.data(), held, emitters, scales), 1000u);
    expect_all();
    EXPECT_EQ(writer.update(packed_lights.data(), held, emitters, scales), 0u);
    scales[5] = 0.25f;
    EXPECT_EQ(writer.update(packed_lights.data(), held, emitters, scales), 100u);
    expect_all();
    scales[3] = 2; // no emitter has it
    EXPECT_EQ(writer.update(packed_lights.data(), held, emitters, scales), 0u);
}

} // namespace
} // namespace vkpt::test

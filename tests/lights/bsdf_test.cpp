// SPDX-License-Identifier: GPL-2.0-or-later
#include "glsl_libraries.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace vkpt::test {
namespace {

using namespace glsl;

constexpr float test_roughnesses[] = { 0.05f, 0.2f, 0.35f, 0.5f, 0.7f, 0.85f, 0.95f, 1 };
constexpr float test_elevations[] = { 0.05f, 0.3f, 0.7f, 1 }; // cosines of the view

Surface make_white(float view_cosine, float roughness, float metallic)
{
    const vec3 normal(0, 0, 1);
    const vec3 view(std::sqrt(1 - view_cosine * view_cosine), 0, view_cosine);
    return Surface { vec3(0), normal, normal, view, vec3(1), roughness, metallic, 0 };
}

// Midpoint rule over the sphere, equal areas.
template <class Function> double integrate_sphere(Function function)
{
    constexpr int rings = 1000, sectors = 1000;
    double sum = 0;
    for (int i = 0; i < rings; i++)
        for (int j = 0; j < sectors; j++) {
            const double z = 1 - 2 * (i + 0.5) / rings, phi = 2 * M_PI * (j + 0.5) / sectors;
            const double r = std::sqrt(1 - z * z);
            sum += function(vec3(float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)));
        }
    return sum * 4 * M_PI / (double(rings) * sectors);
}

double reflected_share(const Surface& s, vec3 light)
{
    return reflected_radiance(s, evaluate_bsdf(s, light), vec3(1)).y;
}

double halton(uint32_t index, uint32_t base)
{
    double value = 0, digit = 1;
    for (; index > 0; index /= base)
        value += (digit /= base) * (index % base);
    return value;
}

// Mean of value / pdf over sample_bsdf's numbers.
double furnace_by_sampling(const Surface& s)
{
    constexpr uint32_t count = 1 << 16;
    double sum = 0;
    for (uint32_t i = 1; i <= count; i++) {
        const BsdfSample drawn = sample_bsdf(s, vec2(float(halton(i, 2)), float(halton(i, 3))), float(halton(i, 5)));
        if (drawn.pdf > 0)
            sum += reflected_radiance(s, drawn.value, vec3(1)).y / drawn.pdf;
    }
    return sum / count;
}

TEST(Bsdf, IsReciprocal)
{
    std::mt19937 rng(1);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 10000; i++) {
        Surface s = make_white(0.1f + 0.9f * unit(rng), 0.1f + 0.9f * unit(rng), unit(rng));
        s.albedo = vec3(unit(rng), unit(rng), unit(rng));
        const float z = 0.1f + 0.9f * unit(rng), phi = 6.28f * unit(rng), r = std::sqrt(1 - z * z);
        const vec3 light(r * std::cos(phi), r * std::sin(phi), z);
        const BsdfValue there = evaluate_brdf(s, light);
        Surface turned = s;
        turned.view = light;
        const BsdfValue back = evaluate_brdf(turned, s.view);
        ASSERT_NEAR(there.diffuse, back.diffuse, 1e-5f + 1e-4f * there.diffuse);
        ASSERT_NEAR(there.specular.y, back.specular.y, 1e-5f + 1e-3f * there.specular.y);
    }
}

TEST(Bsdf, ReflectsNoMoreThanItReceives)
{
    for (const float roughness : test_roughnesses)
        for (const float cosine : test_elevations)
            for (const float metallic : { 0.0f, 0.5f, 1.0f })
                for (const float coat_loss : { 0.0f, 0.6f, 1.0f }) {
                    Surface s = make_white(cosine, roughness, metallic);
                    s.coat_loss = coat_loss;
                    const double furnace = furnace_by_sampling(s);
                    EXPECT_LE(furnace, 1.005) << "roughness " << roughness << " cosine " << cosine << " metallic "
                                              << metallic << " coat_loss " << coat_loss;
                    EXPECT_GT(furnace, 0.25); // single scattering loses most at grazing angles
                }
}

// A smooth white metal loses nothing; rougher ones lose what single scattering does not return.
TEST(Bsdf, WhiteMetalKeepsTheFurnaceWhite)
{
    for (const float cosine : test_elevations) {
        if (cosine < 0.1f)
            continue;
        EXPECT_NEAR(furnace_by_sampling(make_white(cosine, 0.1f, 1)), 1, 0.005) << cosine;
        EXPECT_NEAR(furnace_by_sampling(make_white(cosine, 0.2f, 1)), 1, 0.03) << cosine;
    }
}

// specular_factor of material files: the coat's reflectance at half its strength is half of it, and none is Lambert.
TEST(Bsdf, CoatIsAsStrongAsTheMaterialSays)
{
    Surface s = make_white(0.7f, 0.3f, 0);
    const vec3 light = vec3(-s.view.x, -s.view.y, s.view.z); // the highlight
    const float whole = evaluate_brdf(s, light).specular.y;
    s.coat_loss = 0.5f;
    EXPECT_NEAR(evaluate_brdf(s, light).specular.y, 0.5f * whole, 1e-4f * whole);
    s.coat_loss = 1;
    EXPECT_EQ(evaluate_brdf(s, light).specular.y, 0);
    EXPECT_NEAR(evaluate_brdf(s, light).diffuse, 1 / bsdf_pi, 1e-6f);
    EXPECT_EQ(specular_lobe_probability(s), 0); // no ray is spent on it
    s.metallic = 1;
    EXPECT_NEAR(furnace_by_sampling(s), furnace_by_sampling(make_white(0.7f, 0.3f, 1)), 0.005); // metals have none
}

// A smooth white layer over a white base sends everything back, through one lobe or the other.
TEST(Bsdf, LayerAndBaseKeepTheFurnaceWhite)
{
    for (const float cosine : { 0.3f, 0.7f, 1.0f })
        EXPECT_NEAR(furnace_by_sampling(make_white(cosine, 0.1f, 0)), 1, 0.005) << cosine;
}

TEST(Bsdf, MatteIsExactlyLambert)
{
    Surface s = make_white(0.3f, 1, 0);
    s.albedo = vec3(0.25f, 0.5f, 0.75f);
    for (const float z : { 0.01f, 0.4f, 1.0f }) {
        const vec3 light(0, std::sqrt(1 - z * z), z);
        const BsdfValue value = evaluate_bsdf(s, light);
        EXPECT_FLOAT_EQ(value.diffuse, z / bsdf_pi);
        EXPECT_EQ(value.specular, vec3(0));
        EXPECT_FLOAT_EQ(pdf_bsdf(s, light), z / bsdf_pi);
    }
    EXPECT_EQ(sample_bsdf(s, vec2(0.3f, 0.7f), 0).lobe, BSDF_LOBE_DIFFUSE);
}

TEST(Bsdf, SamplingAgreesWithPlainIntegration)
{
    for (const float roughness : { 0.35f, 0.6f, 1.0f })
        for (const float cosine : { 0.2f, 0.6f, 1.0f })
            for (const float metallic : { 0.0f, 1.0f }) {
                const Surface s = make_white(cosine, roughness, metallic);
                const double plain = integrate_sphere([&](vec3 light) { return reflected_share(s, light); });
                EXPECT_NEAR(furnace_by_sampling(s), plain, 0.005 * plain)
                    << "roughness " << roughness << " cosine " << cosine << " metallic " << metallic;
            }
}

TEST(Bsdf, DensityIntegratesToOne)
{
    for (const float roughness : { 0.35f, 0.6f, 1.0f })
        for (const float cosine : test_elevations)
            for (const float metallic : { 0.0f, 1.0f }) {
                const Surface s = make_white(cosine, roughness, metallic);
                const double integral = integrate_sphere([&](vec3 light) { return double(pdf_bsdf(s, light)); });
                EXPECT_NEAR(integral, 1, 0.005)
                    << "roughness " << roughness << " cosine " << cosine << " metallic " << metallic;
            }
}

TEST(Bsdf, NothingComesThroughTheSurface)
{
    Surface s = make_white(0.5f, 0.5f, 0);
    EXPECT_EQ(reflected_share(s, normalize(vec3(1, 0, -0.1f))), 0);
    s.geometric_normal = normalize(vec3(0.5f, 0, 1));
    EXPECT_EQ(reflected_share(s, normalize(vec3(-1, 0, 0.2f))), 0);
    EXPECT_GT(reflected_share(s, normalize(vec3(-0.1f, 0, 1))), 0);
}

// Normal maps turn normals away from the viewer: everything must stay finite.
TEST(Bsdf, StaysFiniteEverywhere)
{
    std::mt19937 rng(2);
    std::normal_distribution<float> gauss;
    std::uniform_real_distribution<float> unit(0, 1);
    const auto direction = [&] { return normalize(vec3(gauss(rng), gauss(rng), gauss(rng))); };
    for (int i = 0; i < 20000; i++) {
        const Surface s { vec3(0), direction(), direction(), direction(), vec3(unit(rng)), i % 3 ? unit(rng) : 0,
            unit(rng) };
        const BsdfSample drawn = sample_bsdf(s, vec2(unit(rng), unit(rng)), unit(rng));
        const vec3 value = reflected_radiance(s, drawn.value, vec3(1));
        ASSERT_TRUE(std::isfinite(drawn.pdf) && drawn.pdf >= 0);
        ASSERT_TRUE(std::isfinite(value.x) && value.x >= 0);
        ASSERT_NEAR(length(drawn.direction), 1, 1e-3);
    }
}

} // namespace
} // namespace vkpt::test

// SPDX-License-Identifier: GPL-2.0-or-later
// Weights by linearly transformed cosines: how good the fitted table is, and how well the weights follow the light.
#include "glsl_libraries.hpp"
#include "ref_vkpt/lights/ltc_table.hpp"
#include "tools/fit_ltc/fit.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace vkpt::test {
namespace {

using namespace glsl;

constexpr LightOptions by_chapter { 8, LIGHT_WEIGHT_BRDF_CENTRE, LIGHT_POINT_SOLID_ANGLE, {}, {} };
const LightOptions by_ltc { 8, LIGHT_WEIGHT_LTC, LIGHT_POINT_SOLID_ANGLE, { ltc_table.data() }, {} };

struct Case {
    Emitter emitter;
    Surface surface;
};

Case make_case(std::mt19937& rng, float roughness, float metallic)
{
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto vector = [&] { return vec3(unit(rng), unit(rng), unit(rng)); };
    Case c {};
    const vec3 view = normalize(vec3(unit(rng), unit(rng), 0.25f + 0.75f * std::abs(unit(rng))));
    c.surface = Surface { vec3(0), vec3(0, 0, 1), vec3(0, 0, 1), view, vec3(0.5f), roughness, metallic, 0 };
    // Around the mirror direction as often as anywhere.
    const vec3 reflected(-view.x, -view.y, view.z);
    const vec3 centre = 100.0f * normalize(rng() % 2 ? reflected + 0.5f * vector() : vector() + vec3(0, 0, 1));
    c.emitter.p0 = centre + 40.0f * vector();
    c.emitter.p1 = centre + 40.0f * vector();
    c.emitter.p2 = centre + 40.0f * vector();
    if (view_triangle(c.emitter, vec3(0)).volume < 0)
        std::swap(c.emitter.p1, c.emitter.p2);
    c.emitter.radiance = vec3(3);
    return c;
}

double integrate(const Case& c, int n)
{
    double sum = 0;
    for (int i = 0; i < n * n; i++) {
        const vec2 xi((float(i % n) + 0.5f) / float(n), (float(i / n) + 0.5f) / float(n));
        const EmitterSample drawn = sample_emitter_point(c.emitter, c.surface, xi, by_chapter);
        if (drawn.pdf > 0)
            sum += luminance(reflected_radiance(c.surface, evaluate_bsdf(c.surface, drawn.direction), drawn.radiance))
                / drawn.pdf / (n * n);
    }
    return sum;
}

TEST(LightWeights, AngleOverSine)
{
    for (double angle = 0.01; angle < 3.13; angle += 0.01)
        EXPECT_NEAR(
            angle_over_sine(float(std::cos(angle))) * std::sin(angle) / angle, 1, 2e-3 / std::sin(angle) * 0.01 + 2e-5)
            << angle;
}

// From cosines alone it is what the BSDF works out with vectors.
TEST(LightWeights, PredictsTheReflectance)
{
    std::mt19937 rng(4);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 20000; i++) {
        const float roughness = prediction_roughness + (1 - prediction_roughness) * unit(rng);
        const float metallic = rng() % 2 ? unit(rng) : float(rng() % 2);
        Case c = make_case(rng, roughness, metallic);
        c.surface.albedo = vec3(unit(rng), unit(rng), unit(rng));
        const float height = prediction_horizon + (1 - prediction_horizon) * unit(rng), angle = 2 * bsdf_pi * unit(rng),
                    across = std::sqrt(1 - height * height);
        // Mirror directions as often as others.
        const vec3 view = c.surface.view,
                   towards = rng() % 2 ? normalize(vec3(-view.x, -view.y, std::max(view.z, prediction_horizon)))
                                       : vec3(across * std::cos(angle), across * std::sin(angle), height);
        const float truth = luminance(reflected_radiance(c.surface, evaluate_brdf(c.surface, towards), vec3(1)));
        // Lengths are only as good as a quick root.
        const vec3 direction = towards * (1 + 9e-4f * (2 * unit(rng) - 1));
        const float predicted = predict_reflectance(make_predictor(c.surface, by_chapter),
            dot(c.surface.normal, direction), dot(view, direction), dot(direction, direction));
        ASSERT_NEAR(predicted / truth, 1, 0.02) << i << ": roughness " << roughness << ", metallic " << metallic;
    }
}

// The cosine lobe's integral is Lambert's formula; clipping included.
TEST(LightWeights, MatteSurfacesAreExact)
{
    std::mt19937 rng(1);
    for (int i = 0; i < 2000; i++) {
        const Case c = make_case(rng, 1, 0);
        const double truth = integrate(c, 64);
        if (truth < 1e-3)
            continue;
        EXPECT_NEAR(light_contribution(make_predictor(c.surface, by_ltc), c.emitter) / truth, 1, 0.02) << i;
    }
}

TEST(LightWeights, SpheresOnMatteSurfaces)
{
    for (const float radius : { 1.0f, 20.0f, 60.0f }) {
        Case c {};
        c.surface = Surface { vec3(0), vec3(0, 0, 1), vec3(0, 0, 1), vec3(0, 0, 1), vec3(0.5f), 1, 0 };
        c.emitter.type = EMITTER_SPHERE;
        c.emitter.p0 = vec3(30, 20, 90);
        c.emitter.p1 = vec3(radius, 0, 0);
        c.emitter.radiance = vec3(3);
        EXPECT_NEAR(light_contribution(make_predictor(c.surface, by_ltc), c.emitter) / integrate(c, 256), 1, 0.06)
            << radius;
    }
}

// How well choosing by weight does: the mean of f^2 / w over lights, over that of w = f. 1 is perfect.
double choice_cost(const std::vector<double>& truth, const std::vector<double>& weights)
{
    double total_truth = 0, total_weight = 0, second_moment = 0;
    for (size_t i = 0; i < truth.size(); i++) {
        total_truth += truth[i];
        total_weight += weights[i];
        if (truth[i] > 0)
            second_moment += truth[i] * truth[i] / weights[i];
    }
    return second_moment * total_weight / (total_truth * total_truth);
}

// On every material the choice by LTC costs little more than the perfect one, and on the whole less than the chapter's.
TEST(LightWeights, LtcChoosesBetterThanTheCentre)
{
    double ltc_sum = 0, chapter_sum = 0;
    for (const auto& [roughness, metallic, most] : { std::tuple { 1.0f, 0.0f, 1.01 }, std::tuple { 0.7f, 0.0f, 1.03 },
             std::tuple { 0.4f, 0.0f, 1.05 }, std::tuple { 0.5f, 1.0f, 1.1 }, std::tuple { 0.25f, 1.0f, 1.3 } }) {
        double ltc_cost = 0, chapter_cost = 0;
        constexpr int lists = 10, lights = 40;
        std::mt19937 rng(5);
        for (int list = 0; list < lists; list++) {
            std::vector<double> truth, ltc, chapter;
            const Surface surface = make_case(rng, roughness, metallic).surface;
            for (int i = 0; i < lights; i++) {
                Case c = make_case(rng, roughness, metallic);
                c.surface = surface;
                truth.push_back(integrate(c, 48));
                ltc.push_back(light_contribution(make_predictor(surface, by_ltc), c.emitter));
                chapter.push_back(light_contribution(make_predictor(surface, by_chapter), c.emitter));
            }
            ltc_cost += choice_cost(truth, ltc) / lists;
            chapter_cost += choice_cost(truth, chapter) / lists;
        }
        RecordProperty("roughness_" + std::to_string(roughness),
            std::to_string(ltc_cost) + " chapter " + std::to_string(chapter_cost));
        EXPECT_LT(ltc_cost, most) << "roughness " << roughness << ", metallic " << metallic;
        ltc_sum += ltc_cost;
        chapter_sum += chapter_cost;
    }
    EXPECT_LT(ltc_sum, chapter_sum);
}

// The table is what the tool makes of today's surface model, and the tool's fit is good.
TEST(LtcTable, BelongsToTheSurfaceModel)
{
    for (const auto& [row, column] : { std::pair { 2u, 4u }, std::pair { 5u, 9u }, std::pair { 9u, 2u },
             std::pair { 12u, 12u }, std::pair { 15u, 6u } }) {
        const double last = LTC_SIZE - 1, x = column / last;
        const ltc::Entry fresh
            = ltc::fit_lobe(double(LTC_MIN_ROUGHNESS) + (1 - double(LTC_MIN_ROUGHNESS)) * row / last, 1 - x * x);
        const float* entry = &ltc_table[(row * LTC_SIZE + column) * LTC_VALUES];
        EXPECT_LT(fresh.error, 0.1) << row << ", " << column;
        const double values[] = { fresh.xx, fresh.xz, fresh.yy, fresh.zx, fresh.albedo, fresh.grazing };
        for (size_t i = 0; i < LTC_VALUES; i++)
            EXPECT_NEAR(entry[i], values[i], 0.01 * std::abs(values[i]) + 1e-3) << row << ", " << column << ", " << i;
    }
}

} // namespace
} // namespace vkpt::test

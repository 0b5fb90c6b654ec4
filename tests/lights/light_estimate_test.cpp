// SPDX-License-Identifier: GPL-2.0-or-later
// What the renderer makes of the samplers: estimates of reflected light, with MIS where the sampler has it, against
// quadrature. Nothing is shadowed here.
#include "sampler_case.hpp"
#include "sampler_lists.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>
#include <string>

namespace vkpt::test {
namespace {

struct Moments {
    double sum = 0, squares = 0;
    int n = 0;
    void add(double x)
    {
        sum += x;
        squares += x * x;
        n++;
    }
    double mean() const { return sum / n; }
    double variance() const { return std::max(squares / n - mean() * mean(), 0.0); }
    double deviation_of_mean() const { return std::sqrt(variance() / (n - 1)); }
};

double estimate_once(const Sampler& sampler, const ListCase& list, const SamplerOptions& options, const Draw& draw,
    const BsdfNumbers& numbers)
{
    const double light = sampler.sample_lights(list, draw, options);
    return sampler.has(shared::SAMPLER_MIS) ? light + sampler.sample_bsdf_ray(list, numbers, draw, options) : light;
}

// Independent samples: their variance is the sampler's.
Moments estimate(const Sampler& sampler, const ListCase& list, const SamplerOptions& options, int samples)
{
    std::mt19937 rng(29);
    Moments moments;
    for (int i = 0; i < samples; i++) {
        const Draw draw = make_draw(rng);
        BsdfNumbers numbers {};
        if (sampler.has(shared::SAMPLER_MIS))
            numbers = { { draw_unit(rng), draw_unit(rng) }, draw_unit(rng) };
        moments.add(estimate_once(sampler, list, options, draw, numbers));
    }
    return moments;
}

// Points of the R sequence in six dimensions (Roberts 2018: steps of 1/phi, 1/phi^2, ..., phi^7 = phi + 1), shifted at
// random and rounded to 24 bits, as the shaders' numbers are.
class SpreadNumbers {
public:
    explicit SpreadNumbers(std::mt19937& rng)
    {
        for (uint32_t& value : at_)
            value = uint32_t(rng());
    }
    void advance()
    {
        constexpr double phi = 1.1127756842787055;
        double step = 1;
        for (uint32_t& value : at_) {
            step /= phi;
            value += uint32_t(step * 0x1p32);
        }
    }
    float operator[](size_t dimension) const { return float(at_[dimension] >> 8) * 0x1p-24f; }

private:
    std::array<uint32_t, 6> at_ {};
};

// The same mean with several times less noise: means of sequences that are spread evenly and shifted independently.
Moments estimate_evenly(const Sampler& sampler, const ListCase& list, const SamplerOptions& options, int samples)
{
    constexpr int sequences = 64;
    std::mt19937 rng(29);
    Moments moments;
    for (int sequence = 0; sequence < sequences; sequence++) {
        double sum = 0;
        SpreadNumbers u(rng);
        for (int i = 0; i < samples / sequences; i++, u.advance())
            sum += estimate_once(
                sampler, list, options, { u[0], { u[1], u[2] }, uint32_t(rng()) }, { { u[3], u[4] }, u[5] });
        moments.add(sum / (samples / sequences));
    }
    return moments;
}

// Light sampling alone sees the list's emitters only.
ListCase without_unlisted(ListCase list)
{
    for (size_t i = 0; i < list.emitters.size(); i++)
        if (!list.contains(uint32_t(i)))
            list.emitters[i].radiance = glm::vec3(0);
    return list;
}

struct Material {
    const char* name;
    float roughness, metallic;
};
constexpr Material materials[] = { { "matte", 1, 0 }, { "layered", 0.5f, 0 }, { "metal", 0.4f, 1 },
    { "smooth metal", 0.2f, 1 }, { "mirror", 0.12f, 1 } };

bool is_narrow(const Material& material) { return material.metallic > 0 && material.roughness < 0.3f; }

struct EstimateSetup {
    size_t sampler, light_count;
    uint32_t subset_length;
};

// The samplers share the truth.
double integrate_once(const ListCase& list, const Material& material, int n)
{
    static std::map<std::string, double> known;
    double radiance = 0;
    for (const shared::Emitter& e : list.emitters)
        radiance += double(e.radiance.x);
    const auto [entry, is_new]
        = known.try_emplace(fmt::format("{} {} {}", list.light_count(), material.name, radiance), 0);
    if (is_new)
        entry->second = all_samplers()[0].integrate(list, n);
    return entry->second;
}

class LightEstimate : public testing::TestWithParam<EstimateSetup> {
protected:
    const Sampler& sampler() const { return all_samplers()[GetParam().sampler]; }
};

TEST_P(LightEstimate, IsUnbiased)
{
    const bool is_long = GetParam().light_count > 100;
    constexpr double wanted_deviation = 0.006;
    const int max_samples = is_long ? 8'000 : 32'000;
    for (const Material& material : materials) {
        // Light sampling alone would need far more samples for narrow lobes: their rare bright points are missed. And
        // the quadrature of many lights is too coarse for them.
        if (is_narrow(material) && (!sampler().has(shared::SAMPLER_MIS) || is_long))
            continue;
        ListCase list = make_hard_list(GetParam().light_count, 31);
        list.point.roughness = material.roughness;
        list.point.metallic = material.metallic;
        list.point.view = glm::normalize(glm::vec3(-2, 0, 1.2f)); // mirrored: the first light
        if (!sampler().has(shared::SAMPLER_MIS))
            list = without_unlisted(list);
        const double truth = integrate_once(list, material, is_narrow(material) ? 128 : is_long ? 16 : 64);
        int samples = 8'000; // more where the estimate is noisy
        Moments found = estimate_evenly(sampler(), list, { GetParam().subset_length }, samples);
        while (found.deviation_of_mean() > wanted_deviation * truth && samples * 4 <= max_samples) {
            samples *= 4;
            found = estimate_evenly(sampler(), list, { GetParam().subset_length }, samples);
        }
        EXPECT_NEAR(found.mean(), truth, 4.5 * found.deviation_of_mean() + 2e-3 * truth) << material.name;
        EXPECT_LT(found.deviation_of_mean(), (is_long ? 0.3 : 0.1) * truth) << material.name << ": too noisy to tell";
    }
}

std::vector<EstimateSetup> all_setups()
{
    std::vector<EstimateSetup> setups;
    for (size_t sampler = 0; sampler < all_samplers().size(); sampler++) {
        if (all_samplers()[sampler].has(shared::SAMPLER_BIASED))
            continue; // see BiasedSamplersFailTheTest
        for (const size_t count : { 1, 7, 8, 9, 64, 1000 })
            for (const uint32_t subset_length : subset_lengths(all_samplers()[sampler]))
                setups.push_back({ sampler, count, subset_length });
    }
    return setups;
}

INSTANTIATE_TEST_SUITE_P(All, LightEstimate, testing::ValuesIn(all_setups()), [](const auto& setup) {
    return fmt::format("{}_{}_lights_subset_{}", all_samplers()[setup.param.sampler].name, setup.param.light_count,
        setup.param.subset_length);
});

// The test above must be able to fail.
TEST(LightEstimates, BiasedSamplersFailTheTest)
{
    const ListCase list = make_uneven_list();
    int biased = 0;
    for (const Sampler& sampler : all_samplers()) {
        const double truth = sampler.integrate(list, 64);
        const Moments found = estimate(sampler, list, { 8 }, 30000);
        const double sigmas = std::abs(found.mean() - truth) / found.deviation_of_mean();
        if (sampler.has(shared::SAMPLER_BIASED)) {
            EXPECT_GT(sigmas, 10) << sampler.name;
            biased++;
        } else {
            EXPECT_LT(sigmas, 4.5) << sampler.name;
        }
    }
    EXPECT_EQ(biased, 1);
}

// Every combination of weights and points leaves the mean alone.
TEST(LightEstimates, WeightsAndPointsOnlyChangeTheNoise)
{
    ListCase list = make_hard_list(40, 37);
    list.point.view = glm::normalize(glm::vec3(0.6f, -0.3f, 0.7f));
    for (const Sampler& sampler : all_samplers()) {
        if (sampler.has(shared::SAMPLER_BIASED))
            continue;
        const ListCase seen = sampler.has(shared::SAMPLER_MIS) ? list : without_unlisted(list);
        const double truth = sampler.integrate(seen, 64);
        for (const int weight : { shared::LIGHT_WEIGHT_BRDF_CENTRE, shared::LIGHT_WEIGHT_LTC })
            for (const int point :
                { shared::LIGHT_POINT_AREA, shared::LIGHT_POINT_SOLID_ANGLE, shared::LIGHT_POINT_PROJECTED }) {
                const Moments found = estimate_evenly(sampler, seen, { 8, weight, point }, 4000);
                EXPECT_NEAR(found.mean(), truth, 4.5 * found.deviation_of_mean() + 2e-3 * truth)
                    << sampler.name << ", weight " << weight << ", point " << point;
            }
    }
}

// What shadow rays seem to have told may be wrong: it is learnt from others' rays, and doors open.
TEST(LightEstimates, WhateverIsBelievedOfVisibilityOnlyChangesTheNoise)
{
    const ListCase list = make_hard_list(40, 37);
    std::mt19937 rng(5);
    for (const Sampler& sampler : all_samplers()) {
        if (sampler.has(shared::SAMPLER_BIASED))
            continue;
        const ListCase seen = sampler.has(shared::SAMPLER_MIS) ? list : without_unlisted(list);
        const double truth = sampler.integrate(seen, 64);
        for (int table = 0; table < 4; table++) {
            SamplerOptions options { 8 };
            options.hidden = table == 0 ? glm::uvec4(~0u) : glm::uvec4(rng(), rng(), rng(), rng());
            const Moments found = estimate_evenly(sampler, seen, options, 4000);
            EXPECT_NEAR(found.mean(), truth, 4.5 * found.deviation_of_mean() + 2e-3 * truth)
                << sampler.name << ", table " << table;
        }
    }
}

// Section 47.4.2: at most S times the second moment of choosing from the whole list.
TEST(LightEstimates, SubsetsCostAtMostTheirStride)
{
    const auto find = [](std::string_view name) -> const Sampler& {
        for (const Sampler& sampler : all_samplers())
            if (sampler.name == name)
                return sampler;
        throw std::runtime_error("no such sampler");
    };
    const auto second_moment = [](const Moments& m) { return m.variance() + m.mean() * m.mean(); };
    for (const bool uneven : { false, true }) {
        const ListCase list = uneven ? make_uneven_list() : make_random_list(64, 0, 41);
        const double full = second_moment(estimate(find("full"), list, { 8 }, 15000));
        for (const char* name : { "subset", "subset_onesweep", "subset_strides" })
            for (const uint32_t length : { 1, 8, 16, 64 }) {
                const double ratio = second_moment(estimate(find(name), list, { length }, 15000)) / full;
                EXPECT_LT(ratio, 1.1 * 64 / length) << name << " " << length;
                EXPECT_GT(ratio, 0.9) << name << " " << length;
                if (uneven && length == 8 && std::string_view(name) == "subset") {
                    EXPECT_GT(ratio, 6) << "the adversarial order";
                }
            }
    }
}

} // namespace
} // namespace vkpt::test

// SPDX-License-Identifier: GPL-2.0-or-later
// What every light sampler must do, checked for every file of shaders/light_samplers.
#include "sampler_case.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <string>

namespace vkpt::test {
namespace {

constexpr float last_below_one = 0.99999994f;
constexpr uint32_t index_stride = 3; // indices in the list have gaps, so that unlisted emitters exist

shared::Emitter make_random_light(std::mt19937& rng)
{
    std::uniform_real_distribution<float> unit(0, 1);
    const auto around = [&](float size) { return size * (glm::vec3(unit(rng), unit(rng), unit(rng)) - 0.5f); };
    const glm::vec3 centre(400 * (unit(rng) - 0.5f), 400 * (unit(rng) - 0.5f), 40 + 200 * unit(rng));
    shared::Emitter e {};
    e.radiance = glm::vec3(std::exp(6 * unit(rng) - 3));
    e.p0 = centre;
    if (rng() % 4 == 0) {
        e.type = shared::EMITTER_SPHERE;
        e.p1 = glm::vec3(1 + 8 * unit(rng), 0, 0);
        return e;
    }
    e.type = shared::EMITTER_TRIANGLE;
    e.p1 = centre + around(40);
    e.p2 = centre + around(40);
    if (glm::dot(e.p0, glm::cross(e.p1 - e.p0, e.p2 - e.p0)) > 0) // face the shaded point at the origin
        std::swap(e.p1, e.p2);
    return e;
}

// zero_share of the lights cannot light the point: black, below the horizon, or seen from behind.
ListCase make_list(size_t count, double zero_share, uint32_t seed)
{
    std::mt19937 rng(seed);
    ListCase list;
    list.range.static_count = uint32_t(count - count / 3);
    list.range.dynamic_count = uint32_t(count / 3);
    list.range.first_static = 5;
    list.range.first_dynamic = 2;
    list.static_indices.assign(5, 0);
    list.dynamic_indices.assign(2, 0);
    for (size_t i = 0; i < count * index_stride; i++) {
        shared::Emitter e = make_random_light(rng);
        if (double(rng() % 1000) < 1000 * zero_share) {
            if (i % 2 == 0)
                e.radiance = glm::vec3(0);
            else
                e.p0.z = e.p1.z = e.p2.z = -500;
        }
        e.lightstyle = i % 7 == 0 ? 3 : 0;
        list.emitters.push_back(e);
        if (i % index_stride != 0)
            continue;
        const bool is_static = list.static_indices.size() < 5 + list.range.static_count;
        (is_static ? list.static_indices : list.dynamic_indices).push_back(uint32_t(i));
    }
    list.lightstyles[3] = 0.4f;
    return list;
}

struct SamplerSetup {
    size_t sampler, light_count;
    uint32_t subset_length;
    double zero_share;
};

std::vector<SamplerSetup> all_setups()
{
    std::vector<SamplerSetup> setups;
    for (size_t sampler = 0; sampler < all_samplers().size(); sampler++)
        for (const size_t count : { 1, 7, 8, 9, 15, 64, 1000 })
            for (const uint32_t subset_length : { 1, 8, 64 })
                for (const double zero_share : { 0.0, 0.5 })
                    setups.push_back({ sampler, count, subset_length, zero_share });
    return setups;
}

// Registration happens while globals are made, in any order: the list of cases is asked for later, by gtest's main.
class LightSampler : public testing::TestWithParam<SamplerSetup> {
protected:
    const Sampler& sampler() const { return all_samplers()[GetParam().sampler]; }
    ListCase list() const { return make_list(GetParam().light_count, GetParam().zero_share, 11); }
    uint32_t subset_length() const { return GetParam().subset_length; }

    // The mean over xi of the probability of each light of the list.
    std::vector<double> mean_probabilities(const ListCase& lights) const
    {
        constexpr int steps = 16;
        std::vector<double> mean(lights.light_count(), 0);
        for (size_t i = 0; i < mean.size(); i++)
            for (int k = 0; k < steps; k++)
                mean[i] += sampler().probability(lights, lights.light_at(i), (float(k) + 0.5f) / steps, subset_length())
                    / steps;
        return mean;
    }
};

TEST_P(LightSampler, FrequencyIsTheReportedProbability)
{
    const ListCase lights = list();
    const std::vector<double> expected = mean_probabilities(lights);
    std::map<uint32_t, size_t> place;
    for (size_t i = 0; i < expected.size(); i++)
        place[lights.light_at(i)] = i;

    constexpr int draws = 60000;
    std::mt19937 rng(GetParam().subset_length + uint32_t(GetParam().light_count));
    std::vector<double> counts(expected.size(), 0), weights(expected.size(), 0);
    for (int i = 0; i < draws; i++) {
        const float xi = float(rng() >> 8) * 0x1p-24f;
        const PickedLight picked = sampler().pick(lights, xi, subset_length());
        if (picked.emitter < 0) {
            ASSERT_EQ(picked.probability, 0);
            continue;
        }
        ASSERT_TRUE(place.count(uint32_t(picked.emitter)));
        if (i % 64 == 0) {
            const float told = sampler().probability(lights, uint32_t(picked.emitter), xi, subset_length());
            ASSERT_NEAR(told, picked.probability, 1e-4f * picked.probability);
        }
        const size_t at = place[uint32_t(picked.emitter)];
        counts[at]++;
        weights[at] += 1 / (double(picked.probability) * draws);
    }

    double chi_square = 0, rest_expected = 0, rest_count = 0;
    int bins = 0;
    const auto add_bin = [&](double count, double wanted) {
        chi_square += (count - wanted) * (count - wanted) / wanted;
        bins++;
    };
    for (size_t i = 0; i < expected.size(); i++) {
        const double wanted = expected[i] * draws;
        if (wanted >= 10) {
            add_bin(counts[i], wanted);
            // The mean of 1 / (N P) is 1.
            EXPECT_NEAR(weights[i], 1, 6 / std::sqrt(wanted)) << "light " << i;
        } else {
            rest_expected += wanted;
            rest_count += counts[i];
        }
    }
    if (rest_expected >= 10)
        add_bin(rest_count, rest_expected);
    EXPECT_LT(chi_square, bins + 6 * std::sqrt(2.0 * bins) + 6);
}

// Over a fine grid of xi, sum f / P must be sum f, whatever f is: no light is missed, none counted twice.
TEST_P(LightSampler, EstimateIsUnbiasedForAnyContribution)
{
    const ListCase lights = list();
    std::mt19937 rng(23);
    std::uniform_real_distribution<double> unit(0.5, 1.5);
    // Proportional to the weight up to noise, as real contributions are (else a finite grid could not tell).
    std::vector<double> truth(lights.emitters.size(), 0);
    double wanted = 0;
    for (size_t i = 0; i < lights.light_count(); i++) {
        const uint32_t emitter = lights.light_at(i);
        wanted += truth[emitter] = unit(rng) * sampler().contribution(lights, emitter);
    }
    constexpr int grid = 1 << 16;
    double sum = 0, squares = 0;
    for (int i = 0; i < grid; i++) {
        const PickedLight picked = sampler().pick(lights, (float(i) + 0.5f) / grid, subset_length());
        const double estimate = picked.emitter < 0 ? 0 : truth[size_t(picked.emitter)] / picked.probability;
        sum += estimate / grid;
        squares += estimate * estimate / grid;
    }
    const double deviation = std::sqrt(std::max(squares - sum * sum, 0.0) / grid);
    EXPECT_NEAR(sum, wanted, 5 * deviation + 1e-4 * wanted);
}

TEST_P(LightSampler, EndsOfTheRandomNumberAreValid)
{
    const ListCase lights = list();
    for (const float xi : { 0.0f, 0x1p-24f, 0.5f, last_below_one }) {
        const PickedLight picked = sampler().pick(lights, xi, subset_length());
        ASSERT_TRUE(std::isfinite(picked.probability));
        if (picked.emitter < 0) {
            EXPECT_EQ(picked.probability, 0);
            continue;
        }
        EXPECT_GT(picked.probability, 0);
        EXPECT_LE(picked.probability, 1.00001f);
        EXPECT_LT(size_t(picked.emitter), lights.emitters.size());
        EXPECT_EQ(uint32_t(picked.emitter) % index_stride, 0u) << "not in the list";
    }
}

TEST_P(LightSampler, WhatCanLightCanBePicked)
{
    const ListCase lights = list();
    const std::vector<double> expected = mean_probabilities(lights);
    double sum = 0;
    for (size_t i = 0; i < expected.size(); i++) {
        EXPECT_TRUE(expected[i] > 0 || sampler().contribution(lights, lights.light_at(i)) == 0) << "light " << i;
        sum += expected[i];
    }
    EXPECT_LE(sum, 1.001);
    EXPECT_EQ(sampler().probability(lights, 1, 0.5f, subset_length()), 0) << "an emitter that is not in the list";
}

std::string name_setup(const testing::TestParamInfo<SamplerSetup>& info)
{
    const SamplerSetup& setup = info.param;
    return fmt::format("{}_{}_lights_subset_{}{}", all_samplers()[setup.sampler].name, setup.light_count,
        setup.subset_length, setup.zero_share > 0 ? "_zeros" : "");
}

INSTANTIATE_TEST_SUITE_P(All, LightSampler, testing::ValuesIn(all_setups()), name_setup);

TEST(LightSamplers, EmptyAndDarkListsGiveNothing)
{
    ASSERT_FALSE(all_samplers().empty());
    for (const Sampler& sampler : all_samplers()) {
        ListCase empty = make_list(8, 0, 1);
        empty.range.static_count = empty.range.dynamic_count = 0;
        EXPECT_EQ(sampler.pick(empty, 0.3f, 8).emitter, -1) << sampler.name;
        EXPECT_EQ(sampler.probability(empty, 0, 0.3f, 8), 0) << sampler.name;
        const ListCase dark = make_list(20, 1, 1);
        for (const float xi : { 0.0f, 0.4f, last_below_one }) {
            const PickedLight picked = sampler.pick(dark, xi, 8);
            EXPECT_TRUE(std::isfinite(picked.probability)) << sampler.name;
            EXPECT_EQ(picked.emitter < 0, picked.probability == 0) << sampler.name;
        }
        EXPECT_TRUE(std::isfinite(sampler.pick(make_list(200, 0, 1), 0.3f, 0).probability)) << sampler.name;
        EXPECT_GT(sampler.pick(make_list(200, 0, 1), 0.3f, 1000).probability, 0) << sampler.name;
    }
}

} // namespace
} // namespace vkpt::test

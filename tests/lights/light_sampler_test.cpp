// SPDX-License-Identifier: GPL-2.0-or-later
// What every light sampler must do, checked for every file of shaders/light_samplers.
#include "sampler_case.hpp"
#include "sampler_lists.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>
#include <string>

namespace vkpt::test {
namespace {

constexpr float last_below_one = 0.99999994f;

struct SamplerSetup {
    size_t sampler, light_count;
    uint32_t subset_length;
    double zero_share;
};

std::vector<SamplerSetup> all_setups()
{
    std::vector<SamplerSetup> setups;
    for (size_t sampler = 0; sampler < all_samplers().size(); sampler++)
        for (const size_t count : { 1, 7, 8, 9, 64, 1000 })
            for (const uint32_t subset_length : { 1, 8, 64 })
                for (const double zero_share : { 0.0, 0.5 })
                    setups.push_back({ sampler, count, subset_length, zero_share });
    return setups;
}

// Registration happens while globals are made, in any order: the list of cases is asked for later, by gtest's main.
class LightSampler : public testing::TestWithParam<SamplerSetup> {
protected:
    const Sampler& sampler() const { return all_samplers()[GetParam().sampler]; }
    ListCase list() const { return make_random_list(GetParam().light_count, GetParam().zero_share, 11); }
    SamplerOptions options() const { return { GetParam().subset_length }; }
    int draw_count() const
    {
        if (GetParam().light_count > 100)
            return 4000;
        // Of a light's entries some shine beside much stronger lights: rarely picked, they count the more.
        return sampler().draws_entries() && GetParam().subset_length == 1 ? 1000000 : 16000;
    }

    // The probability of each light of the list, averaged over random numbers.
    std::vector<double> mean_probabilities(const ListCase& lights, int steps) const
    {
        std::mt19937 rng(3);
        std::vector<double> mean(lights.light_count(), 0);
        for (int k = 0; k < steps; k++)
            for (size_t i = 0; i < mean.size(); i++)
                mean[i] += sampler().probability(lights, lights.light_at(i), make_draw(rng), options()) / steps;
        return mean;
    }
};

// The reported probability, in what it does for estimates: the mean of 1 / (N P) over the picks of a light is 1.
TEST_P(LightSampler, WeightsOfEachLightAverageToOne)
{
    const ListCase lights = list();
    std::mt19937 rng(GetParam().subset_length + uint32_t(GetParam().light_count));
    struct Sums {
        int picks = 0;
        double weights = 0, squares = 0;
    };
    std::map<uint32_t, Sums> sums;
    for (int i = 0; i < draw_count(); i++) {
        const Draw draw = make_draw(rng);
        const PickedLight picked = sampler().pick(lights, draw, options());
        ASSERT_EQ(picked.emitter < 0, picked.probability == 0);
        if (picked.emitter < 0)
            continue;
        ASSERT_TRUE(lights.contains(uint32_t(picked.emitter)));
        const double weight = 1 / double(picked.probability);
        Sums& sum = sums[uint32_t(picked.emitter)];
        sum.picks++;
        sum.weights += weight;
        sum.squares += weight * weight;
        // Samplers of whole lights know what they reported.
        if (i % 64 == 0 && picked.point == draw.point && !sampler().draws_entries()) {
            const float told = sampler().probability(lights, uint32_t(picked.emitter), draw, options());
            ASSERT_NEAR(told, picked.probability, sampler().is_biased() ? 1 : 1e-4f * picked.probability);
        }
    }
    if (std::string_view(sampler().name) == "ris")
        return; // points of a light that send nothing are never kept, so that its weights count the others alone
    int told = 0;
    const int fewest_picks = std::max(200, draw_count() / 600);
    for (const auto& [emitter, sum] : sums) {
        if (sum.picks < fewest_picks)
            continue; // too rarely to tell
        const double n = draw_count(), mean = sum.weights / n;
        const double deviation = std::sqrt(std::max(sum.squares / n - mean * mean, 0.0) / n);
        EXPECT_NEAR(mean, 1, 6 * deviation + 1e-4) << "light " << emitter;
        told++;
    }
    EXPECT_TRUE(told > 0 || sums.empty() || GetParam().light_count > 100);
}

// Chi-square of the frequencies against light_probability, averaged over what it depends on.
TEST_P(LightSampler, FrequencyIsTheReportedProbability)
{
    if (sampler().is_biased())
        return; // that it is not is what makes it biased
    const ListCase lights = list();
    // Averaging over the numbers would take too long for long lists: there only fixed probabilities are compared.
    const bool is_fixed = has_fixed_probabilities(sampler());
    if (!is_fixed && lights.light_count() > 100)
        return;
    const int work = 150000 / int(lights.light_count() * options().subset_length);
    const int steps = is_fixed ? 1 : std::clamp(work, 250, 4000);
    const std::vector<double> expected = mean_probabilities(lights, steps);
    std::map<uint32_t, size_t> place;
    for (size_t i = 0; i < expected.size(); i++)
        place[lights.light_at(i)] = i;
    std::vector<double> counts(expected.size(), 0);
    std::mt19937 rng(GetParam().subset_length + uint32_t(GetParam().light_count));
    const int draws = is_fixed ? draw_count() : 8000;
    for (int i = 0; i < draws; i++) {
        const PickedLight picked = sampler().pick(lights, make_draw(rng), options());
        if (picked.emitter >= 0)
            counts[place.at(uint32_t(picked.emitter))]++;
    }

    double chi_square = 0, rest_expected = 0, rest_count = 0;
    int bins = 0;
    const auto add_bin = [&](double count, double wanted) {
        chi_square += (count - wanted) * (count - wanted) / wanted;
        bins++;
    };
    for (size_t i = 0; i < expected.size(); i++) {
        const double wanted = expected[i] * draws;
        if (wanted >= 10)
            add_bin(counts[i], wanted);
        else {
            rest_expected += wanted;
            rest_count += counts[i];
        }
    }
    if (rest_expected >= 10)
        add_bin(rest_count, rest_expected);
    // An estimated expectation varies, too.
    const double noise = is_fixed ? 1 : 3;
    EXPECT_LT(chi_square, noise * (bins + 6 * std::sqrt(2.0 * bins) + 6));
}

TEST_P(LightSampler, EndsOfTheRandomNumberAreValid)
{
    const ListCase lights = list();
    for (const float xi : { 0.0f, 0x1p-24f, 0.5f, last_below_one }) {
        const Draw draw { xi, { xi, xi }, 17 };
        const PickedLight picked = sampler().pick(lights, draw, options());
        ASSERT_TRUE(std::isfinite(picked.probability));
        if (picked.emitter < 0) {
            EXPECT_EQ(picked.probability, 0);
            continue;
        }
        EXPECT_GT(picked.probability, 0);
        EXPECT_TRUE(lights.contains(uint32_t(picked.emitter)));
        if (picked.point == draw.point) {
            EXPECT_LE(picked.probability, 1.00001f);
        }
    }
}

TEST_P(LightSampler, WhatCanLightCanBePicked)
{
    const ListCase lights = list();
    const std::vector<double> expected = mean_probabilities(lights, lights.light_count() > 100 ? 1 : 16);
    double sum = 0;
    for (size_t i = 0; i < expected.size(); i++) {
        const bool lights_point = sampler().contribution(lights, lights.light_at(i), options()) > 0;
        EXPECT_TRUE(expected[i] > 0 || !lights_point || !has_fixed_probabilities(sampler())) << "light " << i;
        sum += expected[i];
    }
    if (has_fixed_probabilities(sampler())) {
        EXPECT_LE(sum, 1.001);
    }
    Draw draw;
    EXPECT_EQ(sampler().probability(lights, 1, draw, options()), 0) << "an emitter that is not in the list";
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
        ListCase empty = make_random_list(8, 0, 1);
        empty.range.static_count = empty.range.dynamic_count = 0;
        EXPECT_EQ(sampler.pick(empty, {}, {}).emitter, -1) << sampler.name;
        EXPECT_EQ(sampler.probability(empty, 0, {}, {}), 0) << sampler.name;
        const ListCase dark = make_random_list(20, 1, 1);
        for (const float xi : { 0.0f, 0.4f, last_below_one }) {
            const PickedLight picked = sampler.pick(dark, { xi }, {});
            EXPECT_TRUE(std::isfinite(picked.probability)) << sampler.name;
            EXPECT_EQ(picked.emitter < 0, picked.probability == 0) << sampler.name;
        }
        const ListCase many = make_random_list(200, 0, 1);
        for (const uint32_t length : { 0, 1, 64, 1000 })
            EXPECT_TRUE(std::isfinite(sampler.pick(many, { 0.3f }, { length }).probability)) << sampler.name;
    }
}

} // namespace
} // namespace vkpt::test

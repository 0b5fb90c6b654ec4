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

std::vector<SamplerSetup> make_setups(bool with_biased)
{
    std::vector<SamplerSetup> setups;
    for (size_t sampler = 0; sampler < all_samplers().size(); sampler++)
        for (const size_t count : { 1, 7, 8, 9, 64, 1000 })
            for (const uint32_t subset_length : subset_lengths(all_samplers()[sampler]))
                for (const double zero_share : { 0.0, 0.5 })
                    if (with_biased || !all_samplers()[sampler].has(shared::SAMPLER_BIASED))
                        setups.push_back({ sampler, count, subset_length, zero_share });
    return setups;
}

// Registration happens while globals are made, in any order: the list of cases is asked for later, by gtest's main.
class LightSampler : public testing::TestWithParam<SamplerSetup> {
protected:
    const Sampler& sampler() const { return all_samplers()[GetParam().sampler]; }
    ListCase list() const { return make_random_list(GetParam().light_count, GetParam().zero_share, 11); }
    // In half of the cases some lights are believed to be hidden, rightly or not.
    SamplerOptions options() const
    {
        SamplerOptions options { GetParam().subset_length };
        if (GetParam().zero_share > 0)
            options.hidden = { 0x1b2c3d4e, 0x93f0c5a1, 0xffff0000, 0x2468ace1 };
        return options;
    }
    int draw_count() const
    {
        if (GetParam().light_count > 100)
            return 4000;
        // Of a light's entries some shine beside much stronger lights: rarely picked, they count the more.
        if (sampler().has(shared::SAMPLER_DRAWS_ENTRIES) && GetParam().subset_length == 1)
            return 1000000;
        // So do lights that are believed to be hidden, beside those that are not.
        return GetParam().zero_share > 0 ? 100000 : 16000;
    }

    bool is_long() const { return GetParam().light_count > 100; }
    // Of long lists neighbours count together: each alone would be picked too rarely to tell.
    size_t group_size() const { return is_long() ? 50 : 1; }
    size_t group_count(const ListCase& lights) const
    {
        return (lights.light_count() + group_size() - 1) / group_size();
    }
    // The group of each emitter of the list.
    std::map<uint32_t, size_t> find_groups(const ListCase& lights) const
    {
        std::map<uint32_t, size_t> groups;
        for (size_t i = 0; i < lights.light_count(); i++)
            groups[lights.light_at(i)] = i / group_size();
        return groups;
    }

    struct Estimate {
        double mean = 0, variance = 0; // of that mean
    };
    // The probability of each group of the list, averaged over random numbers.
    std::vector<Estimate> estimate_probabilities(const ListCase& lights, int steps) const
    {
        std::mt19937 rng(3);
        std::vector<Estimate> sums(group_count(lights));
        std::vector<double> now(sums.size());
        for (int k = 0; k < steps; k++) {
            std::ranges::fill(now, 0.0);
            for (size_t i = 0; i < lights.light_count(); i++)
                now[i / group_size()]
                    += double(sampler().probability(lights, lights.light_at(i), make_draw(rng), options()));
            for (size_t group = 0; group < sums.size(); group++) {
                sums[group].mean += now[group];
                sums[group].variance += now[group] * now[group];
            }
        }
        for (Estimate& sum : sums) {
            sum.mean /= steps;
            sum.variance = steps > 1 ? std::max(sum.variance / steps - sum.mean * sum.mean, 0.0) / (steps - 1) : 0;
        }
        return sums;
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
        Draw draw = make_draw(rng);
        draw.light = std::min((float(i) + draw.light) / float(draw_count()), 1 - 0x1p-24f); // evenly spread
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
        if (i % 64 == 0 && picked.point == draw.point && !sampler().has(shared::SAMPLER_DRAWS_ENTRIES)) {
            const float told = sampler().probability(lights, uint32_t(picked.emitter), draw, options());
            ASSERT_NEAR(told, picked.probability,
                sampler().has(shared::SAMPLER_BIASED) ? 1 : 1e-4f * picked.probability + 1e-7f);
        }
    }
    if (is_long() || sampler().has(shared::SAMPLER_DRAWS_POINTS))
        return; // of long lists each is picked too rarely
    int told = 0;
    const int min_picks = std::max(200, draw_count() / 600);
    for (const auto& [emitter, sum] : sums) {
        if (sum.picks < min_picks)
            continue; // too rarely to tell
        const double n = draw_count(), mean = sum.weights / n;
        const double deviation = std::sqrt(std::max(sum.squares / n - mean * mean, 0.0) / n);
        EXPECT_NEAR(mean, 1, 6 * deviation + 1e-4) << "light " << emitter;
        told++;
    }
    EXPECT_TRUE(told > 0 || sums.empty());
}

class UnbiasedLightSampler : public LightSampler { };

// The same for groups of lights: what they contribute, each by its probability, adds up to what they contribute.
TEST_P(UnbiasedLightSampler, ContributionsOfEachGroupAreFound)
{
    const ListCase lights = list();
    const std::map<uint32_t, size_t> groups = find_groups(lights);
    std::vector<double> wanted(group_count(lights));
    std::vector<double> contributions(lights.emitters.size());
    for (const auto& [emitter, group] : groups)
        wanted[group] += contributions[emitter] = double(sampler().contribution(lights, emitter, options()));
    struct Sums {
        double values = 0, squares = 0;
    };
    std::vector<Sums> sums(wanted.size());
    std::mt19937 rng(GetParam().subset_length + uint32_t(GetParam().light_count));
    const int draws = 20000;
    for (int i = 0; i < draws; i++) {
        const PickedLight picked = sampler().pick(lights, make_draw(rng), options());
        if (picked.emitter < 0)
            continue;
        const uint32_t emitter = uint32_t(picked.emitter);
        const double value = contributions[emitter] / double(picked.probability);
        Sums& sum = sums[groups.at(emitter)];
        sum.values += value;
        sum.squares += value * value;
    }
    double all = 0, all_wanted = 0, all_variance = 0;
    for (size_t group = 0; group < sums.size(); group++) {
        const double mean = sums[group].values / draws,
                     variance = std::max(sums[group].squares / draws - mean * mean, 0.0) / draws;
        if (is_long()) {
            EXPECT_NEAR(mean, wanted[group], 6 * std::sqrt(variance) + 1e-4 * wanted[group]) << "group " << group;
        }
        all += mean;
        all_wanted += wanted[group];
        all_variance += variance;
    }
    EXPECT_NEAR(all, all_wanted, 6 * std::sqrt(all_variance) + 1e-4 * all_wanted);
}

// Chi-square of the frequencies against light_probability, averaged over what it depends on.
TEST_P(UnbiasedLightSampler, FrequencyIsTheReportedProbability)
{
    const ListCase lights = list();
    const bool is_fixed = has_fixed_probabilities(sampler());
    const int work = int((is_long() ? 2000000 : 150000) / (lights.light_count() * options().subset_length));
    const int steps = is_fixed ? 1 : std::clamp(work, is_long() ? 30 : 250, 4000);
    const std::vector<Estimate> expected = estimate_probabilities(lights, steps);
    const std::map<uint32_t, size_t> groups = find_groups(lights);
    std::vector<double> counts(expected.size(), 0);
    std::mt19937 rng(GetParam().subset_length + uint32_t(GetParam().light_count));
    const int draws = is_fixed ? std::max(draw_count(), 16000) : 16000;
    for (int i = 0; i < draws; i++) {
        const PickedLight picked = sampler().pick(lights, make_draw(rng), options());
        if (picked.emitter >= 0)
            counts[groups.at(uint32_t(picked.emitter))]++;
    }

    // Counts vary, and where they are estimated, expectations do.
    double chi_square = 0, rest_expected = 0, rest_variance = 0, rest_count = 0;
    int bins = 0;
    const auto add_bin = [&](double count, double wanted, double variance) {
        chi_square += (count - wanted) * (count - wanted) / (wanted + variance);
        bins++;
    };
    for (size_t i = 0; i < expected.size(); i++) {
        const double wanted = expected[i].mean * draws, variance = expected[i].variance * draws * draws;
        if (wanted >= 10)
            add_bin(counts[i], wanted, variance);
        else {
            rest_expected += wanted;
            rest_variance += variance;
            rest_count += counts[i];
        }
    }
    if (rest_expected >= 10)
        add_bin(rest_count, rest_expected, rest_variance);
    EXPECT_LT(chi_square, bins + 6 * std::sqrt(2.0 * bins) + 6);
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
    const bool is_fixed = has_fixed_probabilities(sampler());
    std::mt19937 rng(3);
    double sum = 0;
    for (size_t i = 0; i < lights.light_count(); i++) {
        const float probability = sampler().probability(lights, lights.light_at(i), make_draw(rng), options());
        const bool lights_point = sampler().contribution(lights, lights.light_at(i), options()) > 0;
        EXPECT_TRUE(probability > 0 || !lights_point || !is_fixed) << "light " << i;
        EXPECT_GE(probability, 0) << "light " << i;
        sum += double(probability);
    }
    if (is_fixed) {
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

INSTANTIATE_TEST_SUITE_P(All, LightSampler, testing::ValuesIn(make_setups(true)), name_setup);
INSTANTIATE_TEST_SUITE_P(All, UnbiasedLightSampler, testing::ValuesIn(make_setups(false)), name_setup);

// So that one length stands for all in the tests above.
TEST(LightSamplers, WithoutSubsetsTakeNoNoticeOfTheirLength)
{
    int seen = 0;
    for (const Sampler& sampler : all_samplers()) {
        if (sampler.has(shared::SAMPLER_USES_SUBSET))
            continue;
        seen++;
        for (const size_t count : { 1, 7, 8, 9, 64, 1000 }) {
            const ListCase lights = make_random_list(count, 0.5, 11);
            std::mt19937 rng(3);
            for (int i = 0; i < 200; i++) {
                const Draw draw = make_draw(rng);
                const PickedLight one = sampler.pick(lights, draw, { 1 });
                const uint32_t asked = lights.light_at(size_t(i) % lights.light_count());
                for (const uint32_t length : { 8, 64 }) {
                    const PickedLight other = sampler.pick(lights, draw, { length });
                    EXPECT_EQ(one.emitter, other.emitter) << sampler.name;
                    EXPECT_EQ(one.probability, other.probability) << sampler.name;
                    EXPECT_EQ(one.point, other.point) << sampler.name;
                    EXPECT_EQ(sampler.probability(lights, asked, draw, { 1 }),
                        sampler.probability(lights, asked, draw, { length }))
                        << sampler.name;
                }
            }
        }
    }
    EXPECT_GT(seen, 0);
}

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

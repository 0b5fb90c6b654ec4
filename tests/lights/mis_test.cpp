// SPDX-License-Identifier: GPL-2.0-or-later
// The identity behind pseudo-marginal MIS (equation 47.18), with every combination of offsets: whatever the emitters
// contribute and however likely BSDF rays are to meet them, both techniques together count each emitter once.
#include "glsl_libraries.hpp"
#include "sampler_case.hpp"
#include "sampler_lists.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <stdexcept>

namespace vkpt::test {
namespace {

// Positions of the lights that the sampler weighs, -1 where a stride gives none.
std::vector<int> drawn_positions(uint32_t stream, size_t count, uint32_t subset_length)
{
    const uint32_t stride = glsl::subset_stride(uint32_t(count), subset_length);
    uint32_t state = glsl::start_fast_random(glsl::make_random({ stream & 0xffffu, stream >> 16u }, 5, 7));
    std::vector<int> positions;
    for (uint32_t first = 0; first < count; first += stride) {
        const uint32_t position = first + glsl::choose_uniformly(glsl::next_fast_random(state), stride);
        positions.push_back(position < count ? int(position) : -1);
    }
    return positions;
}

// One stream of random numbers for each combination of offsets, with its share of all combinations: offsets past the
// end of the list are one outcome.
std::vector<std::pair<uint32_t, double>> enumerate_streams(size_t count, uint32_t subset_length)
{
    const size_t stride = glsl::subset_stride(uint32_t(count), subset_length);
    const size_t strides = (count + stride - 1) / stride, last_length = count - (strides - 1) * stride;
    const size_t last_outcomes = std::min(last_length + 1, stride);
    size_t outcomes = last_outcomes;
    for (size_t i = 0; i + 1 < strides; i++)
        outcomes *= stride;
    std::map<std::vector<int>, std::pair<uint32_t, double>> found;
    const double share_of_one = std::pow(1.0 / double(stride), double(strides));
    for (uint32_t stream = 0; found.size() < outcomes; stream++) {
        if (stream == 1u << 20)
            throw std::runtime_error("a combination of offsets never comes up");
        const std::vector<int> positions = drawn_positions(stream, count, subset_length);
        const double past_end = positions.back() < 0 ? double(stride - last_length) : 1;
        found.try_emplace(positions, stream, share_of_one * past_end);
    }
    std::vector<std::pair<uint32_t, double>> streams;
    for (const auto& [positions, stream] : found)
        streams.push_back(stream);
    return streams;
}

struct ToyScene {
    ListCase list;
    std::vector<double> light, ray_density; // per emitter: what it contributes, and how likely a BSDF ray meets it
    double sum = 0;
};

ToyScene make_toy(const ListCase& list, uint32_t seed)
{
    ToyScene toy;
    toy.list = list;
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (size_t i = 0; i < toy.list.emitters.size(); i++) {
        const bool is_listed = toy.list.contains(uint32_t(i));
        const bool has_weight = is_listed && find_sampler("subset_mis").contribution(toy.list, uint32_t(i), {}) > 0;
        // Some only light sampling finds; a mirror's rays are all but certain; what has no weight only rays find.
        toy.ray_density.push_back(i % 4 == 0 && has_weight ? 0 : i % 5 == 0 ? 1e4 : unit(rng));
        toy.light.push_back(unit(rng));
        toy.sum += toy.light.back();
    }
    return toy;
}

// Both techniques' expected value, given the sampler's random numbers. `positions`: the subset they choose.
double expected_estimate(
    const ToyScene& toy, const Sampler& sampler, const Draw& draw, const std::vector<int>& positions, uint32_t length)
{
    const SamplerOptions options { length };
    const double stride = glsl::subset_stride(uint32_t(toy.list.light_count()), length);
    const auto share = [&](uint32_t emitter, double probability) {
        return toy.light[emitter] / (probability + toy.ray_density[emitter]);
    };
    double sum = 0, chosen = 0;
    for (const int position : positions) {
        if (position < 0)
            continue;
        const uint32_t emitter = toy.list.light_at(size_t(position));
        const double probability = sampler.probability(toy.list, emitter, draw, options);
        if (probability > 0)
            sum += stride * probability * share(emitter, probability); // in this subset, it is picked S times as often
        chosen += stride * probability;
    }
    EXPECT_TRUE(chosen == 0 || std::abs(chosen - 1) < 1e-5);
    for (uint32_t emitter = 0; emitter < toy.light.size(); emitter++)
        if (toy.ray_density[emitter] > 0)
            sum += toy.ray_density[emitter] * share(emitter, sampler.probability(toy.list, emitter, draw, options));
    return sum;
}

TEST(PseudoMarginalMis, CountsEveryEmitterOnce)
{
    const Sampler& sampler = find_sampler("subset_mis");
    for (const size_t count : { 1, 5, 8, 9, 15, 16 })
        for (const uint32_t length : { 1, 2, 4, 8, 64 }) {
            const ToyScene toy = make_toy(make_random_list(count, 0.3, length), uint32_t(count) + length);
            double sum = 0, shares = 0;
            for (const auto& [stream, share] : enumerate_streams(count, length)) {
                Draw draw;
                draw.stream = stream;
                sum += share * expected_estimate(toy, sampler, draw, drawn_positions(stream, count, length), length);
                shares += share;
            }
            EXPECT_NEAR(shares, 1, 1e-9);
            EXPECT_NEAR(sum / toy.sum, 1, 1e-6) << count << " lights, subset " << length;
        }
}

TEST(PseudoMarginalMis, OneOffsetForAllStridesIsBiased)
{
    const Sampler& sampler = find_sampler("subset_mis_biased");
    constexpr size_t count = 64;
    constexpr uint32_t length = 8, stride = 8;
    ToyScene toy = make_toy(make_uneven_list(), 3);
    toy.ray_density.assign(toy.ray_density.size(), 0.02); // about what the probabilities are
    double sum = 0;
    for (uint32_t offset = 0; offset < stride; offset++) {
        Draw draw;
        draw.light = (float(offset) + 0.5f) / stride;
        std::vector<int> positions;
        for (size_t position = offset; position < count; position += stride)
            positions.push_back(int(position));
        sum += expected_estimate(toy, sampler, draw, positions, length) / stride;
    }
    EXPECT_GT(std::abs(sum / toy.sum - 1), 0.01);
}

// Section 47.6: an emitter outside the list is left to the rays.
TEST(PseudoMarginalMis, UnlistedEmittersHaveNoProbability)
{
    const ListCase list = make_random_list(30, 0, 3);
    for (const Sampler& sampler : all_samplers())
        for (uint32_t emitter = 0; emitter < list.emitters.size(); emitter++)
            if (!list.contains(emitter)) {
                ASSERT_EQ(sampler.probability(list, emitter, {}, {}), 0) << sampler.name;
            }
}

} // namespace
} // namespace vkpt::test

// SPDX-License-Identifier: GPL-2.0-or-later
// The light samplers as the Vulkan driver runs them: unbiased, as frequent as they report, and equal to the same files
// compiled as C++, so that what the other tests here prove of those holds on the device.
#include "ref_vkpt/lights/ltc_table.hpp"
#include "ref_vkpt/lights/packed_lights.hpp"
#include "sampler_device.h"
#include "sampler_lists.hpp"
#include "tests/rays/headless_compute.hpp"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <memory>
#include <string>

namespace vkpt::test {
namespace {

using shared::DeviceCase;
using shared::DeviceDraw;
using shared::DeviceResult;
using tests::HeadlessCompute;

struct Material {
    const char* name;
    float roughness, metallic;
};
constexpr Material materials[] = { { "layered", 0.5f, 0 }, { "metal", 0.4f, 1 } };

std::vector<uint32_t> read_spirv(std::string_view sampler)
{
    const std::string path = fmt::format("{}/sampler_{}.spv", VKPT_SAMPLER_SHADERS, sampler);
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file)
        throw std::runtime_error(path + " is missing");
    std::vector<uint32_t> words(size_t(file.tellg()) / 4);
    file.seekg(0).read(reinterpret_cast<char*>(words.data()), std::streamsize(words.size() * 4));
    return words;
}

std::vector<DeviceDraw> make_draws(const ListCase& list, size_t count, uint32_t seed)
{
    std::mt19937 rng(seed);
    std::vector<DeviceDraw> draws(count);
    for (size_t i = 0; i < count; i++) {
        const Draw draw = make_draw(rng);
        draws[i] = { draw.point, draw.light, draw.stream, { draw_unit(rng), draw_unit(rng) }, draw_unit(rng),
            list.light_at(i % list.light_count()) };
    }
    return draws;
}

Draw to_draw(const DeviceDraw& draw) { return { draw.light, draw.point, draw.stream }; }

struct Mean {
    double sum = 0, squares = 0, count = 0;
    void add(double x)
    {
        sum += x;
        squares += x * x;
        count++;
    }
    double value() const { return sum / count; }
    double deviation() const { return std::sqrt(std::max(squares / count - value() * value(), 0.0) / (count - 1)); }
};

Mean mean_light(const std::vector<DeviceResult>& results)
{
    Mean mean;
    for (const DeviceResult& result : results)
        mean.add(double(result.by_light) + double(result.by_bsdf));
    return mean;
}

class SamplerOnDevice : public testing::TestWithParam<size_t> {
protected:
    void SetUp() override
    {
        try {
            device_ = std::make_unique<HeadlessCompute>(HeadlessCompute::Validation::on);
            pipeline_ = device_->create_pipeline(read_spirv(sampler().name), sizeof(uint64_t), {});
        } catch (const tests::NoDevice& reason) {
            GTEST_SKIP() << reason.what();
        }
    }
    void TearDown() override
    {
        if (device_)
            for (const std::string& message : device_->messages())
                ADD_FAILURE() << message;
    }

    const Sampler& sampler() const { return all_samplers()[GetParam()]; }

    template <class T> uint64_t upload(const std::vector<T>& items)
    {
        return device_->create_buffer_of(std::span<const T>(items)).address;
    }

    std::vector<DeviceResult> run(
        const ListCase& list, const std::vector<DeviceDraw>& draws, const SamplerOptions& options)
    {
        DeviceCase c {};
        c.emitters = upload(list.emitters);
        std::vector<shared::PackedLight> packed_lights;
        for (const shared::Emitter& e : list.emitters)
            packed_lights.push_back(pack_light_shape(e, list.lightstyles[e.lightstyle]));
        c.packed_lights = upload(packed_lights);
        c.lists = upload(std::vector { list.range });
        // Buffers are never empty.
        const auto padded = [](auto items) {
            items.emplace_back();
            return items;
        };
        c.static_indices = upload(padded(list.static_indices));
        c.dynamic_indices = upload(padded(list.dynamic_indices));
#define VKPT_SAMPLER_TABLE(name, type, alignment) c.sampler_tables.name = upload(padded(list.tables.name));
#include "shaders/shared/sampler_tables.def"
        c.tree_lights = list.tables.tree_lights;
        c.lightstyles = upload(list.lightstyles);
        c.ltc = upload(std::vector<float>(ltc_table.begin(), ltc_table.end()));
        c.draws = upload(draws);
        c.emitter_count = uint32_t(list.emitters.size());
        c.draw_count = uint32_t(draws.size());
        c.subset_length = options.subset_length;
        c.weight = options.weight;
        c.point = options.point;
        c.roughness = list.point.roughness;
        c.metallic = list.point.metallic;
        c.position = list.point.position;
        c.normal = list.point.normal;
        c.view = list.point.view;
        c.albedo = list.point.albedo;
        const HeadlessCompute::Buffer found = device_->create_buffer(draws.size() * sizeof(DeviceResult));
        c.results = found.address;
        const uint64_t address = upload(std::vector { c });
        device_->dispatch(pipeline_, &address, (c.draw_count + shared::SAMPLER_GROUP - 1) / shared::SAMPLER_GROUP);
        std::vector<DeviceResult> results(draws.size());
        std::memcpy(static_cast<void*>(results.data()), found.mapped, results.size() * sizeof(DeviceResult));
        device_->free_buffers();
        return results;
    }

    void expect_as_in_cpp(const ListCase& list, const std::vector<DeviceDraw>& draws,
        const std::vector<DeviceResult>& results, const SamplerOptions& options) const
    {
        constexpr size_t checked = 250;
        size_t same = 0, close = 0;
        for (size_t i = 0; i < checked; i++) {
            const Draw draw = to_draw(draws[i]);
            const PickedLight picked = sampler().pick(list, draw, options);
            same += picked.emitter == results[i].picked;
            double light = sampler().sample_lights(list, draw, options);
            if (sampler().has(shared::SAMPLER_MIS))
                light
                    += sampler().sample_bsdf_ray(list, { draws[i].bsdf_direction, draws[i].bsdf_lobe }, draw, options);
            const double found = double(results[i].by_light) + double(results[i].by_bsdf);
            close += std::abs(found - light) <= 2e-3 * light + 1e-6;
        }
        // Where a random number lies right at a border, the last bit decides; samplers that go through the subset one
        // by one meet a border with each light, and stretch the number that is left over each time.
        const size_t allowed = checked / 100 + checked * options.subset_length / 1000;
        EXPECT_GE(same, checked - allowed);
        EXPECT_GE(close, checked - allowed);
    }

    // Chi-square of the picks against light_probability, both from the device.
    void expect_reported_frequencies(
        const ListCase& list, const std::vector<DeviceDraw>& draws, const std::vector<DeviceResult>& results) const
    {
        const size_t lights = list.light_count();
        std::vector<Mean> told(lights);
        std::vector<double> counts(lights, 0);
        std::map<uint32_t, size_t> place;
        for (size_t k = 0; k < lights; k++)
            place[list.light_at(k)] = k;
        for (size_t i = 0; i < draws.size(); i++) {
            told[i % lights].add(double(results[i].told));
            if (results[i].picked >= 0)
                counts[place.at(uint32_t(results[i].picked))]++;
        }
        double chi_square = 0;
        int bins = 0;
        const auto n = double(draws.size());
        for (size_t k = 0; k < lights; k++) {
            const double p = told[k].value(), noise = told[k].deviation();
            if (p * n < 10)
                continue;
            // The expectation is an average itself.
            const double variance = n * p + n * n * noise * noise;
            chi_square += (counts[k] - n * p) * (counts[k] - n * p) / variance;
            bins++;
        }
        EXPECT_LT(chi_square, bins + 6 * std::sqrt(2.0 * bins) + 6);
    }

    void check_lists();
    void check_weights_and_points();

    std::unique_ptr<HeadlessCompute> device_;
    HeadlessCompute::Pipeline pipeline_;
};

void SamplerOnDevice::check_lists()
{
    for (const size_t lights : { 1, 7, 8, 9, 64, 1000 }) {
        for (const Material& material : materials) {
            ListCase list = make_hard_list(lights, 31);
            list.point.roughness = material.roughness;
            list.point.metallic = material.metallic;
            list.point.view = glm::normalize(glm::vec3(-2, 0, 1.2f));
            if (!sampler().has(shared::SAMPLER_MIS)) // light sampling alone sees the list's emitters only
                for (size_t i = 0; i < list.emitters.size(); i++)
                    if (!list.contains(uint32_t(i)))
                        list.emitters[i].radiance = glm::vec3(0);
            const double truth = sampler().integrate(list, lights > 100 ? 12 : 32);
            const auto draws = make_draws(list, lights > 100 ? 2048 : 8192, uint32_t(lights));
            for (const uint32_t subset_length : { 1u, 8u, 64u }) {
                SCOPED_TRACE(fmt::format("{} lights, subset {}, {}", lights, subset_length, material.name));
                const SamplerOptions options { subset_length };
                const std::vector<DeviceResult> results = run(list, draws, options);
                expect_as_in_cpp(list, draws, results, options);
                if (sampler().has(shared::SAMPLER_BIASED))
                    continue;
                const Mean mean = mean_light(results);
                EXPECT_NEAR(mean.value(), truth, 4.5 * mean.deviation() + 2e-3 * truth);
                if (lights <= 64)
                    expect_reported_frequencies(list, draws, results);
            }
        }
    }
}

// Whatever predicts the contribution, and wherever points lie on the lights.
void SamplerOnDevice::check_weights_and_points()
{
    if (sampler().has(shared::SAMPLER_BIASED)) { // and the test can tell
        const ListCase list = make_uneven_list();
        const double truth = sampler().integrate(list, 32);
        const Mean mean = mean_light(run(list, make_draws(list, 32768, 7), { 8 }));
        EXPECT_GT(std::abs(mean.value() - truth), 10 * mean.deviation());
        return;
    }
    ListCase list = make_hard_list(40, 37);
    list.point.view = glm::normalize(glm::vec3(0.6f, -0.3f, 0.7f));
    if (!sampler().has(shared::SAMPLER_MIS))
        for (size_t i = 0; i < list.emitters.size(); i++)
            if (!list.contains(uint32_t(i)))
                list.emitters[i].radiance = glm::vec3(0);
    const double truth = sampler().integrate(list, 32);
    const auto draws = make_draws(list, 8192, 5);
    for (const int weight : { shared::LIGHT_WEIGHT_BRDF_CENTRE, shared::LIGHT_WEIGHT_LTC })
        for (const int point :
            { shared::LIGHT_POINT_AREA, shared::LIGHT_POINT_SOLID_ANGLE, shared::LIGHT_POINT_PROJECTED }) {
            const Mean mean = mean_light(run(list, draws, { 8, weight, point }));
            EXPECT_NEAR(mean.value(), truth, 4.5 * mean.deviation() + 2e-3 * truth)
                << "weight " << weight << ", point " << point;
        }
}

// One test: the driver takes seconds to compile a shader.
TEST_P(SamplerOnDevice, IsUnbiasedAndEqualToCpp)
{
    check_lists();
    check_weights_and_points();
}

std::vector<size_t> every_sampler()
{
    std::vector<size_t> numbers(all_samplers().size());
    for (size_t i = 0; i < numbers.size(); i++)
        numbers[i] = i;
    return numbers;
}

INSTANTIATE_TEST_SUITE_P(All, SamplerOnDevice, testing::ValuesIn(every_sampler()),
    [](const auto& i) { return all_samplers()[i.param].name; });

} // namespace
} // namespace vkpt::test

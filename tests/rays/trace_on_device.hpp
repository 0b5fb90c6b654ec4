// SPDX-License-Identifier: GPL-2.0-or-later
// The fixture of tests that trace on the real driver, with validation.
#pragma once

#include "tests/rays/gpu_tracer.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <gtest/gtest.h>
#include <memory>
#include <string>

namespace vkpt::tests {

class TraceOnDevice : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        try {
            device = std::make_unique<HeadlessCompute>(HeadlessCompute::Validation::on);
            pipelines = { create_trace_pipelines(*device), create_trace_pipelines(*device, false) };
        } catch (const NoDevice& reason) {
            why_not = reason.what();
        }
    }
    static void TearDownTestSuite() { device.reset(); }
    void SetUp() override
    {
        if (!device)
            GTEST_SKIP() << why_not;
    }
    void TearDown() override
    {
        if (device)
            for (const std::string& message : device->messages())
                ADD_FAILURE() << message;
    }

    static std::vector<shared::TestHit> trace(
        std::span<const Bvh> trees, std::span<const shared::TestRay> rays, bool any_hit, uint32_t ray_mask)
    {
        GpuTracer tracer(*device, trees, rays, ray_mask);
        tracer.run(pipelines[0][any_hit]);
        std::vector<shared::TestHit> hits = tracer.hits();
        tracer.run(pipelines[1][any_hit]);
        EXPECT_EQ(std::memcmp(tracer.hits().data(), hits.data(), hits.size() * sizeof hits[0]), 0)
            << "trees read by address give other hits than read by texels";
        device->free_buffers();
        return hits;
    }

    static inline std::unique_ptr<HeadlessCompute> device;
    static inline std::array<TracePipelines, 2> pipelines; // by texels, by address
    static inline std::string why_not;
};

} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// The fixture of tests that trace on the real driver, with validation.
#pragma once

#include "tests/trace/gpu_tracer.hpp"

#include <array>
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
            pipelines = create_trace_pipelines(*device);
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
        tracer.run(pipelines[any_hit]);
        std::vector<shared::TestHit> hits = tracer.hits();
        device->free_buffers();
        return hits;
    }

    static inline std::unique_ptr<HeadlessCompute> device;
    static inline std::array<HeadlessCompute::Pipeline, 2> pipelines;
    static inline std::string why_not;
};

} // namespace vkpt::tests

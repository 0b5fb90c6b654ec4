// SPDX-License-Identifier: GPL-2.0-or-later
// The canvas that pictures are drawn on: coverage and colour of single pixels.
#include "tools/asset_generator/canvas.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

using namespace vkpt::tools;

// Left of an upright line.
auto left_of(float line)
{
    return [line](glm::vec2 p) { return p.x - line; };
}

TEST(Canvas, APixelsOpacityIsItsCoverage)
{
    Canvas canvas(4, 2, 8);
    canvas.fill(left_of(1.25f), glm::vec3(0.8f, 0.4f, 0.2f));
    const std::vector<glm::vec4> small = canvas.shrink();
    ASSERT_EQ(small.size(), 8u);
    const float expected[] = { 1, 0.25f, 0, 0 };
    for (size_t i = 0; i < small.size(); i++)
        EXPECT_NEAR(small[i].w, expected[i % 4], 1e-5f) << i;
    EXPECT_NEAR(glm::distance(glm::vec3(small[1]), { 0.8f, 0.4f, 0.2f }), 0, 1e-5f) << "an edge keeps its colour";
}

TEST(Canvas, WhatIsAboveHidesByItsOpacity)
{
    Canvas canvas(1, 1, 2);
    canvas.fill(left_of(5), glm::vec3(1, 0, 0));
    canvas.fill(left_of(5), glm::vec4(0, 0, 1, 0.25f));
    EXPECT_NEAR(glm::distance(canvas.shrink()[0], glm::vec4(0.75f, 0, 0.25f, 1)), 0, 1e-5f);
    Canvas empty(1, 1, 2);
    empty.fill(left_of(5), glm::vec4(0, 0, 1, 0.25f));
    EXPECT_NEAR(glm::distance(empty.shrink()[0], glm::vec4(0, 0, 1, 0.25f)), 0, 1e-5f);
}

} // namespace
} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/engine/captures.hpp"

#include "tests/engine/picture_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>

namespace vkpt::tests {

namespace {

// The largest difference of any colour of any pixel, 0..255; 256: pictures of different size.
int largest_difference(const formats::Image& a, const formats::Image& b)
{
    if (a.width != b.width || a.height != b.height)
        return 256;
    int largest = 0;
    for (size_t i = 0; i < a.pixels.size(); i++)
        largest = std::max({ largest, std::abs(a.pixels[i].r - b.pixels[i].r), std::abs(a.pixels[i].g - b.pixels[i].g),
            std::abs(a.pixels[i].b - b.pixels[i].b) });
    return largest;
}

} // namespace

void expect_captured(const EngineRun& run, const std::filesystem::path& path)
{
    ASSERT_TRUE(std::filesystem::exists(path)) << run.result().console;
    const formats::Image picture = load_picture(path);
    const auto captures = list_pictures(run.captures());
    ASSERT_GE(captures.size(), 10u);
    int least = 256;
    for (const std::filesystem::path& capture : captures)
        least = std::min(least, largest_difference(picture, load_picture(capture)));
    EXPECT_EQ(least, 0) << path << " is none of the captured frames";
    EXPECT_LT(measure_picture(picture).black, 0.9) << path;
    EXPECT_GT(measure_picture(picture).deviation, 0.01) << path;
}

} // namespace vkpt::tests

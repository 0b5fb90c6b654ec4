// SPDX-License-Identifier: GPL-2.0-or-later
// Whole numbers by way of floats, and numbers in a few bits: shaders/lib/device/whole_numbers.glsl and packing.glsl
// against C++'s own arithmetic and GLM's packing.
#include "glsl_libraries.hpp"

#include <cmath>
#include <glm/packing.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace vkpt::test {
namespace {

using namespace glsl;

constexpr uint max_whole = 1u << 22;

TEST(WholeNumbers, AreDividedExactly)
{
    for (uint divisor = 1; divisor < 3000; divisor += divisor < 130 ? 1 : 97)
        for (uint quotient = 0; quotient <= max_whole / divisor; quotient += 1 + max_whole / divisor / 500)
            for (const uint number :
                { quotient * divisor - (quotient > 0), quotient * divisor, quotient * divisor + divisor - 1 })
                if (number < max_whole) {
                    ASSERT_EQ(divide_whole(number, divisor), number / divisor) << number << " / " << divisor;
                    ASSERT_EQ(remainder_whole(number, divisor), number % divisor) << number << " % " << divisor;
                }
}

// Vulkan lets quotients be 2.5 ULP off (appendix on the precision of SPIR-V's operations).
TEST(WholeNumbers, AreDividedExactlyByDivisionsOfVulkansPrecision)
{
    constexpr float ulps = 2.5f / 8388608; // relative to the number just above a power of two
    size_t corrected = 0;
    for (uint divisor = 1; divisor < 3000; divisor += divisor < 130 ? 1 : 97)
        for (uint number = max_whole - 1; number > max_whole - 5000; number--)
            for (const float error : { -ulps, ulps }) {
                const float quotient = (float(number) + 0.5f) / float(divisor) * (1 + error);
                corrected += floor_to_uint(quotient) != number / divisor;
                ASSERT_EQ(correct_quotient(number, divisor, quotient), number / divisor) << number << " / " << divisor;
            }
    EXPECT_GT(corrected, 0u) << "the test's errors are too small to matter";
}

TEST(WholeNumbers, FloorIsThatOfTheFloat)
{
    for (const float whole : { 0.0f, 1.0f, 2.0f, 63.0f, 99999.0f, float(max_whole) }) {
        EXPECT_EQ(floor_to_uint(whole), uint(whole));
        const float below = std::nextafter(whole, -1.0f), above = std::nextafter(whole, 1e9f);
        if (whole > 0) {
            EXPECT_EQ(floor_to_uint(below), uint(below)) << whole;
        }
        EXPECT_EQ(floor_to_uint(above), uint(above)) << whole;
    }
    EXPECT_EQ(whole_to_int(-3.0f), -3);
    EXPECT_EQ(whole_to_int(vec2(-4194304.0f, 4194303.0f)), ivec2(-4194304, 4194303));
}

// Numbers all over the range of a format, its ends and middle included.
class Packing : public testing::Test {
protected:
    float next(float low, float high)
    {
        const float ends[] = { low, high, (low + high) / 2, 0 };
        number_++;
        return number_ < 4 ? ends[number_] : std::uniform_real_distribution<float>(low, high)(generator_);
    }

private:
    std::mt19937 generator_ { 3 };
    int number_ = -1;
};

TEST_F(Packing, NormalizedNumbersAreGlmsToHalfAStep)
{
    for (int i = 0; i < 100000; i++) {
        const vec4 s(next(-1, 1), next(-1, 1), next(-1, 1), next(-1, 1)), u = s * 0.5f + 0.5f;
        const vec2 s2(s.x, s.y), u2(u.x, u.y);
        for (int k = 0; k < 2; k++) {
            ASSERT_NEAR(unpack_snorm2(pack_snorm2(s2))[k], s2[k], 0.51f / 32767);
            ASSERT_NEAR(unpack_unorm2(pack_unorm2(u2))[k], u2[k], 0.51f / 65535);
        }
        for (int k = 0; k < 4; k++) {
            ASSERT_NEAR(unpack_snorm4_times_127(pack_snorm4(s))[k] / 127, s[k], 0.51f / 127);
            ASSERT_NEAR(unpack_unorm4(pack_unorm4(u))[k], u[k], 0.51f / 255);
        }
        // The words are the formats' own, so that what the CPU packs can be read, too.
        ASSERT_LT(distance(unpack_snorm2(glm::packSnorm2x16(s2)), glm::unpackSnorm2x16(glm::packSnorm2x16(s2))), 1e-6f);
        ASSERT_LT(distance(unpack_unorm4(glm::packUnorm4x8(u)), glm::unpackUnorm4x8(glm::packUnorm4x8(u))), 1e-6f);
    }
}

TEST_F(Packing, ShownColoursAreClamped)
{
    EXPECT_EQ(pack_unorm4(vec4(-0.002f, -5, -0.0f, 1)), 0xff000000u);
    EXPECT_EQ(pack_unorm4(vec4(1.002f, 7e9f, 1, 2)), 0xffffffffu);
    EXPECT_EQ(pack_unorm4(vec4(std::numeric_limits<float>::infinity(), 0.5f, 0, 0)) & 0xffu, 0xffu);
}

TEST_F(Packing, UpperHalvesKeepFloatsToAPartIn256)
{
    for (int i = 0; i < 100000; i++) {
        const float magnitude = std::exp2(next(-30, 3));
        const vec2 v(magnitude, -magnitude);
        const vec2 back = unpack_upper_halves(pack_upper_halves(v));
        ASSERT_NEAR(back.x, v.x, magnitude / 256);
        ASSERT_NEAR(back.y, v.y, magnitude / 256);
    }
    EXPECT_EQ(unpack_upper_halves(pack_upper_halves(vec2(0, -8))), vec2(0, -8));
}

TEST_F(Packing, DirectionsComeBack)
{
    for (int i = 0; i < 100000; i++) {
        const vec3 d = normalize(vec3(next(-1, 1), next(-1, 1), next(-1, 1)) + vec3(1e-6f));
        ASSERT_LT(distance(unpack_direction(pack_direction(d)), d), 1e-4f);
    }
    for (const vec3 axis : { vec3(1, 0, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1) })
        EXPECT_LT(distance(unpack_direction(pack_direction(axis)), axis), 1e-6f);
}

TEST_F(Packing, LightKeepsTenBitsAndIsNeverBroken)
{
    for (int i = 0; i < 100000; i++) {
        const float light = std::exp2(next(-40, 16));
        ASSERT_NEAR(unpack_light2(pack_light2(vec2(light, 0))).x, light, light / 2000);
        ASSERT_NEAR(unpack_light3(pack_light3(vec3(0, 0, light))).z, light, light / 2000);
    }
    const float broken = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const vec2 greatest = unpack_light2(pack_light2(vec2(broken, infinity)));
    EXPECT_TRUE(std::isfinite(greatest.x) && std::isfinite(greatest.y));
    EXPECT_LT(unpack_light2(pack_light2(vec2(0, -1))).x, 1e-14f);
}

TEST_F(Packing, ThreeFloatsKeepTwelveBitsAndTheirSigns)
{
    const auto there_and_back = [](const vec3& v) { return unpack_floats3(pack_floats3(v)); };
    double off = 0;
    for (int i = 0; i < 100000; i++) {
        vec3 v;
        for (int k = 0; k < 3; k++)
            v[k] = std::copysign(std::exp2(next(-60, 60)), next(-1, 1));
        const vec3 back = there_and_back(v);
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(back[k], v[k], std::abs(v[k]) / 8000);
            off += (double(back[k]) - double(v[k])) / double(v[k]) / 300000;
        }
    }
    EXPECT_LT(std::abs(off), 1e-6); // rounded, not cut
    EXPECT_EQ(there_and_back(vec3(0, 1, -0.5f)), vec3(0, 1, -0.5f));
    const float infinity = std::numeric_limits<float>::infinity();
    const vec3 broken = there_and_back(vec3(infinity, std::numeric_limits<float>::quiet_NaN(), 1));
    EXPECT_EQ(broken.x, infinity);
    EXPECT_TRUE(std::isnan(broken.y));
    EXPECT_EQ(broken.z, 1);
}

TEST_F(Packing, PlacesKeepA256thOfAPixelAndStayOnTheirSideOfTheEdge)
{
    for (int i = 0; i < 100000; i++) {
        const vec2 place(next(-8, 16375), next(-8, 16375));
        const float depth = std::exp2(next(-10, 20));
        const vec3 back = unpack_place(pack_place(place, depth));
        ASSERT_NEAR(back.x, place.x, 0.51f / 256 + 0.001f); // floats near 16,000 have steps of a thousandth
        ASSERT_NEAR(back.y, place.y, 0.51f / 256 + 0.001f);
        ASSERT_NEAR(back.z, depth, depth / 8000);
    }
    EXPECT_EQ(unpack_place(pack_place(vec2(1919, 0), 64)), vec3(1919, 0, 64));
    EXPECT_EQ(unpack_place(pack_place(vec2(-1e6f), -5)), vec3(-8, -8, 0));
    EXPECT_EQ(unpack_place(pack_place(vec2(1e9f, 20000), 1)), vec3(16375, 16375, 1));
}

} // namespace
} // namespace vkpt::test

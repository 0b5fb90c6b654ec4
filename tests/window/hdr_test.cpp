// SPDX-License-Identifier: GPL-2.0-or-later
// The light that HDR windows are sent, against the standards' own figures: known luminances of ST 2084, white and
// primaries of BT.2020, and the image below paper white as an SDR screen of that brightness shows it.
#include "common/colour.hpp"
#include "tests/window/present_shader.hpp"
#include "tests/window/st2084.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr float paper_white = 200, peak = 1000;

uint32_t word_of(glm::uvec3 rgb, uint32_t covered) { return rgb.x | rgb.y << 8 | rgb.z << 16 | covered << 24; }

// cd/m^2 of red, green and blue by BT.2020 that a pixel of HDR10 stands for.
glm::dvec3 shown_by_hdr10(uint32_t word, glm::vec3 highlight, uint32_t packing = shared::PRESENT_RGB10A2)
{
    const uint32_t packed = glsl::pack_for_hdr_window(
        word, glsl::pack_highlight(highlight), packing, shared::PRESENT_HDR10, paper_white, peak)
                                .x;
    EXPECT_EQ(packed >> 30, 3u);
    glm::dvec3 rgb;
    for (int i = 0; i < 3; i++)
        rgb[i] = decode_pq((packed >> (10 * i) & 1023) / 1023.0);
    return packing == shared::PRESENT_BGR10A2 ? glm::dvec3(rgb.z, rgb.y, rgb.x) : rgb;
}

// As linear light of BT.709's primaries.
glm::dvec3 shown_by_scrgb(uint32_t word, glm::vec3 highlight)
{
    const glm::uvec2 packed = glsl::pack_for_hdr_window(
        word, glsl::pack_highlight(highlight), shared::PRESENT_RGBA16F, shared::PRESENT_SCRGB, paper_white, peak);
    const glm::vec2 a = glm::unpackHalf2x16(packed.x), b = glm::unpackHalf2x16(packed.y);
    EXPECT_EQ(b.y, 1);
    return glm::dvec3(a.x, a.y, b.x) * 80.0;
}

// BT.2100, table 4, and BT.2408's level of reference white.
TEST(Hdr, LuminanceIsEncodedAsSt2084Says)
{
    for (const auto& [luminance, signal] : { std::pair(0.0f, 0.0), { 0.1f, 0.0625 }, { 1.0f, 0.1499 },
             { 100.0f, 0.5081 }, { 203.0f, 0.5806 }, { 1000.0f, 0.7518 }, { 4000.0f, 0.9026 }, { 10000.0f, 1.0 } })
        EXPECT_NEAR(glsl::encode_pq(glm::vec3(luminance)).x, signal, 2e-4) << luminance;
}

TEST(Hdr, WhiteStaysAndPrimariesAreWidened)
{
    const glm::vec3 white = glsl::widen_primaries(glm::vec3(1));
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(white[i], 1, 1e-3);
    const glm::vec3 red = glsl::widen_primaries({ 1, 0, 0 });
    EXPECT_NEAR(red.x, 0.6274f, 1e-4);
    // Luminance by BT.2020's weights is what it was by BT.709's.
    for (const glm::vec3 colour : { glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1) })
        EXPECT_NEAR(glm::dot(glsl::widen_primaries(colour), glm::vec3(0.2627f, 0.6780f, 0.0593f)),
            glm::dot(colour, glm::vec3(0.2126f, 0.7152f, 0.0722f)), 1e-3);
}

// Greys of 2D alone: what an SDR screen of paper_white shows.
TEST(Hdr, TheImageIsShownBelowPaperWhite)
{
    for (uint32_t grey = 0; grey < 256; grey++) {
        const double expected = paper_white * decode_srgb(grey / 255.0);
        const uint32_t word = word_of(glm::uvec3(grey), 255);
        const glm::vec3 stale(3); // of a pixel that 2D covers nothing is added
        for (const uint32_t packing : { shared::PRESENT_RGB10A2, shared::PRESENT_BGR10A2 })
            for (int i = 0; i < 3; i++)
                EXPECT_NEAR(shown_by_hdr10(word, stale, packing)[i], expected, 0.02 * expected + 0.01) << grey;
        EXPECT_NEAR(shown_by_scrgb(word, stale).y, expected, 0.01 * expected + 0.01) << grey;
    }
    const glm::dvec3 red = shown_by_hdr10(word_of({ 255, 0, 0 }, 255), {});
    EXPECT_NEAR(red.x, 0.6274 * paper_white, 2);
    EXPECT_NEAR(red.y, 0.0691 * paper_white, 1);
    const glm::dvec3 swapped = shown_by_hdr10(word_of({ 255, 0, 0 }, 255), {}, shared::PRESENT_BGR10A2);
    EXPECT_NEAR(swapped.x, red.x, 1e-6);
}

TEST(Hdr, HighlightsAreAboveItAndEndAtThePeak)
{
    const uint32_t white = word_of(glm::uvec3(255), 0);
    const auto highlight = [](double light) { return glm::vec3(float(encode_srgb(light / paper_white) - 1)); };
    for (const double light : { 200.0, 300.0, 500.0, 900.0 }) {
        EXPECT_NEAR(shown_by_hdr10(white, highlight(light)).y, light, 0.02 * light);
        EXPECT_NEAR(shown_by_scrgb(white, highlight(light)).y, light, 0.01 * light);
    }
    EXPECT_NEAR(shown_by_hdr10(white, highlight(5000)).y, peak, 0.02 * peak);
    // Too bright a colour keeps its hue.
    const glm::dvec3 orange
        = shown_by_scrgb(word_of({ 255, 255, 0 }, 0), { float(encode_srgb(20.0) - 1), float(encode_srgb(5.0) - 1), 0 });
    EXPECT_NEAR(orange.x, peak, 10);
    EXPECT_NEAR(orange.y / orange.x, 0.25, 0.01);
    // Half covered by 2D: half of the highlight.
    const glm::vec3 strong = highlight(900);
    EXPECT_NEAR(shown_by_scrgb(word_of(glm::uvec3(255), 128), strong).y,
        paper_white * decode_srgb(1 + strong.y * (127 / 255.0)), 5);
}

} // namespace
} // namespace vkpt::tests

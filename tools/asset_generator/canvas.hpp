// SPDX-License-Identifier: GPL-2.0-or-later
// A small vector canvas: shapes are signed distance functions (negative inside, in design pixels), painted with
// anti-aliased edges. Design pixels are the picture's nominal size; the canvas holds `scale` samples of each per axis.
#pragma once

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string_view>
#include <vector>

namespace vkpt::tools {

struct Canvas {
    int width, height; // design pixels
    int scale;
    std::vector<glm::vec4> pixels; // straight alpha, sRGB-encoded, scale * width to the row

    Canvas(int w, int h, int samples)
        : width(w)
        , height(h)
        , scale(samples)
        , pixels(size_t(w) * size_t(h) * size_t(samples) * size_t(samples), glm::vec4(0))
    {
    }
    int columns() const { return width * scale; }
    int rows() const { return height * scale; }

    // shape(p) -> distance; colour(p) -> vec4.
    template <class Shape, class Colour> void paint(Shape shape, Colour colour)
    {
        for (int y = 0; y < rows(); y++) {
            for (int x = 0; x < columns(); x++) {
                const glm::vec2 p = (glm::vec2(x, y) + 0.5f) / float(scale);
                const float coverage = glm::clamp(0.5f - shape(p) * float(scale), 0.0f, 1.0f);
                if (coverage > 0)
                    blend(pixels[size_t(y) * size_t(columns()) + size_t(x)], colour(p), coverage);
            }
        }
    }
    template <class Shape> void fill(Shape shape, glm::vec4 colour)
    {
        paint(shape, [=](glm::vec2) { return colour; });
    }
    template <class Shape> void fill(Shape shape, glm::vec3 colour) { fill(shape, glm::vec4(colour, 1)); }
    // A light halo around the shape: alpha falls off over `radius`.
    template <class Shape> void glow(Shape shape, glm::vec3 colour, float radius, float strength)
    {
        const auto falloff = [=](glm::vec2 p) {
            const float t = glm::clamp(1.0f - std::max(shape(p), 0.0f) / radius, 0.0f, 1.0f);
            return glm::vec4(colour, strength * t * t);
        };
        paint([](glm::vec2) { return -1e3f; }, falloff);
    }

    // Box-filtered to one sample per design pixel, alpha-weighted.
    std::vector<glm::vec4> shrink() const;

private:
    static void blend(glm::vec4& below, glm::vec4 above, float coverage)
    {
        const float a = above.w * coverage;
        const float out = a + below.w * (1 - a);
        if (out > 0)
            below = glm::vec4((glm::vec3(above) * a + glm::vec3(below) * below.w * (1 - a)) / out, out);
    }
};

// Shapes. All return signed distances in design pixels.
float segment_distance(glm::vec2 p, glm::vec2 a, glm::vec2 b);
inline auto circle(glm::vec2 centre, float radius)
{
    return [=](glm::vec2 p) { return glm::length(p - centre) - radius; };
}
inline auto ring(glm::vec2 centre, float radius, float half_width)
{
    return [=](glm::vec2 p) { return std::abs(glm::length(p - centre) - radius) - half_width; };
}
inline auto line(glm::vec2 a, glm::vec2 b, float half_width)
{
    return [=](glm::vec2 p) { return segment_distance(p, a, b) - half_width; };
}
inline auto box(glm::vec2 low, glm::vec2 high, float rounding = 0)
{
    return [=](glm::vec2 p) {
        const glm::vec2 q = glm::abs(p - (low + high) * 0.5f) - (high - low) * 0.5f + rounding;
        return glm::length(glm::max(q, 0.0f)) + std::min(std::max(q.x, q.y), 0.0f) - rounding;
    };
}
// A box whose corners are cut at 45 degrees: the house's frame.
inline auto chamfered_box(glm::vec2 low, glm::vec2 high, float cut)
{
    return [=](glm::vec2 p) {
        const glm::vec2 q = glm::abs(p - (low + high) * 0.5f) - (high - low) * 0.5f;
        return std::max({ q.x, q.y, (q.x + q.y + cut) * 0.7071f });
    };
}
template <class Shape> auto outline(Shape shape, float half_width)
{
    return [=](glm::vec2 p) { return std::abs(shape(p)) - half_width; };
}
template <class A, class B> auto unite(A a, B b)
{
    return [=](glm::vec2 p) { return std::min(a(p), b(p)); };
}
template <class A, class B> auto intersect(A a, B b)
{
    return [=](glm::vec2 p) { return std::max(a(p), b(p)); };
}
template <class A, class B> auto subtract(A a, B b)
{
    return [=](glm::vec2 p) { return std::max(a(p), -b(p)); };
}
// A polygon with corners in order (either way round).
struct Polygon {
    std::vector<glm::vec2> corners;
    float operator()(glm::vec2 p) const;
};

// Upper-case text in our stroke typeface; `height` of a capital in design pixels.
struct TextShape {
    std::vector<std::pair<glm::vec2, glm::vec2>> strokes;
    float half_width;
    float operator()(glm::vec2 p) const;
};
TextShape text_shape(std::string_view text, glm::vec2 top_left, float height, float weight);
float text_width(std::string_view text, float height);

} // namespace vkpt::tools

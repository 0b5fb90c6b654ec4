// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/analysis/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace vkpt::analysis {

namespace {

// All constants below are the paper's; its symbols in the comments.
constexpr float colour_exponent = 0.7f, feature_exponent = 0.5f; // q_c, q_f
constexpr float knee_place = 0.4f, knee_value = 0.95f; // p_c, p_t
constexpr double feature_width = 0.082; // w, degrees

// Linear sRGB to CIE XYZ (IEC 61966-2-1), and its white.
const glm::mat3 rgb_to_xyz { 0.4124564f, 0.2126729f, 0.0193339f, 0.3575761f, 0.7151522f, 0.1191920f, 0.1804375f,
    0.0721750f, 0.9503041f };
const glm::mat3 xyz_to_rgb = glm::inverse(rgb_to_xyz);
const glm::vec3 white = rgb_to_xyz * glm::vec3(1);

// The linear opponent space Y C_x C_z that the contrast sensitivities are defined in.
glm::vec3 to_opponent(glm::vec3 rgb)
{
    const glm::vec3 n = rgb_to_xyz * rgb / white;
    return { 116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z) };
}

glm::vec3 from_opponent(glm::vec3 opponent)
{
    const float y = (opponent.x + 16) / 116;
    return xyz_to_rgb * (glm::vec3(opponent.y / 500 + y, y, y - opponent.z / 200) * white);
}

// CIELAB whose a and b grow with luminance (Hunt effect).
glm::vec3 to_hunt_lab(glm::vec3 rgb)
{
    const glm::vec3 n = rgb_to_xyz * rgb / white;
    const auto f = [](float t) {
        constexpr float d = 6.0f / 29;
        return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0f / 29;
    };
    const glm::vec3 root { f(n.x), f(n.y), f(n.z) };
    const float lightness = 116 * root.y - 16;
    return { lightness, 0.01f * lightness * 500 * (root.x - root.y), 0.01f * lightness * 200 * (root.y - root.z) };
}

float hyab(glm::vec3 a, glm::vec3 b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

// One channel of a picture.
struct Plane {
    int width, height;
    std::vector<float> values;
};

using Kernel = std::vector<float>; // weights from -radius to +radius

// One line of a plane, its ends continued by the kernel's reach.
void convolve_line(
    const float* line, size_t count, size_t step, const Kernel& kernel, std::vector<float>& padded, float* out)
{
    const size_t reach = kernel.size() / 2;
    padded.resize(count + 2 * reach);
    for (size_t i = 0; i < padded.size(); i++)
        padded[i]
            = line[std::clamp<ptrdiff_t>(ptrdiff_t(i) - ptrdiff_t(reach), 0, ptrdiff_t(count) - 1) * ptrdiff_t(step)];
    for (size_t i = 0; i < count; i++)
        out[i * step] = std::inner_product(kernel.begin(), kernel.end(), &padded[i], 0.0f);
}

// Separable; edges are continued.
Plane convolve(const Plane& source, const Kernel& across, const Kernel& down)
{
    const size_t width = size_t(source.width), height = size_t(source.height);
    Plane rows = source, result = source;
    std::vector<float> padded;
    for (size_t y = 0; y < height; y++)
        convolve_line(&source.values[y * width], width, 1, across, padded, &rows.values[y * width]);
    for (size_t x = 0; x < width; x++)
        convolve_line(&rows.values[x], height, width, down, padded, &result.values[x]);
    return result;
}

template <class Weight> Kernel make_kernel(int radius, const Weight& weight)
{
    Kernel kernel(size_t(2 * radius + 1));
    for (int i = -radius; i <= radius; i++)
        kernel[size_t(i + radius)] = float(weight(double(i)));
    return kernel;
}

float sum_of(const Kernel& kernel) { return std::accumulate(kernel.begin(), kernel.end(), 0.0f); }

// A contrast sensitivity as one or two Gaussians, amplitude a and width b each: in space, with x in degrees,
// a sqrt(pi / b) exp(-pi^2 x^2 / b).
struct Sensitivity {
    double a[2], b[2];
};
constexpr Sensitivity sensitivities[]
    = { { { 1, 0 }, { 0.0047, 1e-5 } }, { { 1, 0 }, { 0.0053, 1e-5 } }, { { 34.1, 13.5 }, { 0.04, 0.025 } } };
constexpr double widest = 0.04; // the largest b: all three filters have its extent

Plane filter_channel(const Plane& source, const Sensitivity& sensitivity, double pixels_per_degree)
{
    using std::numbers::pi;
    const int radius = int(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
    Plane result { source.width, source.height, std::vector<float>(source.values.size(), 0.0f) };
    float total = 0;
    for (int part = 0; part < 2; part++) {
        const double a = sensitivity.a[part], b = sensitivity.b[part];
        if (a == 0)
            continue;
        const Kernel kernel = make_kernel(radius, [&](double pixel) {
            const double x = pixel / pixels_per_degree;
            return std::exp(-pi * pi * x * x / b);
        });
        const float amplitude = float(a * std::sqrt(pi / b));
        const Plane blurred = convolve(source, kernel, kernel);
        for (size_t i = 0; i < result.values.size(); i++)
            result.values[i] += amplitude * blurred.values[i];
        total += amplitude * sum_of(kernel) * sum_of(kernel);
    }
    for (float& value : result.values)
        value /= total;
    return result;
}

std::array<Plane, 3> make_opponent_planes(const LinearImage& image)
{
    std::array<Plane, 3> planes;
    planes.fill({ image.width, image.height, std::vector<float>(image.pixel_count()) });
    for (size_t i = 0; i < image.pixel_count(); i++) {
        const float* rgb = &image.rgb[3 * i];
        const glm::vec3 opponent = to_opponent(glm::clamp(glm::vec3(rgb[0], rgb[1], rgb[2]), 0.0f, 1.0f));
        for (int c = 0; c < 3; c++)
            planes[size_t(c)].values[i] = opponent[c];
    }
    return planes;
}

// What the eye makes of the colours, as Hunt-adjusted CIELAB.
std::vector<glm::vec3> see_colours(const std::array<Plane, 3>& opponent, double pixels_per_degree)
{
    std::array<Plane, 3> filtered;
    for (size_t c = 0; c < 3; c++)
        filtered[c] = filter_channel(opponent[c], sensitivities[c], pixels_per_degree);
    std::vector<glm::vec3> colours(opponent[0].values.size());
    for (size_t i = 0; i < colours.size(); i++) {
        const glm::vec3 rgb = from_opponent({ filtered[0].values[i], filtered[1].values[i], filtered[2].values[i] });
        colours[i] = to_hunt_lab(glm::clamp(rgb, 0.0f, 1.0f));
    }
    return colours;
}

// The positive weights sum to 1, the negative ones to -1.
void normalise_signed(Kernel& kernel)
{
    float above = 0, below = 0;
    for (const float weight : kernel)
        (weight > 0 ? above : below) += weight;
    for (float& weight : kernel)
        weight /= weight > 0 ? above : -below;
}

struct Features {
    std::vector<float> edges, points; // strength
};

Features find_features(const Plane& achromatic, double pixels_per_degree)
{
    const double sigma = 0.5 * feature_width * pixels_per_degree;
    const int radius = int(std::ceil(3 * sigma));
    const auto bell = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
    Kernel smooth = make_kernel(radius, bell);
    const float total = sum_of(smooth);
    for (float& weight : smooth)
        weight /= total;
    Kernel slope = make_kernel(radius, [&](double x) { return -x * bell(x); });
    Kernel curve = make_kernel(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * bell(x); });
    normalise_signed(slope);
    normalise_signed(curve);

    Plane lightness = achromatic;
    for (float& value : lightness.values)
        value = (value + 16) / 116;
    const auto strength = [&](const Kernel& kernel) {
        const Plane x = convolve(lightness, kernel, smooth), y = convolve(lightness, smooth, kernel);
        std::vector<float> length(x.values.size());
        for (size_t i = 0; i < length.size(); i++)
            length[i] = std::hypot(x.values[i], y.values[i]);
        return length;
    };
    return { strength(slope), strength(curve) };
}

// HyAB^q_c to 0..1: the larger differences share the last part of the scale.
float scale_colour_difference(float difference)
{
    static const float most = std::pow(hyab(to_hunt_lab({ 0, 1, 0 }), to_hunt_lab({ 0, 0, 1 })), colour_exponent);
    const float value = std::pow(difference, colour_exponent), knee = knee_place * most;
    return value < knee ? value * knee_value / knee : knee_value + (value - knee) / (most - knee) * (1 - knee_value);
}

} // namespace

std::vector<float> measure_flip(const LinearImage& reference, const LinearImage& image, double pixels_per_degree)
{
    if (reference.width != image.width || reference.height != image.height || reference.rgb.size() != image.rgb.size())
        throw std::invalid_argument("measure_flip: pictures of different sizes");
    const std::array<Plane, 3> a = make_opponent_planes(reference), b = make_opponent_planes(image);
    const std::vector<glm::vec3> colours_a = see_colours(a, pixels_per_degree),
                                 colours_b = see_colours(b, pixels_per_degree);
    const Features features_a = find_features(a[0], pixels_per_degree),
                   features_b = find_features(b[0], pixels_per_degree);
    std::vector<float> map(reference.pixel_count());
    for (size_t i = 0; i < map.size(); i++) {
        const float colour = scale_colour_difference(hyab(colours_a[i], colours_b[i]));
        const float feature = std::pow(std::max(std::abs(features_a.edges[i] - features_b.edges[i]),
                                           std::abs(features_a.points[i] - features_b.points[i]))
                / std::numbers::sqrt2_v<float>,
            feature_exponent);
        map[i] = std::clamp(std::pow(colour, 1 - std::min(feature, 1.0f)), 0.0f, 1.0f);
    }
    return map;
}

double mean_flip(const std::vector<float>& map)
{
    double sum = 0;
    for (const float value : map)
        sum += double(value);
    return map.empty() ? 0 : sum / double(map.size());
}

} // namespace vkpt::analysis

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/physical_sky.hpp"

#include "common/colour.hpp"
#include "ref_vkpt/scene/sky_sun.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

namespace vkpt {

namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float lowest_cosine = 0.02f; // of a direction with the zenith: the model ends at the horizon
constexpr float below_horizon = 0.4f; // what the ground's haze is of the sky that it mirrors
constexpr float disc_cosine = 0.99995f; // of half a degree: a disc in the texture has to cover a texel

// CIE xyY to linear sRGB.
glm::vec3 to_rgb(float x, float y, float luminance)
{
    const float scale = luminance / std::max(y, 1e-4f), big_x = x * scale, big_z = (1 - x - y) * scale;
    return { 3.2406f * big_x - 1.5372f * luminance - 0.4986f * big_z,
        -0.9689f * big_x + 1.8758f * luminance + 0.0415f * big_z,
        0.0557f * big_x - 0.2040f * luminance + 1.0570f * big_z };
}

// The chromaticity at the zenith (Preetham et al., appendix A.2): a matrix between powers of turbidity and sun angle.
float zenith_chromaticity(const float (&matrix)[3][4], float turbidity, float angle)
{
    const float powers[] = { angle * angle * angle, angle * angle, angle, 1 },
                haze[] = { turbidity * turbidity, turbidity, 1 };
    float sum = 0;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++)
            sum += haze[row] * matrix[row][column] * powers[column];
    return sum;
}

} // namespace

float PhysicalSky::Perez::at(float cosine, float angle, float angle_cosine) const
{
    return (1 + a * std::exp(b / cosine)) * (1 + c * std::exp(d * angle) + e * angle_cosine * angle_cosine);
}

PhysicalSky::PhysicalSky(glm::vec3 to_sun, float turbidity)
    : to_sun_(glm::normalize(glm::vec3(to_sun.x, to_sun.y, std::max(to_sun.z, lowest_cosine))))
    , turbidity_(turbidity)
    , sun_angle_(std::acos(std::clamp(to_sun_.z, 0.0f, 1.0f)))
{
    const float t = turbidity;
    luminance_ = { 0.1787f * t - 1.4630f, -0.3554f * t + 0.4275f, -0.0227f * t + 5.3251f, 0.1206f * t - 2.5771f,
        -0.0670f * t + 0.3703f };
    x_ = { -0.0193f * t - 0.2592f, -0.0665f * t + 0.0008f, -0.0004f * t + 0.2125f, -0.0641f * t - 0.8989f,
        -0.0033f * t + 0.0452f };
    y_ = { -0.0167f * t - 0.2608f, -0.0950f * t + 0.0092f, -0.0079f * t + 0.2102f, -0.0441f * t - 1.6537f,
        -0.0109f * t + 0.0529f };
    const float chi = (4.0f / 9 - t / 120) * (pi - 2 * sun_angle_);
    const float luminance = std::max((4.0453f * t - 4.9710f) * std::tan(chi) - 0.2155f * t + 2.4192f, 0.05f);
    const float of_x[3][4] = { { 0.00166f, -0.00375f, 0.00209f, 0 }, { -0.02903f, 0.06377f, -0.03202f, 0.00394f },
        { 0.11693f, -0.21196f, 0.06052f, 0.25886f } };
    const float of_y[3][4] = { { 0.00275f, -0.00610f, 0.00317f, 0 }, { -0.04214f, 0.08970f, -0.04153f, 0.00516f },
        { 0.15346f, -0.26756f, 0.06670f, 0.26688f } };
    const float cosine = std::cos(sun_angle_);
    zenith_ = { luminance / luminance_.at(1, sun_angle_, cosine),
        zenith_chromaticity(of_x, t, sun_angle_) / x_.at(1, sun_angle_, cosine),
        zenith_chromaticity(of_y, t, sun_angle_) / y_.at(1, sun_angle_, cosine) };
}

glm::vec3 PhysicalSky::radiance(glm::vec3 direction) const
{
    const float share = direction.z < 0 ? below_horizon : 1, cosine = std::max(std::abs(direction.z), lowest_cosine);
    const glm::vec3 above(direction.x, direction.y, std::abs(direction.z));
    const float angle_cosine = std::clamp(glm::dot(above, to_sun_), -1.0f, 1.0f), angle = std::acos(angle_cosine);
    const glm::vec3 colour = to_rgb(zenith_.y * x_.at(cosine, angle, angle_cosine),
        zenith_.z * y_.at(cosine, angle, angle_cosine), zenith_.x * luminance_.at(cosine, angle, angle_cosine));
    return share * glm::max(colour, glm::vec3(0));
}

// What the air lets through (appendix A.1): Rayleigh's and Angstrom's scattering at three wavelengths.
glm::vec3 PhysicalSky::sun_irradiance() const
{
    constexpr float above_air = 128; // thousands of lux
    const glm::vec3 micrometres(0.65f, 0.57f, 0.475f);
    const float degrees = glm::degrees(sun_angle_);
    const float mass = 1 / (to_sun_.z + 0.15f * std::pow(93.885f - degrees, -1.253f));
    const float beta = 0.04608f * turbidity_ - 0.04586f;
    glm::vec3 result;
    for (int i = 0; i < 3; i++) {
        const float rayleigh = 0.008735f * std::pow(micrometres[i], -4.08f);
        const float haze = beta * std::pow(micrometres[i], -1.3f);
        result[i] = above_air * std::exp(-(rayleigh + haze) * mass);
    }
    return result;
}

glm::vec3 PhysicalSky::level_irradiance() const
{
    constexpr int rings = 32, sectors = 64;
    glm::vec3 sum(0);
    for (int ring = 0; ring < rings; ring++)
        for (int sector = 0; sector < sectors; sector++) {
            // Evenly spread over the projected hemisphere.
            const float sine = std::sqrt((float(ring) + 0.5f) / rings),
                        turn = 2 * pi * (float(sector) + 0.5f) / sectors;
            sum += radiance({ sine * std::cos(turn), sine * std::sin(turn), std::sqrt(1 - sine * sine) });
        }
    return sum * (pi / (rings * sectors));
}

float light_of_map_sun(const PhysicalSky& sky)
{
    constexpr float lowest = 0.1736f; // sine of 10 degrees
    const PhysicalSky higher({ std::sqrt(1 - lowest * lowest), 0, lowest }, sky.turbidity());
    return std::max(
        { luminance(sky.sun_irradiance()), luminance(higher.sun_irradiance()), luminance(sky.level_irradiance()) / 2 });
}

float brightest_of_sky(const PhysicalSky& sky)
{
    constexpr float glare = 0.97f; // cosine of 14 degrees
    constexpr int steps = 24;
    float brightest = 0;
    for (size_t side = 0; side < 6; side++)
        for (int y = 0; y < steps; y++)
            for (int x = 0; x < steps; x++) {
                const glm::vec2 place((float(x) + 0.5f) / steps * 2 - 1, (float(y) + 0.5f) / steps * 2 - 1);
                const glm::vec3 direction = direction_on_sky(side, place);
                if (glm::dot(direction, sky.to_sun()) > glare)
                    continue;
                const glm::vec3 colour = sky.radiance(direction);
                brightest = std::max({ brightest, colour.x, colour.y, colour.z });
            }
    return brightest;
}

formats::Image draw_sky_side(const PhysicalSky& sky, size_t side, int size, float white)
{
    formats::Image image { size, size, {} };
    image.pixels.reserve(size_t(size) * size_t(size));
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            const glm::vec2 place((float(x) + 0.5f) / float(size) * 2 - 1, (float(y) + 0.5f) / float(size) * 2 - 1);
            const glm::vec3 direction = direction_on_sky(side, place);
            const bool in_disc = glm::dot(direction, sky.to_sun()) > disc_cosine;
            const glm::vec3 colour = in_disc ? glm::vec3(1) : sky.radiance(direction) / white;
            uint8_t bytes[3];
            for (int i = 0; i < 3; i++)
                bytes[i] = uint8_t(std::lround(255 * encode_srgb(std::clamp(colour[i], 0.0f, 1.0f))));
            image.pixels.push_back({ bytes[0], bytes[1], bytes[2], 255 });
        }
    return image;
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// Direct light against closed forms: polygons after Lambert, spheres. Surfaces are matte and white.
#include "ref_vkpt/lights/emitters.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <numbers>

namespace vkpt::tests {
namespace {

constexpr float floor_half = 300;
constexpr int light_value = 1000;

// What the light, seen from below, emits. It lights nothing that it sees: its own plane is dark otherwise.
float measure_emission(Session& session, const Polygon& light)
{
    glm::vec3 middle(0);
    for (const glm::vec3& corner : light)
        middle += corner / float(light.size());
    session.look(middle - glm::vec3(0, 0, 40), middle, 2);
    session.draw();
    return session.capture().mean().y;
}

// The part of the polygon above the horizon of `normal`, as seen from the origin.
std::vector<glm::dvec3> clip_to_horizon(const std::vector<glm::dvec3>& polygon, glm::dvec3 normal)
{
    std::vector<glm::dvec3> kept;
    for (size_t i = 0; i < polygon.size(); i++) {
        const glm::dvec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double height_a = glm::dot(a, normal), height_b = glm::dot(b, normal);
        if (height_a >= 0)
            kept.push_back(a);
        if ((height_a >= 0) != (height_b >= 0))
            kept.push_back(a + (b - a) * (height_a / (height_a - height_b)));
    }
    return kept;
}

// Lambert: irradiance / pi at `p` from a polygon of radiance 1 whose front sees `p`.
double lambert_irradiance(const Polygon& light, glm::vec3 p, glm::vec3 unit_normal)
{
    const glm::dvec3 normal(unit_normal);
    std::vector<glm::dvec3> corners;
    for (const glm::vec3& corner : light)
        corners.push_back(glm::dvec3(corner) - glm::dvec3(p));
    corners = clip_to_horizon(corners, normal);
    double sum = 0;
    for (size_t i = 0; i < corners.size(); i++) {
        const glm::dvec3 a = glm::normalize(corners[i]), b = glm::normalize(corners[(i + 1) % corners.size()]);
        const glm::dvec3 across = glm::cross(a, b);
        const double sine = glm::length(across);
        if (sine > 0)
            sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(normal, across) / sine;
    }
    return 0.5 * std::abs(sum) / std::numbers::pi;
}

struct LambertCase {
    const char* name;
    const char* sampler;
    Polygon light; // faces down
};

void PrintTo(const LambertCase& c, std::ostream* stream) { *stream << c.name << " by " << c.sampler; }

class Lambert : public testing::TestWithParam<LambertCase> {
protected:
    Lambert()
    {
        folder_.add_wall("floor", white_index);
        folder_.add_wall("lamp", white_index);
        MapBuilder map;
        const uint16_t floor = map.add_material("floor"), lamp = map.add_material("lamp", 0, light_value);
        map.add(rectangle({ 0, 0, 0 }, { floor_half, 0, 0 }, { 0, floor_half, 0 }), floor);
        map.add(GetParam().light, lamp);
        folder_.add_map("lambert", map.finish());
    }

    GameFolder folder_;
};

const Polygon triangle { { -24, -16, 128 }, { 0, 32, 128 }, { 40, -8, 128 } };
const Polygon quad { { -70, -20, 110 }, { -70, 60, 130 }, { 30, 60, 130 }, { 30, -20, 110 } };

INSTANTIATE_TEST_SUITE_P(Lights, Lambert,
    testing::Values(LambertCase { "Triangle", "uniform", triangle }, LambertCase { "Triangle", "subset", triangle },
        LambertCase { "Quad", "uniform", quad }, LambertCase { "Quad", "subset", quad }),
    [](const auto& test) { return std::string(test.param.name) + "_" + test.param.sampler; });

// 256 copies of each probe, averaged: copies draw numbers of their own.
TEST_P(Lambert, ProbesAgree)
{
    constexpr size_t copies = 1024;
    constexpr double tolerance = 0.005;
    const std::array<IrradianceProbe, 5> places { {
        { { 0, 0, 0 }, { 0, 0, 1 } }, { { 150, -100, 0 }, { 0, 0, 1 } }, { { -120, 80, 40 }, { 0.6f, 0, 0.8f } },
        { { 20, 10, 60 }, { 0, 0, 1 } }, { { 10, 10, 20 }, { 0.995037f, 0, 0.0995037f } }, // cut by the horizon
    } };
    std::vector<IrradianceProbe> probes;
    for (const IrradianceProbe& place : places)
        probes.insert(probes.end(), copies, place);
    Session session(folder_, matte);
    session.set("pt_light_sampler", GetParam().sampler);
    session.load_map("lambert");
    const float emission = measure_emission(session, GetParam().light);
    const std::vector<glm::vec3> measured = session.probe(probes, 1024);
    for (size_t i = 0; i < places.size(); i++) {
        double sum = 0;
        for (size_t copy = 0; copy < copies; copy++)
            sum += measured[i * copies + copy].y;
        const glm::vec3 p = places[i].position;
        const glm::vec3 n = places[i].normal;
        const double expected = emission * lambert_irradiance(GetParam().light, p, n);
        EXPECT_NEAR(sum / copies / expected, 1, tolerance) << "probe " << i;
    }
}

// Blocks of 8 x 8 pixels of a view that looks at nothing but floor.
TEST_P(Lambert, PictureAgrees)
{
    constexpr int block = 8, places_per_pixel = 4;
    constexpr double tolerance = 0.005;
    Session session(folder_, matte, { 32, 24 });
    session.set("pt_light_sampler", GetParam().sampler);
    session.load_map("lambert");
    const float emission = measure_emission(session, GetParam().light);
    session.look({ 20, -140, 90 }, { 0, -50, 0 }, 60);
    const Radiance picture = session.accumulate(2048);
    const auto expected_at = [&](glm::vec2 place) {
        const CameraRay ray = camera_ray(session.view, place);
        const glm::vec3 p = ray.origin - ray.direction * (ray.origin.z / ray.direction.z);
        EXPECT_LT(ray.direction.z, 0);
        EXPECT_LT(std::max(std::abs(p.x), std::abs(p.y)), floor_half);
        return emission * lambert_irradiance(GetParam().light, p, { 0, 0, 1 });
    };
    double worst = 0;
    for (int y = 0; y < picture.height; y += block)
        for (int x = 0; x < picture.width; x += block) {
            double expected = 0;
            constexpr int places = block * places_per_pixel;
            for (int i = 0; i < places * places; i++)
                expected += expected_at({ float(x) + (float(i % places) + 0.5f) / places_per_pixel,
                    float(y) + (float(i / places) + 0.5f) / places_per_pixel });
            expected /= places * places;
            const double ratio = picture.mean({ x, y }, { x + block, y + block }).y / expected;
            worst = std::max(worst, std::abs(ratio - 1));
            EXPECT_NEAR(ratio, 1, tolerance) << "block at " << x << ", " << y;
        }
    RecordProperty("worst_error", std::to_string(worst));
}

// Every sampler, weight and way to choose a point, more coarsely. Without bounces MIS has to trace rays for emission
// alone.
TEST(LambertOfSamplers, Agree)
{
    constexpr size_t copies = 512;
    constexpr double tolerance = 0.01;
    GameFolder folder;
    folder.add_wall("floor", white_index);
    folder.add_wall("lamp", white_index);
    MapBuilder map;
    const uint16_t floor = map.add_material("floor"), lamp = map.add_material("lamp", 0, light_value);
    map.add(rectangle({ 0, 0, 0 }, { floor_half, 0, 0 }, { 0, floor_half, 0 }), floor);
    map.add(quad, lamp);
    folder.add_map("lambert", map.finish());
    Session session(folder, matte);
    session.load_map("lambert");
    const float emission = measure_emission(session, quad);
    const IrradianceProbe place { { -20, 80, 70 }, { 0, 0, 1 } };
    const double expected = emission * lambert_irradiance(quad, { -20, 80, 70 }, { 0, 0, 1 });
    const std::vector<IrradianceProbe> probes(copies, place);
    const auto expect_agreement = [&](const std::string& what) {
        double sum = 0;
        for (const glm::vec3& measured : session.probe(probes, 256))
            sum += double(measured.y);
        EXPECT_NEAR(sum / copies / expected, 1, tolerance) << what;
    };
    for (const std::string& name : unbiased_samplers(session.extension().info())) {
        session.set("pt_light_sampler", name);
        for (const char* point : { "area", "solid_angle", "projected" }) {
            session.set("pt_light_point", point);
            session.set("pt_light_weight", std::string(point) == "area" ? "ltc" : "brdf_centre");
            expect_agreement(name + " " + point);
        }
    }
}

constexpr float light_height = 100, light_number = 200;

// Irradiance / pi of a point light over a floor: a sphere of radiance L above the horizon gives pi L (r / d)^2 cos.
double sphere_irradiance(glm::vec3 light, glm::vec3 p)
{
    const double intensity = EmissionScales().point * std::pow(double(light_number), 3);
    const glm::dvec3 to_light(light - p);
    const double d = glm::length(to_light);
    return intensity * to_light.z / (d * d * d) / std::numbers::pi;
}

class PointLight : public testing::Test {
protected:
    static constexpr int style = 32;
    const glm::vec3 light_ { 16, -8, light_height };
    const std::array<glm::vec3, 4> places_ { { { 16, -8, 0 }, { 100, 0, 0 }, { -150, 120, 0 }, { 0, 0, 60 } } };

    PointLight()
    {
        folder_.add_wall("floor", white_index);
        MapBuilder map;
        map.add(rectangle({ 0, 0, -1 }, { floor_half, 0, 0 }, { 0, floor_half, 0 }), map.add_material("floor"));
        map.add_point_light(light_, light_number, style);
        folder_.add_map("light", map.finish());
    }

    // Irradiance / pi at each place.
    std::vector<double> measure(Session& session)
    {
        constexpr size_t copies = 256;
        std::vector<IrradianceProbe> probes;
        for (const glm::vec3& p : places_)
            probes.insert(probes.end(), copies, { { p.x, p.y, p.z }, { 0, 0, 1 } });
        const std::vector<glm::vec3> measured = session.probe(probes, 64);
        std::vector<double> result;
        for (size_t i = 0; i < places_.size(); i++) {
            double sum = 0;
            for (size_t copy = 0; copy < copies; copy++)
                sum += measured[i * copies + copy].y;
            result.push_back(sum / copies);
        }
        return result;
    }

    GameFolder folder_;
};

TEST_F(PointLight, LightsAFloorAsASphereDoes)
{
    for (const char* radius : { "1", "4", "16" }) {
        CvarList cvars = matte;
        cvars.push_back({ "pt_point_light_radius", radius });
        Session session(folder_, cvars);
        session.load_map("light");
        const std::vector<double> measured = measure(session);
        for (size_t i = 0; i < places_.size(); i++)
            EXPECT_NEAR(measured[i] / sphere_irradiance(light_, places_[i]), 1, 0.01)
                << "radius " << radius << ", place " << i;
    }
}

TEST_F(PointLight, FollowsLightstyleAndEmissionScale)
{
    Session session(folder_, matte);
    session.load_map("light");
    const std::vector<double> plain = measure(session);
    const auto expect_scaled = [&](double factor, const char* what) {
        const std::vector<double> scaled = measure(session);
        for (size_t i = 0; i < places_.size(); i++)
            EXPECT_NEAR(scaled[i], factor * plain[i], 1e-4 * plain[i]) << what << ", place " << i;
    };
    for (const float scale : { 0.0f, 0.25f, 2.0f }) {
        session.light_style(style, scale);
        expect_scaled(scale, "lightstyle");
    }
    session.light_style(style, 1);
    for (const double scale : { 0.5, 3.0 }) {
        session.set("pt_emission_scale", scale);
        expect_scaled(scale, "pt_emission_scale");
    }
}

} // namespace
} // namespace vkpt::tests

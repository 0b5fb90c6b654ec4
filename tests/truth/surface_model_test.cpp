// SPDX-License-Identifier: GPL-2.0-or-later
// The checking path tracer is itself checked: its densities and its reflectance, and a furnace.
#include "tests/truth/path_tracer.hpp"
#include "tests/truth/surface_model.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace vkpt::truth {
namespace {

using std::numbers::pi;

SurfacePoint make_surface(double roughness, double metallic, double angle)
{
    SurfacePoint s;
    s.normal = s.geometric_normal = { 0, 0, 1 };
    s.view = { std::sin(angle), 0, std::cos(angle) };
    s.albedo = { 0.8, 0.5, 0.2 };
    s.roughness = roughness;
    s.metallic = metallic;
    return s;
}

// Reflected light under a white sky, by a grid over the hemisphere.
dvec3 integrate(const SurfacePoint& s)
{
    constexpr int rows = 500, columns = 500;
    dvec3 sum(0);
    for (int row = 0; row < rows; row++)
        for (int column = 0; column < columns; column++) {
            const double z = (row + 0.5) / rows, sine = std::sqrt(1 - z * z),
                         around = 2 * pi * (column + 0.5) / columns;
            sum += reflect_light(s, { sine * std::cos(around), sine * std::sin(around), z });
        }
    return sum * (2 * pi / (rows * columns));
}

TEST(SurfaceModel, ScatteredRaysEstimateTheIntegral)
{
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> uniform;
    for (const double roughness : { 0.3, 0.6, 1.0 })
        for (const double metallic : { 0.0, 0.4, 1.0 })
            for (const double angle : { 0.2, 1.2 }) {
                const SurfacePoint s = make_surface(roughness, metallic, angle);
                constexpr int count = 100'000;
                dvec3 by_scatter(0);
                for (int i = 0; i < count; i++) {
                    const ScatteredRay ray = scatter(s, { uniform(engine), uniform(engine), uniform(engine) });
                    if (ray.pdf > 0)
                        by_scatter += reflect_light(s, ray.direction) / ray.pdf / double(count);
                }
                const dvec3 expected = integrate(s);
                SCOPED_TRACE(testing::Message() << roughness << " " << metallic << " " << angle);
                for (int channel = 0; channel < 3; channel++) {
                    EXPECT_NEAR(by_scatter[channel], expected[channel], 0.01 * expected[channel]);
                    EXPECT_LE(by_scatter[channel], 1.01); // no surface reflects more than it receives
                }
            }
}

// Inside of a box that shines with 0.5 and reflects half of it, one bounce more adds half of the one before.
TEST(PathTracer, FurnaceGrowsAsASeries)
{
    ExportedScene scene;
    scene.masks = { 1, 2, 4, 8, 16, 32 };
    scene.camera = { { 0.1, 0.2, 0.3 }, { 1, 0, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, 8, 8 };
    scene.materials.push_back({ dvec3(1), dvec3(0), dvec3(0.5), dvec3(0.5) });
    const auto corner = [](int bits) { return dvec3(bits & 1 ? 1 : -1, bits & 2 ? 1 : -1, bits & 4 ? 1 : -1); };
    // Quads whose corners run around, seen from inside.
    const int quads[6][4]
        = { { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 2, 3, 1 }, { 4, 5, 7, 6 } };
    for (const auto& quad : quads)
        for (const int half : { 0, 1 }) {
            Triangle triangle;
            triangle.positions = { corner(quad[0]), corner(quad[half ? 2 : 1]), corner(quad[half ? 3 : 2]) };
            dvec3 normal = glm::cross(
                triangle.positions[1] - triangle.positions[0], triangle.positions[2] - triangle.positions[0]);
            if (glm::dot(normal, triangle.positions[0]) > 0) {
                std::swap(triangle.positions[1], triangle.positions[2]);
                normal = -normal;
            }
            triangle.normals.fill(glm::normalize(normal));
            triangle.ray_mask = 1;
            triangle.emitter = int(scene.emitters.size());
            scene.triangles.push_back(triangle);
            Emitter emitter;
            emitter.corners = triangle.positions;
            emitter.radiance = dvec3(0.5);
            emitter.area = glm::length(normal) / 2;
            scene.emitters.push_back(emitter);
        }
    for (const int bounces : { 0, 1, 3 }) {
        const std::vector<dvec3> picture = render(scene, { bounces, 256, 1 });
        double mean = 0;
        for (const dvec3& pixel : picture)
            mean += pixel.x / double(picture.size());
        EXPECT_NEAR(mean, 1 - std::pow(0.5, bounces + 2), 0.004) << bounces;
    }
}

} // namespace
} // namespace vkpt::truth

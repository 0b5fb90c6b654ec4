// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/truth/path_tracer.hpp"

#include "common/colour.hpp"
#include "common/parallel.hpp"
#include "tests/truth/ray_tree.hpp"
#include "tests/truth/surface_model.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <stdexcept>

namespace vkpt::truth {

namespace {

using std::numbers::pi;

class Random {
public:
    explicit Random(uint64_t seed)
        : engine_(seed)
    {
    }
    double next() { return std::generate_canonical<double, 53>(engine_); }

private:
    std::mt19937_64 engine_;
};

// A texel, repeated; pictures of the sky end above and below, where no direction points.
dvec3 read_texel(const Picture& picture, dvec2 uv)
{
    const dvec2 place = (uv - glm::floor(uv)) * dvec2(picture.width, picture.height);
    const int x = std::min(int(place.x), picture.width - 1), y = std::min(int(place.y), picture.height - 1);
    return picture.texels[size_t(y) * size_t(picture.width) + size_t(x)];
}

dvec3 see_sky(const Sky& sky, dvec3 direction)
{
    if (sky.picture.texels.empty())
        return sky.radiance;
    const dvec3 d = direction * sky.rotation;
    const dvec2 uv(0.5 - std::atan2(d.y, d.x) / (2 * pi), std::acos(std::clamp(d.z, -1.0, 1.0)) / pi);
    return sky.radiance * read_texel(sky.picture, uv);
}

// What a ray meets there.
struct Met {
    SurfacePoint surface;
    dvec3 emission { 0 };
    const Triangle* triangle = nullptr;
    const Material* material = nullptr;
};

Met make_met(const ExportedScene& scene, const RayHit& hit, dvec3 direction)
{
    Met met;
    met.triangle = &scene.triangles[size_t(hit.triangle)];
    met.material = &scene.materials[met.triangle->material];
    const auto& p = met.triangle->positions;
    const double b0 = 1 - hit.b1 - hit.b2;
    const auto mix = [&](const auto& v) { return v[0] * b0 + v[1] * hit.b1 + v[2] * hit.b2; };
    SurfacePoint& s = met.surface;
    s.position = mix(p);
    s.view = -direction;
    s.geometric_normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    const bool is_front = glm::dot(s.geometric_normal, s.view) > 0;
    s.geometric_normal *= is_front ? 1 : -1;
    s.normal = glm::normalize(mix(met.triangle->normals)) * (is_front ? 1.0 : -1.0);
    const Material& m = *met.material;
    s.roughness = m.roughness;
    s.metallic = m.metallic;
    s.specular = m.specular;
    s.albedo = m.base_colour;
    met.emission = m.emission;
    if (m.picture >= 0) {
        const dvec3 colour = read_texel(scene.pictures[size_t(m.picture)], mix(met.triangle->uvs));
        s.albedo = glm::clamp(colour * m.tint, 0.0, 1.0);
        met.emission = colour * m.emission_tint;
    }
    if (!is_front)
        met.emission = dvec3(0);
    return met;
}

// A point on an emitter, and its density per solid angle at the receiver; 0: it does not shine there.
struct LightPoint {
    dvec3 point { 0 };
    double pdf = 0;
};

// Uniform over the area; the density becomes one of solid angle.
LightPoint finish_point(dvec3 point, dvec3 normal, double area, dvec3 receiver)
{
    const dvec3 way = receiver - point;
    const double distance2 = glm::dot(way, way), cosine = glm::dot(normal, way) / std::sqrt(distance2);
    return { point, cosine > 0 ? distance2 / (cosine * area) : 0 };
}

// Arvo 1995: uniform over the solid angle. pdf 0 where the triangle is too small for it.
LightPoint sample_spherical_triangle(const std::array<dvec3, 3>& corners, dvec3 receiver, dvec2 xi)
{
    const dvec3 a = glm::normalize(corners[0] - receiver), b = glm::normalize(corners[1] - receiver),
                c = glm::normalize(corners[2] - receiver);
    const dvec3 ab = glm::cross(a, b), bc = glm::cross(b, c), ca = glm::cross(c, a);
    const auto angle = [](dvec3 m, dvec3 n) {
        return std::acos(std::clamp(glm::dot(m, -n) / std::sqrt(glm::dot(m, m) * glm::dot(n, n)), -1.0, 1.0));
    };
    const double alpha = angle(ab, ca), beta = angle(ab, bc), gamma = angle(bc, ca);
    const double solid_angle = alpha + beta + gamma - pi;
    if (!(solid_angle > 1e-6))
        return {};
    const double part = xi.x * solid_angle, s = std::sin(part - alpha), t = std::cos(part - alpha);
    const double u = t - std::cos(alpha), v = s + std::sin(alpha) * glm::dot(a, b);
    const double q
        = std::clamp(((v * t - u * s) * std::cos(alpha) - v) / ((v * s + u * t) * std::sin(alpha)), -1.0, 1.0);
    const auto across = [](dvec3 from, dvec3 axis) { return glm::normalize(from - axis * glm::dot(from, axis)); };
    const dvec3 moved = a * q + across(c, a) * std::sqrt(1 - q * q);
    const double z = 1 - xi.y * (1 - glm::dot(moved, b));
    const dvec3 direction = b * z + across(moved, b) * std::sqrt(std::max(0.0, 1 - z * z));
    const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double distance = glm::dot(corners[0] - receiver, normal) / glm::dot(direction, normal);
    if (!(distance > 0))
        return {};
    return { receiver + direction * distance, 1 / solid_angle };
}

LightPoint sample_triangle(const Emitter& emitter, dvec3 receiver, dvec2 xi)
{
    const auto& p = emitter.corners;
    const dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    if (glm::dot(receiver - p[0], normal) <= 0)
        return {};
    const LightPoint spherical = sample_spherical_triangle(p, receiver, xi);
    if (spherical.pdf > 0)
        return spherical;
    const double root = std::sqrt(xi.x);
    const dvec3 point = p[0] * (1 - root) + p[1] * (root * (1 - xi.y)) + p[2] * (root * xi.y);
    return finish_point(point, glm::normalize(normal), emitter.area, receiver);
}

LightPoint sample_sphere(const Emitter& emitter, dvec3 receiver, dvec2 xi)
{
    const double z = 2 * xi.x - 1, sine = std::sqrt(std::max(0.0, 1 - z * z)), around = 2 * pi * xi.y;
    const dvec3 normal(sine * std::cos(around), sine * std::sin(around), z);
    return finish_point(
        emitter.centre + normal * emitter.radius, normal, 4 * pi * emitter.radius * emitter.radius, receiver);
}

class Tracer {
public:
    Tracer(const ExportedScene& scene, const TraceSettings& settings)
        : scene_(scene)
        , settings_(settings)
        , tree_(scene.triangles)
    {
        const RayMasks& m = scene.masks;
        camera_mask_ = m.opaque | m.alpha_test | m.translucent | m.view_weapon | m.sky;
        bounce_mask_ = m.opaque | m.alpha_test | m.own_body | m.sky;
        for (size_t i = 0; i < scene.emitters.size(); i++)
            if (scene.emitters[i].radiance != dvec3(0))
                lights_.push_back(scene.emitters[i]);
    }

    dvec3 trace_pixel(int x, int y, Random& random) const
    {
        const Camera& camera = scene_.camera;
        const double px = (x + random.next()) / camera.width * 2 - 1, py = 1 - (y + random.next()) / camera.height * 2;
        const dvec3 direction = glm::normalize(camera.forward + camera.right * px + camera.up * py);
        const RayHit hit = tree_.find_nearest(camera.position, direction, far_, camera_mask_);
        if (hit.triangle < 0)
            return see_sky(scene_.sky, direction);
        const Met met = make_met(scene_, hit, direction);
        if (met.material->is_sky)
            return see_sky(scene_.sky, direction);
        if (met.material->is_translucent)
            throw std::runtime_error("a camera ray meets a translucent surface, which is not modelled");
        return met.emission + follow(met.surface, random);
    }

private:
    // Light that a surface sends back, and what the next ones add to it.
    dvec3 follow(SurfacePoint surface, Random& random) const
    {
        dvec3 radiance(0), throughput(1);
        for (int bounce = 0;; bounce++) {
            radiance += throughput * light_directly(surface, random);
            if (bounce == settings_.bounces)
                return radiance;
            const ScatteredRay ray = scatter(surface, { random.next(), random.next(), random.next() });
            if (ray.pdf <= 0)
                return radiance;
            throughput *= reflect_light(surface, ray.direction) / ray.pdf;
            const RayHit hit = tree_.find_nearest(leave(surface), ray.direction, far_, bounce_mask_);
            if (hit.triangle < 0 || throughput == dvec3(0))
                return radiance;
            const Met met = make_met(scene_, hit, ray.direction);
            // The lights of the lists are counted by light_directly.
            if (met.triangle->emitter == -1)
                radiance += throughput * (met.material->is_sky ? see_sky(scene_.sky, ray.direction) : met.emission);
            if (met.material->is_sky)
                return radiance;
            surface = met.surface;
        }
    }

    static dvec3 leave(const SurfacePoint& s)
    {
        return s.position + s.geometric_normal * (1e-4 + 1e-7 * glm::length(s.position));
    }

    // About what a light sends to a surface if nothing is between; 0 only where it sends nothing.
    static double weigh(const Emitter& emitter, const SurfacePoint& s)
    {
        const double power = luminance(emitter.radiance) * emitter.area;
        if (emitter.type == EmitterType::sphere) {
            const dvec3 way = emitter.centre - s.position;
            const double height = glm::dot(way, s.geometric_normal), distance = glm::length(way);
            return height < -emitter.radius ? 0
                                            : power * (0.1 + std::max(0.0, height / distance))
                    / std::max(distance * distance, emitter.radius * emitter.radius);
        }
        const auto& p = emitter.corners;
        const dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
        const bool is_behind = std::ranges::all_of(
            p, [&](dvec3 corner) { return glm::dot(corner - s.position, s.geometric_normal) <= 0; });
        const double front = glm::dot(s.position - p[0], normal);
        if (is_behind || front <= 0)
            return 0;
        const dvec3 way = (p[0] + p[1] + p[2]) / 3.0 - s.position;
        const double distance2 = glm::dot(way, way), distance = std::sqrt(distance2);
        const double cosine = std::max(0.0, glm::dot(way, s.geometric_normal) / distance);
        const double other = std::max(0.0, -glm::dot(way, normal)) / (distance * glm::length(normal));
        return power * (0.1 + cosine) * (0.1 + other) / std::max(distance2, emitter.area / 4);
    }

    dvec3 light_directly(const SurfacePoint& s, Random& random) const
    {
        // One light, chosen in proportion to its weight (weighted reservoir sampling with one place).
        const Emitter* chosen = nullptr;
        double sum = 0, own = 0;
        for (const Emitter& emitter : lights_) {
            const double weight = weigh(emitter, s);
            if (weight <= 0)
                continue;
            sum += weight;
            if (random.next() * sum < weight) {
                chosen = &emitter;
                own = weight;
            }
        }
        if (!chosen)
            return dvec3(0);
        const dvec3 origin = leave(s);
        const dvec2 xi(random.next(), random.next());
        const LightPoint light = chosen->type == EmitterType::sphere ? sample_sphere(*chosen, origin, xi)
                                                                     : sample_triangle(*chosen, origin, xi);
        if (light.pdf <= 0)
            return dvec3(0);
        const dvec3 way = light.point - origin;
        const double distance = glm::length(way);
        const dvec3 direction = way / distance, reflected = reflect_light(s, direction);
        if (reflected == dvec3(0)
            || tree_.is_blocked(origin, direction, distance - std::max(1e-3, 1e-5 * distance), bounce_mask_))
            return dvec3(0);
        const dvec3 radiance = chosen->type == EmitterType::sky ? see_sky(scene_.sky, direction) : chosen->radiance;
        return reflected * radiance / (light.pdf * own / sum);
    }

    static constexpr double far_ = 1e6;
    const ExportedScene& scene_;
    TraceSettings settings_;
    RayTree tree_;
    uint32_t camera_mask_ = 0, bounce_mask_ = 0;
    std::vector<Emitter> lights_;
};

} // namespace

std::vector<dvec3> render(const ExportedScene& scene, const TraceSettings& settings)
{
    const Tracer tracer(scene, settings);
    const int width = scene.camera.width, height = scene.camera.height;
    std::vector<dvec3> picture(size_t(width) * size_t(height), dvec3(0));
    parallel_for(size_t(height), core_count(), [&](size_t y) {
        for (int x = 0; x < width; x++) {
            const size_t pixel = y * size_t(width) + size_t(x);
            Random random(settings.seed * 1'000'003 + pixel);
            for (int i = 0; i < settings.samples_per_pixel; i++)
                picture[pixel] += tracer.trace_pixel(x, int(y), random) / double(settings.samples_per_pixel);
        }
    });
    return picture;
}

} // namespace vkpt::truth

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/map_compiler/lighting.hpp"

#include "common/parallel.hpp"
#include "tools/map_compiler/light_scene.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <optional>

namespace vkpt::tools {

using namespace formats;

namespace {

// Contributions below this (of 255) are not worth a ray.
constexpr double min_contribution = 0.01;

// Texel coordinates to points one unit in front of a face.
class FaceSampler {
public:
    static std::optional<FaceSampler> make(const LightScene& scene, size_t face)
    {
        const Bsp& bsp = scene.bsp;
        FaceSampler sampler;
        sampler.info_ = &bsp.texinfos[bsp.faces[face].texinfo];
        sampler.extent = bsp.lightmap_extent(face);
        if (sampler.extent.size.x <= 0 || sampler.info_->flags & SURF_NODRAW)
            return {};
        sampler.normal = dvec3(bsp.face_normal(face));
        const std::vector<glm::vec3> polygon = bsp.face_polygon(face);
        const dvec3 s(sampler.info_->s_axis), t(sampler.info_->t_axis);
        const glm::dmat3 to_texture = glm::transpose(glm::dmat3(s, t, sampler.normal));
        if (std::abs(glm::determinant(to_texture)) < 1e-9)
            return {};
        sampler.to_world_ = glm::inverse(to_texture);
        sampler.depth_ = glm::dot(dvec3(polygon[0]), sampler.normal) + 1.0;
        sampler.origin_ = scene.face_origin[face];
        Bounds texels;
        for (const glm::vec3& p : polygon)
            texels.add(to_texture * dvec3(p) + dvec3(sampler.info_->s_offset, sampler.info_->t_offset, 0));
        sampler.middle_ = (texels.mins + texels.maxs) * 0.5;
        return sampler;
    }

    // The luxel's point. Luxels that stick out of the face into a wall are drawn towards the face's middle.
    dvec3 find_point(const LightScene& scene, int x, int y) const
    {
        constexpr double step = 8;
        double texel[2] = { extent.min_st.x + 16.0 * x, extent.min_st.y + 16.0 * y };
        const dvec3 middle = to_world(middle_.x, middle_.y);
        dvec3 point = to_world(texel[0], texel[1]);
        for (int attempt = 0; attempt < 6 && is_hidden(scene, middle, point); attempt++) {
            const int axis = attempt % 2 ? 0 : 1;
            const double left = middle_[axis] - texel[axis];
            texel[axis] += std::clamp(left, -step, step);
            point = to_world(texel[0], texel[1]);
        }
        return point;
    }

    Bsp::LightmapExtent extent;
    dvec3 normal { 0 };

private:
    dvec3 to_world(double s, double t) const
    {
        return to_world_ * dvec3(s - info_->s_offset, t - info_->t_offset, depth_) + origin_;
    }

    static bool is_hidden(const LightScene& scene, const dvec3& middle, const dvec3& point)
    {
        return scene.bsp.leaves[scene.bsp.find_leaf(glm::vec3(point), scene.bsp.models[0].head_node)].contents
            & CONTENTS_SOLID
            || scene.occlusion.is_blocked(middle, point);
    }

    const BspTexinfo* info_ = nullptr;
    glm::dmat3 to_world_ { 1 };
    double depth_ = 0;
    dvec3 origin_ { 0 }, middle_ { 0 };
};

struct FaceLight {
    glm::ivec2 size { 0 };
    std::vector<dvec3> points;
    std::map<int, std::vector<dvec3>> styles; // per luxel; style 0 always there
};

// The formulas stand in light_scene.hpp.
double light_amount(const LightSource& source, const dvec3& point, const dvec3& normal)
{
    const dvec3 way = source.position - point;
    const double towards = glm::dot(way, normal), away = -glm::dot(way, source.normal);
    if (towards <= 0 || (source.kind == LightSource::Kind::surface && away <= 0))
        return 0;
    const double distance = glm::length(way), receive = towards / distance, send = away / distance;
    if (receive <= 0.001)
        return 0;
    switch (source.kind) {
    case LightSource::Kind::point:
        return (source.intensity - distance) * receive;
    case LightSource::Kind::spot:
        return send <= source.cone_cosine ? 0 : (source.intensity - distance) * receive;
    case LightSource::Kind::surface:
        return send <= 0.001 ? 0 : source.intensity / (distance * distance) * receive * send;
    }
    return 0;
}

void gather_direct(const LightScene& scene, FaceLight& light, size_t luxel, const dvec3& normal)
{
    const dvec3 point = light.points[luxel];
    const int cluster = scene.bsp.find_cluster(glm::vec3(point));
    if (cluster < 0)
        return;
    for (const int index : scene.cluster_sources[size_t(cluster)]) {
        const LightSource& source = scene.sources[size_t(index)];
        const double amount = light_amount(source, point, normal);
        if (amount < min_contribution || scene.occlusion.is_blocked(point, source.position))
            continue;
        auto& style = light.styles[source.style];
        if (style.empty())
            style.resize(light.points.size(), dvec3(0));
        style[luxel] += source.colour * amount;
    }
}

// A sample counts for every patch of its face that it may touch.
void add_to_patches(std::span<Patch> patches, const dvec3& point, const dvec3& light)
{
    constexpr double reach = 16;
    if (light.x + light.y + light.z < 3)
        return;
    for (Patch& patch : patches) {
        const dvec3 outside = glm::max(patch.bounds.mins - point, point - patch.bounds.maxs);
        if (std::max({ outside.x, outside.y, outside.z }) > reach)
            continue;
        patch.direct += light;
        patch.sample_count++;
    }
}

FaceLight light_face(LightScene& scene, size_t face)
{
    FaceLight light;
    const auto sampler = FaceSampler::make(scene, face);
    if (!sampler)
        return light;
    light.size = sampler->extent.size;
    for (int y = 0; y < light.size.y; y++)
        for (int x = 0; x < light.size.x; x++)
            light.points.push_back(sampler->find_point(scene, x, y));
    light.styles[0].resize(light.points.size(), dvec3(0));
    const std::span<Patch> patches = scene.patches_of(face);
    for (size_t i = 0; i < light.points.size(); i++) {
        gather_direct(scene, light, i, sampler->normal);
        add_to_patches(patches, light.points[i], light.styles[0][i]);
    }
    for (Patch& patch : patches)
        if (patch.sample_count > 0)
            patch.direct /= double(patch.sample_count);
    // What shines is itself bright.
    if (!patches.empty()
        && std::max({ patches[0].emission.x, patches[0].emission.y, patches[0].emission.z }) >= min_emission)
        for (dvec3& luxel : light.styles[0])
            luxel += patches[0].emission;
    return light;
}

// Patches by the plane on which they lie, for interpolation across faces.
using PlanePatches = std::map<std::pair<int, int>, std::vector<const Patch*>>;

PlanePatches sort_by_plane(const LightScene& scene)
{
    PlanePatches result;
    for (const Patch& patch : scene.patches) {
        const BspFace& face = scene.bsp.faces[patch.face];
        result[{ face.plane, face.side }].push_back(&patch);
    }
    return result;
}

// Smooth between the patches' centres: weights fall to zero within one and a half patches.
dvec3 interpolate_bounced(std::span<const Patch* const> patches, const dvec3& point)
{
    constexpr double reach = 1.5 * patch_size;
    dvec3 sum(0), nearest(0);
    double weight_sum = 0, nearest_distance = 1e30;
    for (const Patch* patch : patches) {
        const double distance = glm::distance(point, patch->position);
        if (distance < nearest_distance) {
            nearest_distance = distance;
            nearest = patch->bounced;
        }
        if (distance >= reach)
            continue;
        const double fall = 1 - distance / reach, weight = fall * fall * patch->area;
        sum += patch->bounced * weight;
        weight_sum += weight;
    }
    return weight_sum > 0 ? sum / weight_sum : nearest;
}

// To bytes: at least 1, and too bright luxels are scaled down so that their hue stays.
void store_luxel(std::vector<uint8_t>& lighting, dvec3 light)
{
    light = glm::max(light, dvec3(1));
    const double largest = std::max({ light.x, light.y, light.z });
    light *= std::min(largest, brightest_luxel) / largest;
    for (int i = 0; i < 3; i++)
        lighting.push_back(uint8_t(light[i]));
}

void store_face(Bsp& bsp, size_t index, FaceLight& light, const PlanePatches& plane_patches)
{
    BspFace& face = bsp.faces[index];
    std::ranges::fill(face.styles, uint8_t(255));
    face.light_offset = -1;
    if (light.points.empty())
        return;
    face.light_offset = int32_t(bsp.lighting.size());
    if (const auto it = plane_patches.find({ face.plane, face.side }); it != plane_patches.end())
        for (size_t i = 0; i < light.points.size(); i++)
            light.styles[0][i] += interpolate_bounced(it->second, light.points[i]);
    size_t slot = 0;
    for (const auto& [style, luxels] : light.styles) {
        if (slot == std::size(face.styles))
            break;
        face.styles[slot++] = uint8_t(style);
        for (const dvec3& luxel : luxels)
            store_luxel(bsp.lighting, luxel);
    }
}

} // namespace

void light_map(Bsp& bsp, const SourceMap& world, unsigned threads, const WarningSink& progress)
{
    LightScene scene(bsp, world);
    make_patches(scene);
    make_sources(scene, progress);
    std::vector<FaceLight> lights(bsp.faces.size());
    parallel_for(bsp.faces.size(), threads, [&](size_t face) { lights[face] = light_face(scene, face); });
    const size_t pairs = bounce_light(scene, threads);
    progress(
        fmt::format("{} lights, {} patches, {} pairs in sight", scene.sources.size(), scene.patches.size(), pairs));
    const PlanePatches plane_patches = sort_by_plane(scene);
    bsp.lighting.clear();
    for (size_t face = 0; face < bsp.faces.size(); face++)
        store_face(bsp, face, lights[face], plane_patches);
    constexpr size_t lighting_limit = 0x200000; // what the engine's players were built for
    if (bsp.lighting.size() > lighting_limit)
        progress(fmt::format(
            "warning: {} bytes of light exceed the original game's limit of {}", bsp.lighting.size(), lighting_limit));
}

} // namespace vkpt::tools

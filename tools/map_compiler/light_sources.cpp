// SPDX-License-Identifier: GPL-2.0-or-later
// Where the light comes from: emitting faces, cut to patches, and the map's light entities.
#include "tools/map_compiler/light_scene.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/trigonometric.hpp>
#include <optional>

namespace vkpt::tools {

using namespace formats;

namespace {

// Along the world's grid of patch_size, so that neighbouring faces are cut alike.
std::optional<Plane> find_grid_cut(const Bounds& bounds)
{
    for (int axis = 0; axis < 3; axis++) {
        const double first = std::floor((bounds.mins[axis] + 1) / patch_size);
        if (first < std::floor((bounds.maxs[axis] - 1) / patch_size)) {
            dvec3 normal(0);
            normal[axis] = 1;
            return Plane { normal, patch_size * (first + 1), axis };
        }
    }
    return {};
}

void add_patches(LightScene& scene, const Patch& prototype, const Winding& winding)
{
    if (winding.size() < 3)
        return;
    Patch patch = prototype;
    patch.bounds.add(winding);
    if (const auto cut = find_grid_cut(patch.bounds)) {
        const SplitWinding split = split_winding(winding, *cut, 0.01);
        if (!split.front.empty() && !split.back.empty()) {
            add_patches(scene, prototype, split.front);
            add_patches(scene, prototype, split.back);
            return;
        }
    }
    patch.area = winding_area(winding);
    if (!(patch.area > 0))
        return;
    patch.position = winding_centre(winding) + patch.normal;
    patch.cluster = scene.bsp.find_cluster(glm::vec3(patch.position));
    scene.patches.push_back(patch);
}

double largest_part(const dvec3& colour) { return std::max({ colour.x, colour.y, colour.z }); }

void add_source(LightScene& scene, LightSource source)
{
    source.cluster = scene.bsp.find_cluster(glm::vec3(source.position));
    if (source.cluster >= 0)
        scene.sources.push_back(source);
}

void add_surface_source(LightScene& scene, const Patch& patch)
{
    const double strength = largest_part(patch.emission);
    if (strength < min_emission)
        return;
    LightSource source;
    source.kind = LightSource::Kind::surface;
    source.position = patch.position;
    source.normal = patch.normal;
    source.colour = patch.emission / strength;
    source.intensity = strength * patch.area * surface_light_scale;
    add_source(scene, source);
}

dvec3 angle_direction(double angle)
{
    if (angle == -1 || angle == -2)
        return { 0, 0, angle == -1 ? 1 : -1 };
    return { std::cos(glm::radians(angle)), std::sin(glm::radians(angle)), 0 };
}

void aim_spot(LightScene& scene, LightSource& source, const MapEntity& entity, const WarningSink& warn)
{
    const std::string_view target = entity.get("target");
    if (target.empty() && entity.class_name() != "light_spot")
        return;
    source.kind = LightSource::Kind::spot;
    const double cone = entity.number("_cone", 0);
    source.cone_cosine = std::cos(glm::radians(cone != 0 ? cone : 10.0));
    source.normal = angle_direction(entity.number("angle", 0));
    if (target.empty())
        return;
    for (const MapEntity& other : scene.world.source.entities)
        if (const auto origin = other.vector("origin"); origin && other.get("targetname") == target) {
            const dvec3 way = *origin - source.position;
            if (glm::length(way) > 0)
                source.normal = glm::normalize(way);
            return;
        }
    warn(MapError(scene.world.source.file, entity.line, fmt::format("the light's target \"{}\" does not exist", target))
             .what());
}

void add_entity_source(LightScene& scene, const MapEntity& entity, const WarningSink& warn)
{
    LightSource source;
    source.position = entity.vector("origin").value_or(dvec3(0));
    for (const char* key : { "light", "_light" })
        if (source.intensity == 0)
            source.intensity = entity.number(key, 0);
    if (source.intensity == 0)
        source.intensity = 300;
    if (const auto colour = entity.vector("_color"); colour && largest_part(*colour) > 0)
        source.colour = *colour / largest_part(*colour);
    for (const char* key : { "_style", "style" })
        if (source.style == 0)
            source.style = int(entity.number(key, 0));
    if (source.style < 0 || source.style > 254)
        source.style = 0;
    aim_spot(scene, source, entity, warn);
    add_source(scene, source);
}

} // namespace

void make_patches(LightScene& scene)
{
    for (size_t face = 0; face < scene.bsp.faces.size(); face++) {
        scene.first_patch.push_back(scene.patches.size());
        const size_t texinfo = scene.bsp.faces[face].texinfo;
        const BspTexinfo& info = scene.bsp.texinfos[texinfo];
        Patch patch;
        patch.face = face;
        patch.normal = dvec3(scene.bsp.face_normal(face));
        patch.absorbs = info.flags & SURF_SKY;
        patch.reflectivity = scene.world.reflectivity[texinfo];
        if (info.flags & SURF_LIGHT)
            patch.emission = scene.world.light_colour[texinfo] * double(info.value);
        Winding winding;
        for (const glm::vec3& p : scene.bsp.face_polygon(face))
            winding.push_back(dvec3(p) + scene.face_origin[face]);
        add_patches(scene, patch, winding);
    }
    scene.first_patch.push_back(scene.patches.size());
}

void make_sources(LightScene& scene, const WarningSink& warn)
{
    for (const Patch& patch : scene.patches)
        add_surface_source(scene, patch);
    for (const MapEntity& entity : scene.world.source.entities)
        if (entity.class_name().starts_with("light"))
            add_entity_source(scene, entity, warn);
    scene.cluster_sources.resize(scene.pvs.size());
    for (size_t cluster = 0; cluster < scene.pvs.size(); cluster++)
        for (size_t i = 0; i < scene.sources.size(); i++)
            if (scene.pvs[cluster].contains(scene.sources[i].cluster))
                scene.cluster_sources[cluster].push_back(int(i));
}

} // namespace vkpt::tools

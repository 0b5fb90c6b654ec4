// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/world.hpp"

#include "common/colour.hpp"
#include "formats/material_file.hpp"
#include "ref_vkpt/lights/light_entities.hpp"
#include "ref_vkpt/lights/media.hpp"
#include "ref_vkpt/scene/entity_geometry.hpp"
#include "ref_vkpt/scene/fog.hpp"
#include "ref_vkpt/scene/material_guess.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <map>
#include <span>

namespace vkpt {

namespace {

using namespace formats;

constexpr int several_clusters = -2;

// The PVS cluster of each face that lies in one alone; else several_clusters.
std::vector<int> find_face_clusters(const Bsp& bsp)
{
    constexpr int none = -1;
    std::vector<int> clusters(bsp.faces.size(), none);
    for (const BspLeaf& leaf : bsp.leaves)
        for (size_t i = 0; i < leaf.leaf_face_count; i++) {
            int& cluster = clusters[bsp.leaf_faces[leaf.first_leaf_face + i]];
            cluster = cluster == none || cluster == leaf.cluster ? leaf.cluster : several_clusters;
        }
    return clusters;
}

bool is_translucent(const BspTexinfo& texinfo) { return (texinfo.flags & (SURF_TRANS33 | SURF_TRANS66)) != 0; }

uint32_t triangle_mask(const BspTexinfo& texinfo)
{
    if (texinfo.flags & SURF_SKY)
        return shared::MASK_SKY;
    if (is_translucent(texinfo))
        return shared::MASK_TRANSLUCENT | shared::MASK_FILTER;
    return texinfo.flags & SURF_ALPHATEST ? shared::MASK_ALPHA_TEST : shared::MASK_OPAQUE;
}

// One frame of an animation with holes makes all of them count: structures on the device are built before it is known
// which frame is shown.
bool has_holes(const Bsp& bsp, uint32_t texinfo)
{
    bool holes = false;
    for_each_frame(bsp, texinfo, [&](uint32_t frame) { holes |= (bsp.texinfos[frame].flags & SURF_ALPHATEST) != 0; });
    return holes;
}

// `cluster`: the PVS cluster of the face, or -1.
void append_face(MapGeometry& geometry, const World& world, size_t face, size_t model, int cluster)
{
    const Bsp& bsp = world.bsp;
    const uint32_t texinfo_index = bsp.faces[face].texinfo;
    const BspTexinfo& texinfo = bsp.texinfos[texinfo_index];
    const FaceTexture& texture = world.textures[texinfo_index];
    const uint32_t normal = encode_octahedral(bsp.face_normal(face));
    const uint8_t holes = has_holes(bsp, texinfo_index) ? 1 : 0;
    const bool glows = is_glowing(texinfo, texture);
    const uint32_t medium = medium_of_face(bsp, face, model, texture.medium);
    for (const FaceTriangle& part : world.faces.of(face)) {
        shared::Triangle triangle {};
        for (int i = 0; i < 3; i++) {
            triangle.positions[i] = part.corners[size_t(i)];
            triangle.uvs[i] = bsp.texture_coordinates(texinfo, triangle.positions[i]) / glm::vec2(texture.size);
            triangle.normals[i] = normal;
        }
        const bool is_beside = glows && !texture.parts.empty() && part.part < 0; // the bright parts
        const bool is_dark = is_beside && texture.maps.emissive.slot == 0;
        triangle.material = texinfo_index;
        triangle.emitter = is_beside ? shared::EMITTER_UNLISTED : part.emitter;
        triangle.lightstyle = is_dark ? lightstyle_none : face_lightstyle(bsp.faces[face], texture);
        triangle.cluster = cluster;
        triangle.face = model == 0 ? int(face) + 1 : -int(face) - 1;
        triangle.medium = medium;
        geometry.triangles.push_back(triangle);
        geometry.masks.push_back(triangle_mask(texinfo));
        geometry.has_holes.push_back(holes);
        geometry.has_alpha_test |= holes != 0;
    }
}

// Around the faces that colour light. A little wider than they are, which may be flat.
void find_filter_boxes(MapGeometry& geometry)
{
    constexpr float margin = 1;
    for (size_t i = 0; i < geometry.triangles.size(); i++) {
        if (!(geometry.masks[i] & shared::MASK_FILTER))
            continue;
        const shared::Triangle& t = geometry.triangles[i];
        add_filter_box(geometry.filter_boxes,
            { glm::min(glm::min(t.positions[0], t.positions[1]), t.positions[2]) - margin,
                glm::max(glm::max(t.positions[0], t.positions[1]), t.positions[2]) + margin });
    }
}

MapGeometry make_world_geometry(const World& world, std::vector<shared::Emitter> emitters)
{
    MapGeometry geometry;
    const std::vector<int> clusters = find_face_clusters(world.bsp);
    const BspModel& model = world.bsp.models[0];
    for (size_t face = size_t(model.first_face); face < size_t(model.first_face + model.face_count); face++)
        if (is_drawn(world.bsp.texinfos[world.bsp.faces[face].texinfo]))
            append_face(geometry, world, face, 0, std::max(clusters[face], -1));
    geometry.filter_boxes = find_liquid_boxes(world.bsp);
    find_filter_boxes(geometry);
    geometry.emitters = std::move(emitters);
    for (shared::Emitter& emitter : geometry.emitters)
        if (emitter.type == shared::EMITTER_SKY)
            emitter.lightstyle = lightstyle_sky;
    return geometry;
}

MapGeometry make_brush_geometry(World& world, size_t index, const EmissionSource& source)
{
    MapGeometry geometry;
    const BspModel& model = world.bsp.models[index];
    for (size_t face = size_t(model.first_face); face < size_t(model.first_face + model.face_count); face++) {
        if (!is_drawn(world.bsp.texinfos[world.bsp.faces[face].texinfo]))
            continue;
        std::vector<shared::Emitter> emitters = emitters_of_face(source, face, world.faces.of(face));
        world.animated_lights.add(source, face, emitters);
        if (!emitters.empty())
            number_emitters(world.faces.of(face), int(geometry.emitters.size()));
        append_face(geometry, world, face, index, -1);
        geometry.emitters.insert(geometry.emitters.end(), emitters.begin(), emitters.end());
    }
    find_filter_boxes(geometry);
    return geometry;
}

float find_lit_sky_luminance(const Bsp& bsp, const StaticEmitters& emitters)
{
    float power = 0, area = 0;
    for (size_t face = 0; face < bsp.faces.size(); face++) {
        const uint32_t flags = bsp.texinfos[bsp.faces[face].texinfo].flags;
        if (!(flags & SURF_SKY) || !(flags & SURF_LIGHT) || emitters.first_of_face[face] < 0)
            continue;
        for (uint32_t i = 0; i < emitters.count_of_face[face]; i++) {
            const shared::Emitter& emitter = emitters.emitters[size_t(emitters.first_of_face[face]) + i];
            power += luminance(emitter.radiance) * emitter.area;
            area += emitter.area;
        }
    }
    return area > 0 ? power / area : 0;
}

// Each name's texture is asked for once.
std::vector<FaceTexture> find_textures(const Bsp& bsp, const FindFaceTexture& find_texture)
{
    std::map<std::string, FaceTexture> by_name;
    std::vector<FaceTexture> textures(bsp.texinfos.size());
    for (size_t i = 0; i < textures.size(); i++) {
        const BspTexinfo& texinfo = bsp.texinfos[i];
        if (!is_drawn(texinfo) || (texinfo.flags & SURF_SKY))
            continue;
        const auto [entry, is_new] = by_name.try_emplace(texinfo.texture);
        if (is_new)
            entry->second = find_texture(texinfo.texture);
        textures[i] = entry->second;
    }
    return textures;
}

// Faces whose texture has holes by its material are as those that the map says it of.
void take_holes(Bsp& bsp, std::span<const FaceTexture> textures)
{
    for (size_t i = 0; i < textures.size(); i++)
        if (textures[i].has_holes)
            bsp.texinfos[i].flags |= SURF_ALPHATEST;
}

// The same of what is sky, or not there, by its material.
void take_kinds(Bsp& bsp, std::span<const FaceTexture> textures)
{
    for (size_t i = 0; i < textures.size(); i++) {
        uint32_t& flags = bsp.texinfos[i].flags;
        if (textures[i].is_sky)
            flags = (flags & SURF_LIGHT) | SURF_SKY;
        else if (textures[i].is_invisible)
            flags |= SURF_NODRAW;
    }
}

// The emitters of the world model; those of animated textures have their rows.
StaticEmitters find_world_emitters(World& world, const EmissionSource& source)
{
    StaticEmitters emitters = extract_emitters(source, world.faces);
    for (size_t face = 0; face < world.bsp.faces.size(); face++)
        if (emitters.first_of_face[face] >= 0)
            world.animated_lights.add(source, face,
                std::span(emitters.emitters)
                    .subspan(size_t(emitters.first_of_face[face]), emitters.count_of_face[face]));
    world.emission = emitters.face_emission;
    world.messages.insert(world.messages.end(), emitters.messages.begin(), emitters.messages.end());
    // Under a sun, the light value of a sky face only says that sunlight comes from there.
    world.lit_sky_luminance = world.suns.empty() ? find_lit_sky_luminance(world.bsp, emitters) : 0;
    return emitters;
}

WorldTrees build_world_trees(const MapGeometry& geometry)
{
    std::vector<BvhTriangle> triangles(geometry.triangles.size()), filters;
    for (size_t i = 0; i < triangles.size(); i++) {
        std::ranges::copy(geometry.triangles[i].positions, triangles[i].positions);
        triangles[i].id = uint32_t(i);
        triangles[i].mask = geometry.masks[i];
        if (triangles[i].mask & shared::MASK_FILTER)
            filters.push_back(triangles[i]);
    }
    WorldTrees trees { build_bvh(triangles, BvhQuality::best) };
    if (!filters.empty())
        trees.filter_root = append_bvh(trees.bvh, build_bvh(filters, BvhQuality::best));
    return trees;
}

// Flowing surfaces move by 1.6 of their textures a second, liquids by half of one, as the engine's OpenGL renderers
// move them.
glm::vec2 scroll_of(const BspTexinfo& texinfo, float time)
{
    if (!(texinfo.flags & SURF_FLOWING))
        return {};
    const float turns = time * (texinfo.flags & SURF_WARP ? 0.5f : 1.6f);
    return { -(turns - std::floor(turns)), 0 };
}

} // namespace

std::vector<shared::Material> World::make_materials(float time, const MaterialDefaults& defaults) const
{
    const size_t count = bsp.texinfos.size();
    std::vector<shared::Material> materials(count * 2);
    for (uint32_t i = 0; i < count; i++) {
        const BspTexinfo& texinfo = bsp.texinfos[i];
        SurfaceGuess surface = guess_surface(texinfo.texture, defaults);
        apply_material(surface, defaults.find(material_names[i]));
        shared::Material& material = materials[count + i];
        material = {};
        material.opacity = texinfo.flags & SURF_TRANS33 ? 0.33f : texinfo.flags & SURF_TRANS66 ? 0.66f : 1.0f;
        material.emission = emission[i];
        material.texture = textures[i].slot;
        material.texture_size = textures[i].packed_size;
        material.flags = (texinfo.flags & SURF_SKY ? shared::MATERIAL_SKY : 0)
            | (texinfo.flags & SURF_WARP ? shared::MATERIAL_WARP : 0)
            | (is_translucent(texinfo) ? shared::MATERIAL_TRANSLUCENT : 0)
            | (is_translucent(texinfo) && !(texinfo.flags & SURF_WARP) ? shared::MATERIAL_GLASS : 0)
            | (texinfo.flags & SURF_ALPHATEST ? shared::MATERIAL_ALPHA_TEST : 0);
        material.uv_scroll = scroll_of(texinfo, time);
        set_surface(material, surface, textures[i].maps, defaults);
    }
    const int tick = animation_tick(time);
    for (uint32_t i = 0; i < count; i++)
        materials[i] = materials[animation_frame(i, tick)];
    return materials;
}

uint32_t World::animation_frame(uint32_t texinfo, int frame) const
{
    const uint32_t count = uint32_t(bsp.texinfos.size());
    if (bsp.texinfos[texinfo].next < 0)
        return count + texinfo;
    uint32_t length = 0;
    for_each_frame(bsp, texinfo, [&](uint32_t) { length++; });
    for (uint32_t step = uint32_t(std::max(frame, 0)) % length; step > 0; step--)
        texinfo = uint32_t(bsp.texinfos[texinfo].next);
    return count + texinfo;
}

std::unique_ptr<World> load_world(formats::Bytes file, const std::string& name, const FindFaceTexture& find_texture,
    const EmissionScales& scales, std::string_view more_entities)
{
    // In place from the start: the light lists keep a pointer to the map.
    auto made = std::make_unique<World>();
    World& world = *made;
    world.name = name;
    world.bsp = read_bsp(file, name);
    if (world.bsp.models.empty())
        throw FormatError(name, 0, "the map has no world model");

    world.bsp.entity_text += more_entities;
    world.textures = find_textures(world.bsp, find_texture);
    world.media = find_texinfo_media(world.bsp, world.textures);
    light_lava(world.bsp, world.media);
    const std::vector<EntityText> entities = read_entities(world.bsp, world.messages);
    world.suns = find_suns(entities);
    world.fog_boxes = find_fog_boxes(entities, world.bsp.name, world.messages);

    take_holes(world.bsp, world.textures);
    take_kinds(world.bsp, world.textures);
    for (const BspTexinfo& texinfo : world.bsp.texinfos)
        world.material_names.push_back(material_name(texinfo.texture));
    world.faces = FaceTriangles(world.bsp, world.textures);
    const EmissionSource source { world.bsp, world.textures, scales };
    world.models.push_back(make_world_geometry(world, find_world_emitters(world, source).emitters));
    world.brush_meshes.emplace_back();
    for (size_t i = 1; i < world.bsp.models.size(); i++) {
        const MapGeometry& geometry = world.models.emplace_back(make_brush_geometry(world, i, source));
        world.brush_meshes.push_back(make_brush_mesh(geometry.triangles, geometry.masks));
    }
    world.trees_future
        = std::async(std::launch::async, [&geometry = world.models[0]] { return build_world_trees(geometry); });
    world.light_lists.build(world.bsp, world.models[0].emitters);
    world.light_cache = lay_out_light_cache(world.bsp, world.light_lists, world.models[0].emitters);
    return made;
}

void set_sky_radiance(World& world, glm::vec3 average)
{
    for (MapGeometry& geometry : world.models)
        for (shared::Emitter& emitter : geometry.emitters)
            if (emitter.type == shared::EMITTER_SKY)
                emitter.radiance = average;
}

} // namespace vkpt

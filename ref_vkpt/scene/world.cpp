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

namespace vkpt {

namespace {

using namespace formats;

constexpr int several_clusters = -2;
constexpr uint64_t max_triangles = 300'000; // per megabyte of the map; faces of many corners make 220,000

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

bool is_drawn(const BspTexinfo& texinfo)
{
    return (texinfo.flags & (SURF_NODRAW | SURF_SKIP | SURF_HINT)) == 0 || (texinfo.flags & SURF_SKY) != 0;
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

struct FaceContext {
    const Bsp& bsp;
    const std::vector<WorldPicture>& pictures;
    const std::vector<int>& face_clusters;
    WorkLimit& pieces;
    WorkLimit& triangles;
    size_t model; // 0: the world
};

PictureColour colour_of(const WorldPicture& picture)
{
    PictureColour colour(picture.average, picture.missing ? missing_picture_strength : 1.0f);
    colour.parts = picture.parts;
    colour.glows = picture.glows;
    colour.size = { picture.width, picture.height };
    return colour;
}

// `first_emitter`: where this face's emitters start in the model's list, -1: it has none.
void append_face(MapGeometry& geometry, const FaceContext& context, size_t face, int first_emitter)
{
    const Bsp& bsp = context.bsp;
    const uint32_t texinfo_index = bsp.faces[face].texinfo;
    const BspTexinfo& texinfo = bsp.texinfos[texinfo_index];
    const WorldPicture& picture = context.pictures[texinfo_index];
    const uint32_t normal = encode_octahedral(bsp.face_normal(face));
    const uint8_t holes = has_holes(bsp, texinfo_index) ? 1 : 0;
    const PictureColour colour = colour_of(picture);
    const bool glows = is_glowing(texinfo, colour);
    const uint32_t medium = medium_of_face(bsp, face, context.model);
    const std::vector<FaceTriangle> parts = triangles_of_face(bsp, face, colour, context.pieces);
    context.triangles.spend(parts.size(), "face", face);
    for (const FaceTriangle& part : parts) {
        shared::Triangle triangle {};
        for (int i = 0; i < 3; i++) {
            triangle.positions[i] = part.corners[size_t(i)];
            triangle.uvs[i]
                = bsp.texture_coordinates(texinfo, triangle.positions[i]) / glm::vec2(picture.width, picture.height);
            triangle.normals[i] = normal;
        }
        triangle.material = texinfo_index;
        triangle.emitter = shared::EMITTER_UNLISTED;
        triangle.lightstyle = face_lightstyle(bsp.faces[face]);
        if (glows && part.part < 0)
            triangle.lightstyle = lightstyle_none;
        else if (first_emitter >= 0)
            triangle.emitter = part.part == FacePiece::dark ? shared::EMITTER_SAMPLED_APART : first_emitter++;
        else if (glows)
            triangle.emitter = shared::EMITTER_SAMPLED_APART; // a light entity sends its light
        const bool is_world = context.model == 0;
        triangle.cluster = is_world ? std::max(context.face_clusters[face], -1) : -1;
        triangle.cache_face = is_world ? uint32_t(face) + 1 : 0;
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

MapGeometry make_world_geometry(const FaceContext& context, StaticEmitters emitters)
{
    MapGeometry geometry;
    const BspModel& model = context.bsp.models[0];
    for (size_t face = size_t(model.first_face); face < size_t(model.first_face + model.face_count); face++)
        if (is_drawn(context.bsp.texinfos[context.bsp.faces[face].texinfo]))
            append_face(geometry, context, face, emitters.first_of_face[face]);
    geometry.filter_boxes = find_liquid_boxes(context.bsp);
    find_filter_boxes(geometry);
    geometry.emitters = std::move(emitters.emitters);
    for (shared::Emitter& emitter : geometry.emitters)
        if (emitter.type == shared::EMITTER_SKY)
            emitter.lightstyle = lightstyle_sky;
    return geometry;
}

MapGeometry make_brush_geometry(const FaceContext& context, size_t index, const AverageColour& colour,
    const EmissionScales& scales, AnimatedLights& animated)
{
    MapGeometry geometry;
    const BspModel& model = context.bsp.models[index];
    for (size_t face = size_t(model.first_face); face < size_t(model.first_face + model.face_count); face++) {
        if (!is_drawn(context.bsp.texinfos[context.bsp.faces[face].texinfo]))
            continue;
        std::vector<shared::Emitter> emitters = emitters_of_face(context.bsp, face, colour, scales, context.pieces);
        animated.add(context.bsp, face, emitters, colour, scales);
        append_face(geometry, context, face, emitters.empty() ? -1 : int(geometry.emitters.size()));
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

Bvh build_world_bvh(const MapGeometry& geometry)
{
    std::vector<BvhTriangle> triangles(geometry.triangles.size());
    for (size_t i = 0; i < triangles.size(); i++) {
        std::ranges::copy(geometry.triangles[i].positions, triangles[i].positions);
        triangles[i].id = uint32_t(i);
        triangles[i].mask = geometry.masks[i];
    }
    return build_bvh(triangles, BvhQuality::best);
}

// Flowing surfaces move by 1.6 of their pictures a second, liquids by half of one, as the engine's OpenGL renderers
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
        apply_material(surface, material_names[i], defaults);
        shared::Material& material = materials[count + i];
        material = {};
        material.tint = glm::vec3(surface.base_factor);
        material.opacity = texinfo.flags & SURF_TRANS33 ? 0.33f : texinfo.flags & SURF_TRANS66 ? 0.66f : 1.0f;
        material.emission = emission[i];
        material.roughness = surface.roughness;
        material.metallic = surface.metallic;
        material.texture = pictures[i].slot;
        material.texture_size = pictures[i].packed_size;
        material.flags = (texinfo.flags & SURF_SKY ? shared::MATERIAL_SKY : 0)
            | (texinfo.flags & SURF_WARP ? shared::MATERIAL_WARP : 0)
            | (is_translucent(texinfo) ? shared::MATERIAL_TRANSLUCENT : 0)
            | (is_translucent(texinfo) && !(texinfo.flags & SURF_WARP) ? shared::MATERIAL_GLASS : 0)
            | (texinfo.flags & SURF_ALPHATEST ? shared::MATERIAL_ALPHA_TEST : 0);
        material.uv_scroll = scroll_of(texinfo, time);
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

std::unique_ptr<World> load_world(formats::Bytes file, const std::string& name, const FindWorldPicture& find_picture,
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
    world.media = find_texinfo_media(world.bsp);
    light_lava(world.bsp, world.media);
    std::vector<std::string> messages;
    const std::vector<EntityText> entities = read_entities(world.bsp, messages);
    world.suns = find_suns(entities);
    world.fog_boxes = find_fog_boxes(entities, world.bsp.name, messages);

    std::map<std::string, WorldPicture> by_name;
    for (const BspTexinfo& texinfo : world.bsp.texinfos) {
        auto [entry, is_new] = by_name.try_emplace(texinfo.texture);
        if (is_new && is_drawn(texinfo) && !(texinfo.flags & SURF_SKY))
            entry->second = find_picture(texinfo.texture);
        world.pictures.push_back(entry->second);
        world.material_names.push_back(material_name(texinfo.texture));
    }
    const AverageColour colour = [&](const std::string& texture) -> PictureColour {
        const auto entry = by_name.find(texture);
        return colour_of(entry != by_name.end() ? entry->second : WorldPicture());
    };
    StaticEmitters emitters = extract_emitters(world.bsp, colour, scales);
    for (size_t face = 0; face < world.bsp.faces.size(); face++)
        if (emitters.first_of_face[face] >= 0)
            world.animated_lights.add(world.bsp, face,
                std::span(emitters.emitters)
                    .subspan(size_t(emitters.first_of_face[face]), emitters.count_of_face[face]),
                colour, scales);
    world.emission = emitters.face_emission;
    messages.insert(messages.end(), emitters.messages.begin(), emitters.messages.end());
    world.messages = std::move(messages);
    // Under a sun, the light value of a sky face only says that sunlight comes from there.
    world.lit_sky_luminance = world.suns.empty() ? find_lit_sky_luminance(world.bsp, emitters) : 0;

    const std::vector<int> face_clusters = find_face_clusters(world.bsp);
    WorkLimit pieces = limit_of_pieces(world.bsp), triangles(world.bsp, max_triangles, "triangles");
    world.models.push_back(
        make_world_geometry({ world.bsp, world.pictures, face_clusters, pieces, triangles, 0 }, std::move(emitters)));
    world.brush_meshes.emplace_back();
    for (size_t i = 1; i < world.bsp.models.size(); i++) {
        const MapGeometry& geometry = world.models.emplace_back(
            make_brush_geometry({ world.bsp, world.pictures, face_clusters, pieces, triangles, i }, i, colour, scales,
                world.animated_lights));
        world.brush_meshes.push_back(make_brush_mesh(geometry.triangles, geometry.masks));
    }
    world.bvh_future
        = std::async(std::launch::async, [&geometry = world.models[0]] { return build_world_bvh(geometry); });
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

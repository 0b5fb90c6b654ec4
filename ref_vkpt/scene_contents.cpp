// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene_contents.hpp"

#include "ref_vkpt/lights/spot_cone.hpp"
#include "ref_vkpt/scene/entity_geometry.hpp"
#include "ref_vkpt/scene/material_guess.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/gtc/constants.hpp>
#include <map>

namespace vkpt {

namespace {

void copy_vector(float (&to)[3], glm::vec3 from)
{
    for (int i = 0; i < 3; i++)
        to[i] = from[i];
}

// All of the map's, then all of the view's: emitter indices count through both.
template <class Visit> void visit_emitters(const SceneSnapshot& snapshot, const Visit& visit)
{
    for (const shared::Emitter& emitter : snapshot.world->models[0].emitters)
        visit(emitter, snapshot.lightstyles[emitter.lightstyle]);
    for (const shared::Emitter& emitter : snapshot.emitters)
        visit(emitter, snapshot.lightstyles[emitter.lightstyle]);
}

SceneTriangle make_triangle(const shared::Triangle& from, uint32_t mask)
{
    SceneTriangle to {};
    for (int corner = 0; corner < 3; corner++) {
        copy_vector(to.positions[corner], from.positions[corner]);
        copy_vector(to.normals[corner], decode_octahedral(from.normals[corner]));
        to.uvs[corner][0] = from.uvs[corner].x;
        to.uvs[corner][1] = from.uvs[corner].y;
    }
    to.material = from.material;
    to.emitter = from.emitter;
    to.ray_mask = mask;
    return to;
}

void add_triangles(std::vector<SceneTriangle>& out, Module& m)
{
    const SceneSnapshot& snapshot = *m.view().snapshot;
    const MapGeometry& world = snapshot.world->models[0];
    for (size_t i = 0; i < world.triangles.size(); i++)
        out.push_back(make_triangle(world.triangles[i], world.masks[i]));
    std::vector<shared::Triangle> moving(snapshot.moving.triangle_count());
    std::vector<uint32_t> masks(moving.size());
    if (moving.empty())
        return;
    MovingTarget target;
    target.triangles = moving.data();
    target.masks = masks.data();
    MovingWriter(m.workers).write(snapshot.moving, target);
    for (size_t i = 0; i < moving.size(); i++)
        out.push_back(make_triangle(moving[i], masks[i]));
}

// `lightstyle`: the steady one's scale.
SceneMaterial make_material(const shared::Material& from, const Texture* texture, float lightstyle)
{
    SceneMaterial to {};
    to.texture = texture ? texture->file.c_str() : "";
    const glm::vec3 average = texture ? texture->average : glm::vec3(1);
    // Emissive maps are not among the contents: the texture shines in their place, as much as they do.
    const bool has_map = texture && texture->emissive && (from.maps >> 16) != 0;
    const glm::vec3 glow = has_map ? texture->emissive->average : average;
    const glm::vec3 share = has_map ? glow / glm::max(average, 1e-3f) : glm::vec3(1);
    copy_vector(to.tint, from.tint);
    copy_vector(to.base_colour, glm::clamp(average * from.tint, 0.0f, 1.0f));
    to.opacity = from.opacity;
    copy_vector(to.emission_tint, from.emission * share * lightstyle);
    copy_vector(to.emission, from.emission * glow * lightstyle);
    to.uv_scroll[0] = from.uv_scroll.x;
    to.uv_scroll[1] = from.uv_scroll.y;
    to.roughness = from.roughness;
    to.metallic = from.metallic;
    to.specular = 1 - coat_loss(from);
    to.flags = from.flags;
    return to;
}

using Textures = std::map<uint32_t, const Texture*>; // by slot

const Texture* find_texture(const Textures& textures, uint32_t slot)
{
    const auto found = textures.find(slot);
    return found == textures.end() ? nullptr : found->second;
}

SceneSky make_sky(const shared::Sky& from, const Textures& textures)
{
    SceneSky to {};
    for (size_t side = 0; side < std::size(to.textures); side++) {
        const Texture* texture = from.present ? find_texture(textures, from.textures[side]) : nullptr;
        to.textures[side] = texture ? texture->file.c_str() : "";
    }
    for (int axis = 0; axis < 3; axis++)
        copy_vector(to.rotation[axis], from.rotation[axis]);
    copy_vector(to.radiance, from.radiance);
    return to;
}

SceneEmitter make_emitter(const shared::Emitter& from, float lightstyle)
{
    SceneEmitter to {};
    to.type = from.type;
    if (is_sphere(from)) {
        copy_vector(to.centre, from.p0);
        to.radius = from.p1.x;
    }
    if (has_cone(from)) {
        copy_vector(to.cone_axis, from.p2);
        to.cone_cosines[0] = from.p1.z;
        to.cone_cosines[1] = outer_cosine(from);
    }
    if (!is_sphere(from)) {
        const glm::vec3 corners[] = { from.p0, from.p1, from.p2 };
        for (int corner = 0; corner < 3; corner++)
            copy_vector(to.positions[corner], corners[corner]);
    }
    copy_vector(to.radiance, from.radiance * lightstyle);
    to.area = from.area;
    to.reach = from.reach;
    return to;
}

} // namespace

SceneContents read_scene_contents(Module& m)
{
    static std::vector<SceneTriangle> triangles;
    static std::vector<SceneMaterial> materials;
    static std::vector<SceneEmitter> emitters;
    triangles.clear();
    materials.clear();
    emitters.clear();
    const SceneSnapshot& snapshot = *m.view().snapshot;
    add_triangles(triangles, m);
    const Textures textures = m.textures.by_slot();
    for (const shared::Material& material : snapshot.materials)
        materials.push_back(make_material(material, find_texture(textures, material.texture), snapshot.lightstyles[0]));
    visit_emitters(snapshot, [&](const shared::Emitter& emitter, float lightstyle) {
        emitters.push_back(make_emitter(emitter, lightstyle));
    });
    SceneContents contents { triangles.data(), triangles.size(), materials.data(), materials.size(), emitters.data(),
        emitters.size(), {}, make_sky(snapshot.sky, textures), snapshot.time };
    const shared::Camera& camera = m.view().viewpoint.camera;
    copy_vector(contents.camera.eye, camera.eye);
    copy_vector(contents.camera.forward, camera.forward);
    copy_vector(contents.camera.right, camera.right);
    copy_vector(contents.camera.up, camera.up);
    return contents;
}

glm::dvec3 emitted_power(const SceneSnapshot& snapshot)
{
    glm::dvec3 power(0);
    visit_emitters(snapshot, [&](const shared::Emitter& emitter, float lightstyle) {
        power += glm::pi<double>() * double(emitter.area) * double(lightstyle) * glm::dvec3(emitter.radiance);
    });
    return power;
}

} // namespace vkpt

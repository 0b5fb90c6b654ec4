// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/entities.hpp"

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/lights/media.hpp"
#include "ref_vkpt/scene/entity_geometry.hpp"
#include "ref_vkpt/scene/material_guess.hpp"
#include "ref_vkpt/scene/material_library.hpp"
#include "ref_vkpt/scene/placed_lights.hpp"
#include "ref_vkpt/scene/scene.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace vkpt {

namespace {

using namespace engine;

// Radiance of what is shown unlit (fullbright models, particles) at full texture value: a white wall in ordinary light.
constexpr float unlit_radiance = 1.0f;
// Lasers and power-up shells glow: their colour times this is their radiance.
constexpr float beam_radiance = 8.0f;
constexpr float shell_radiance = 0.6f;
constexpr float shell_opacity = 0.3f;
constexpr float usual_particle_size = 40; // gl3_particle_size
constexpr int hand_left = 1, hand_none = 2;
// What a weapon before all walls (RF_DEPTHHACK) is scaled by about the eye: up to 64 units of it then stay within the
// player's box, which reaches 16 units from the eye and into which no wall comes.
constexpr float depth_hack_scale = 0.25f;

// Around the box's corners.
shared::FilterBox transform_box(const Transform& transform, const shared::FilterBox& box)
{
    shared::FilterBox result { glm::vec3(FLT_MAX), glm::vec3(-FLT_MAX) };
    for (int i = 0; i < 8; i++) {
        const glm::vec3 corner(
            i & 1 ? box.maxs.x : box.mins.x, i & 2 ? box.maxs.y : box.mins.y, i & 4 ? box.maxs.z : box.mins.z);
        result.mins = glm::min(result.mins, transform.point(corner));
        result.maxs = glm::max(result.maxs, transform.point(corner));
    }
    return result;
}

class SnapshotBuilder {
public:
    SnapshotBuilder(SceneSnapshot& snapshot, const RefDef& refdef, const TextureStore& textures,
        const MaterialDefaults& defaults, SkinLampCache& skin_lamps)
        : snapshot_(snapshot)
        , refdef_(refdef)
        , textures_(textures)
        , defaults_(defaults)
        , skin_lamps_(skin_lamps)
        , eye_(to_vec3(refdef.view_origin))
        , axes_(angle_vectors(to_vec3(refdef.view_angles)))
        , emitter_base_(snapshot.world ? int(snapshot.world->models[0].emitters.size()) : 0)
    {
    }

    void add_entity(const Entity& entity);
    void add_particle(const Particle& particle);
    void add_dlight(const DynamicLight& light);
    void add_preview_light();

private:
    Axes axes_at(glm::vec3 place) const;
    uint32_t add_material(const shared::Material& material);
    shared::Material plain_material() const;
    uint32_t entity_mask(const Entity& entity, const shared::Material& material) const;

    void add_brush(const Entity& entity, const Model::Brush& brush);
    void add_mesh(const Entity& entity, const Model& model, const Model::Mesh& mesh);
    bool add_placed_lights(const Entity& entity, formats::LightModel model, const Transform& transform);
    void add_shell(const Entity& entity, const Model::Mesh& mesh, Md2Pose pose);
    void add_sprite(const Entity& entity, const Model::Sprite& sprite);
    void add_beam(const Entity& entity);
    void add_null_model(const Entity& entity);
    void add_glow(glm::vec3 p0, glm::vec3 p1, glm::vec3 p2, float area, const shared::Material& material);
    void add_shell_light(glm::vec3 centre, const shared::Material& material);
    shared::Material mesh_material(
        const Entity& entity, const Model& model, const Texture* skin, const MaterialSettings* settings) const;
    bool add_md2(const Model::Part& part, const Md2Pose& pose, const shared::Material& material, uint32_t mask,
        const ModelLamps& lamps = {});
    void add_skin_lamps(
        const Md2Mesh& mesh, const Md2Pose& pose, const SkinLamps& lamps, const shared::Material& material);
    Squeeze squeeze_weapon(const Entity& weapon) const;

    SceneSnapshot& snapshot_;
    const RefDef& refdef_;
    const TextureStore& textures_;
    const MaterialDefaults& defaults_;
    SkinLampCache& skin_lamps_;
    glm::vec3 eye_;
    Axes axes_;
    int emitter_base_;
};

// Of what faces the camera.
Axes SnapshotBuilder::axes_at(glm::vec3 place) const
{
    const glm::vec3 way = place - eye_;
    if (!snapshot_.looks_around || !(glm::length(way) > 1e-3f))
        return axes_;
    Axes axes;
    axes.forward = glm::normalize(way);
    const glm::vec3 across = glm::cross(axes.forward, axes_.up);
    axes.right = glm::length(across) > 1e-3f ? glm::normalize(across) : axes_.right;
    axes.up = glm::cross(axes.right, axes.forward);
    return axes;
}

uint32_t SnapshotBuilder::add_material(const shared::Material& material)
{
    snapshot_.materials.push_back(material);
    return uint32_t(snapshot_.materials.size() - 1);
}

static void show_texture(shared::Material& material, const Texture& texture)
{
    material.texture = texture.slot;
    material.texture_size = texture.packed_size;
}

shared::Material SnapshotBuilder::plain_material() const
{
    shared::Material material {};
    material.tint = glm::vec3(1);
    material.opacity = 1;
    material.roughness = defaults_.roughness;
    material.metallic = defaults_.metallic;
    show_texture(material, textures_.white());
    return material;
}

uint32_t SnapshotBuilder::entity_mask(const Entity& entity, const shared::Material& material) const
{
    if (entity.flags & RF_WEAPONMODEL)
        return shared::MASK_VIEW_WEAPON;
    if (entity.flags & RF_VIEWERMODEL)
        return shared::MASK_OWN_BODY;
    return material.flags & shared::MATERIAL_TRANSLUCENT ? shared::MASK_TRANSLUCENT : shared::MASK_OPAQUE;
}

void SnapshotBuilder::add_entity(const Entity& entity)
{
    if (entity.flags & RF_BEAM)
        return add_beam(entity);
    const auto* model = static_cast<const Model*>(entity.model);
    if (!model)
        return add_null_model(entity);
    if (const auto* brush = std::get_if<Model::Brush>(&model->shape))
        add_brush(entity, *brush);
    else if (const auto* mesh = std::get_if<Model::Mesh>(&model->shape))
        add_mesh(entity, *model, *mesh);
    else
        add_sprite(entity, std::get<Model::Sprite>(model->shape));
}

void SnapshotBuilder::add_brush(const Entity& entity, const Model::Brush& brush)
{
    // The world itself is no entity.
    if (!snapshot_.world || brush.index == 0)
        return;
    const World& world = *snapshot_.world;
    const MapGeometry& geometry = world.models[brush.index];
    const BrushMesh& mesh = world.brush_meshes[brush.index];
    const bool translucent = (entity.flags & RF_TRANSLUCENT) != 0;
    std::vector<uint32_t> materials;
    for (const uint32_t texinfo : mesh.texinfos) {
        const uint32_t shown = world.animation_frame(texinfo, entity.frame);
        materials.push_back(shown);
        if (!translucent)
            continue;
        shared::Material material = snapshot_.materials[shown];
        material.opacity = std::clamp(entity.alpha, 0.0f, 1.0f);
        material.flags |= shared::MATERIAL_TRANSLUCENT;
        materials.back() = add_material(material);
    }
    BrushPose pose;
    pose.transform = brush_model_transform(to_vec3(entity.origin), to_vec3(entity.angles));
    pose.materials = materials;
    pose.first_emitter = emitter_base_ + int(snapshot_.emitters.size());
    pose.mask = translucent ? shared::MASK_TRANSLUCENT : 0;
    if (!snapshot_.moving.add(mesh, pose))
        return;
    for (const shared::FilterBox& box : geometry.filter_boxes)
        if (!translucent)
            add_filter_box(snapshot_.filter_boxes, transform_box(pose.transform, box));
    for (shared::Emitter emitter : geometry.emitters) {
        emitter.p0 = pose.transform.point(emitter.p0);
        emitter.p1 = pose.transform.point(emitter.p1);
        emitter.p2 = pose.transform.point(emitter.p2);
        if (translucent)
            emitter.type = shared::EMITTER_TRANSPARENT;
        if (world.animated_lights.has(emitter.lightstyle)) { // by the entity's frame, not by time
            const AnimatedLight& light = world.animated_lights.at(emitter.lightstyle);
            emitter.radiance *= light.share(entity.frame);
            emitter.lightstyle = light.lightstyle;
        }
        snapshot_.emitters.push_back(emitter);
    }
    snapshot_.has_alpha_test |= geometry.has_alpha_test && !translucent;
}

// nullptr: it has none.
static const Texture* skin_of(const Entity& entity, const Model::Part& part)
{
    if (entity.skin || part.skins.empty())
        return static_cast<const Texture*>(entity.skin);
    const size_t number = size_t(std::max(entity.skin_number, 0));
    const Texture* skin = part.skins[number < part.skins.size() ? number : 0];
    return skin ? skin : part.skins[0];
}

shared::Material SnapshotBuilder::mesh_material(
    const Entity& entity, const Model& model, const Texture* skin, const MaterialSettings* settings) const
{
    shared::Material material = plain_material();
    if (skin)
        show_texture(material, *skin);
    SurfaceGuess surface = guess_surface(model.name, defaults_);
    apply_material(surface, settings);
    const TextureMaps maps = skin ? maps_of(*skin) : TextureMaps();
    set_surface(material, surface, maps, defaults_);
    if (entity.flags & RF_FULLBRIGHT)
        material.flags |= shared::MATERIAL_FULLBRIGHT;
    if (entity.flags & RF_TRANSLUCENT) {
        material.opacity = std::clamp(entity.alpha, 0.0f, 1.0f);
        material.flags |= shared::MATERIAL_TRANSLUCENT;
    }
    if ((refdef_.flags & RDF_IRGOGGLES) && (entity.flags & RF_IR_VISIBLE)) {
        material.tint = glm::vec3(1, 0, 0);
        material.flags |= shared::MATERIAL_FULLBRIGHT;
    }
    if (maps.emissive.slot != 0) {
        material.emission = glm::vec3(EmissionScales().glow * surface.emissive_factor);
        return material; // it glows where its map says so, and no more
    }
    // Items pulse: a little light of their own, rising and falling.
    if (entity.flags & RF_GLOW)
        material.emission = glm::vec3(0.1f + 0.1f * std::sin(refdef_.time * 7));
    if (entity.flags & RF_MINLIGHT)
        material.emission = glm::max(material.emission, glm::vec3(0.05f));
    return material;
}

void SnapshotBuilder::add_mesh(const Entity& entity, const Model& model, const Model::Mesh& mesh)
{
    const CvarValues& cvars = cvars::values();
    const bool is_weapon = (entity.flags & RF_WEAPONMODEL) != 0;
    if (is_weapon && cvars.hand == hand_none)
        return;
    Md2Pose pose;
    pose.backlerp = entity.backlerp;
    pose.transform
        = md2_transform(blend_origins(to_vec3(entity.origin), to_vec3(entity.previous_origin), entity.backlerp),
            to_vec3(entity.angles));
    pose.frame = entity.frame;
    pose.old_frame = entity.previous_frame;
    if (is_weapon && cvars.hand == hand_left)
        pose.mirror = Mirror { eye_, axes_.right };
    if (is_weapon)
        pose.squeeze = squeeze_weapon(entity);
    if (entity.flags & RF_SHELLS)
        return add_shell(entity, mesh, pose);
    if (model.light && !add_placed_lights(entity, *model.light, pose.transform))
        return;
    for (const Model::Part& part : mesh.parts) {
        const Texture* skin = skin_of(entity, part);
        const MaterialSettings* settings = skin ? defaults_.find(skin->material) : nullptr;
        if (settings && settings->is_invisible)
            continue;
        const shared::Material material = mesh_material(entity, model, skin, settings);
        ModelLamps lamps;
        // A weapon before the eye is not where it is seen: it lights nothing.
        if (snapshot_.world && !is_weapon && skin && skin->emissive && material.emission != glm::vec3(0))
            lamps
                = { skin_lamps_.find(part.md2, skin->emissive->glow), emitter_base_ + int(snapshot_.emitters.size()) };
        if (add_md2(part, pose, material, entity_mask(entity, material), lamps) && lamps.lamps)
            add_skin_lamps(*part.md2, pose, *lamps.lamps, material);
    }
}

void SnapshotBuilder::add_skin_lamps(
    const Md2Mesh& mesh, const Md2Pose& pose, const SkinLamps& lamps, const shared::Material& material)
{
    std::vector<Float4> points;
    mesh.pose(pose, points);
    const bool is_translucent = (material.flags & shared::MATERIAL_TRANSLUCENT) != 0;
    for (const SkinLamp& lamp : lamps) {
        const uint32_t* corners = &mesh.corners()[size_t(lamp.slot) * 3];
        shared::Emitter emitter {};
        emitter.type = is_translucent ? shared::EMITTER_TRANSPARENT : shared::EMITTER_TRIANGLE;
        emitter.p0 = to_vec3(points[corners[0]]);
        emitter.p1 = to_vec3(points[corners[1]]);
        emitter.p2 = to_vec3(points[corners[2]]);
        emitter.area = triangle_area(emitter.p0, emitter.p1, emitter.p2);
        if (emitter.area > 0) // a flat one stays dark
            emitter.radiance = material.emission * lamp.colour * (is_translucent ? material.opacity : 1.0f);
        snapshot_.emitters.push_back(emitter);
    }
}

// False: its mesh is not to be seen. The spheres are, with RF_FULLBRIGHT, to the camera alone: no ray of light meets
// them.
bool SnapshotBuilder::add_placed_lights(const Entity& entity, formats::LightModel model, const Transform& transform)
{
    constexpr float shown_radiance = 12, min_shown_radius = 1.5f;
    const size_t first = snapshot_.emitters.size();
    const formats::CodedLight light = formats::decode_light(entity.skin_number);
    if (snapshot_.world)
        append_placed_lights(model, light, transform, refdef_.time, EmissionScales().point, snapshot_.emitters);
    if (entity.flags & RF_FULLBRIGHT) {
        shared::Material material = plain_material();
        material.tint = light.colour * shown_radiance;
        material.flags = shared::MATERIAL_FULLBRIGHT;
        for (size_t i = first; i < snapshot_.emitters.size(); i++) {
            const float radius = std::max(snapshot_.emitters[i].p1.x, min_shown_radius);
            append_octahedron({ snapshot_.emitters[i].p0 }, radius, add_material(material), snapshot_.moving.loose());
        }
        snapshot_.moving.mask_loose(shared::MASK_TRANSLUCENT);
    }
    return model == formats::LightModel::spot || model == formats::LightModel::flare;
}

// False: it cannot be posed (MovingGeometry::add).
bool SnapshotBuilder::add_md2(const Model::Part& part, const Md2Pose& pose, const shared::Material& material,
    uint32_t mask, const ModelLamps& lamps)
{
    if (!snapshot_.moving.add(part.md2, pose, uint32_t(snapshot_.materials.size()), mask, lamps))
        return false;
    add_material(material);
    return true;
}

// Shells are entities of their own: the model inflated, glowing in the power-ups' colours.
void SnapshotBuilder::add_shell(const Entity& entity, const Model::Mesh& mesh, Md2Pose pose)
{
    pose.shell_distance = entity.flags & RF_WEAPONMODEL ? weapon_shell_distance : powerup_shell_distance;
    glm::vec3 colour(0);
    if (entity.flags & RF_SHELL_HALF_DAM)
        colour = { 0.56f, 0.59f, 0.45f };
    if (entity.flags & RF_SHELL_DOUBLE)
        colour += glm::vec3(0.9f, 0.7f, 0);
    if (entity.flags & RF_SHELL_RED)
        colour.x = 1;
    if (entity.flags & RF_SHELL_GREEN)
        colour.y = 1;
    if (entity.flags & RF_SHELL_BLUE)
        colour.z = 1;
    shared::Material material = plain_material();
    material.tint = colour;
    material.emission = colour * shell_radiance;
    material.opacity = shell_opacity;
    material.flags = shared::MATERIAL_TRANSLUCENT;
    Box bounds;
    bool is_shown = false;
    for (const Model::Part& part : mesh.parts)
        if (add_md2(part, pose, material, entity_mask(entity, material))) {
            bounds.add(part.md2->bounds(pose));
            is_shown = true;
        }
    if (is_shown && !(entity.flags & RF_WEAPONMODEL)) // the weapon's is the player's once more
        add_shell_light(bounds.centre(), material);
}

// The light of a surface that rays other than the camera's pass: light sampling alone accounts for it.
void SnapshotBuilder::add_glow(glm::vec3 p0, glm::vec3 p1, glm::vec3 p2, float area, const shared::Material& material)
{
    shared::Emitter emitter {};
    emitter.type = shared::EMITTER_TRANSPARENT;
    emitter.p0 = p0;
    emitter.p1 = p1;
    emitter.p2 = p2;
    emitter.area = area;
    emitter.radiance = material.emission * material.opacity;
    if (emitter.radiance != glm::vec3(0))
        snapshot_.emitters.push_back(emitter);
}

// A shell's many triangles as an octahedron of a player's size, which stays the same from frame to frame.
void SnapshotBuilder::add_shell_light(glm::vec3 centre, const shared::Material& material)
{
    constexpr float width = 20, height = 32;
    const float area = 0.5f * width * std::sqrt(width * width + 2 * height * height);
    for (int i = 0; i < 8; i++) {
        const glm::vec3 x((i & 1) ? -width : width, 0, 0), y(0, (i & 2) ? -width : width, 0),
            z(0, 0, (i & 4) ? -height : height);
        const bool mirrored = ((i & 1) + (i >> 1 & 1) + (i >> 2 & 1)) % 2 == 1; // fronts outside
        add_glow(centre + x, centre + (mirrored ? z : y), centre + (mirrored ? y : z), area, material);
    }
}

// View weapons are made for a vertical field of view of their own (r_gunfov): from the eye they look as they would in
// it. They are before all walls, as their texture stays the same if they are scaled about the eye as a whole.
Squeeze SnapshotBuilder::squeeze_weapon(const Entity& weapon) const
{
    const auto tangent = [](float degrees) { return std::tan(glm::radians(std::clamp(degrees, 1.0f, 170.0f)) / 2); };
    const float gun_fov = cvars::values().r_gunfov;
    const float scale = weapon.flags & RF_DEPTHHACK ? depth_hack_scale : 1;
    return { eye_, axes_.forward, scale, gun_fov > 0 ? scale * tangent(refdef_.fov_y) / tangent(gun_fov) : scale };
}

void SnapshotBuilder::add_sprite(const Entity& entity, const Model::Sprite& sprite)
{
    if (sprite.sp2.frames.empty())
        return;
    const size_t frame = size_t(std::max(entity.frame, 0)) % sprite.sp2.frames.size();
    const Texture* texture = sprite.textures[frame];
    if (!texture)
        return;
    shared::Material material = plain_material();
    show_texture(material, *texture);
    material.tint = glm::vec3(unlit_radiance);
    material.opacity = entity.flags & RF_TRANSLUCENT ? std::clamp(entity.alpha, 0.0f, 1.0f) : 1.0f;
    material.flags = shared::MATERIAL_FULLBRIGHT | shared::MATERIAL_ALPHA_TEST
        | (material.opacity < 1 ? shared::MATERIAL_TRANSLUCENT : 0);
    const glm::vec3 origin = to_vec3(entity.origin);
    append_sprite(sprite.sp2.frames[frame], origin, axes_at(origin), add_material(material), snapshot_.moving.loose());
    snapshot_.moving.mask_loose(shared::MASK_TRANSLUCENT);
    snapshot_.has_alpha_test = true;
}

void SnapshotBuilder::add_beam(const Entity& entity)
{
    shared::Material material = plain_material();
    const glm::vec3 colour = decode_colour(textures_.palette()[size_t(entity.skin_number & 255)]);
    material.tint = colour;
    material.emission = colour * beam_radiance;
    material.opacity = entity.flags & RF_TRANSLUCENT ? std::clamp(entity.alpha, 0.0f, 1.0f) : 1.0f;
    material.flags = shared::MATERIAL_TRANSLUCENT;
    std::vector<shared::Triangle>& loose = snapshot_.moving.loose();
    const size_t first = loose.size();
    append_beam(
        to_vec3(entity.origin), to_vec3(entity.previous_origin), float(entity.frame), add_material(material), loose);
    snapshot_.moving.mask_loose(shared::MASK_TRANSLUCENT);
    for (size_t i = first; i < loose.size(); i++) {
        const auto& [a, b, c] = loose[i].positions;
        add_glow(a, b, c, triangle_area(a, b, c), material);
    }
}

void SnapshotBuilder::add_null_model(const Entity& entity)
{
    const Transform transform = md2_transform(to_vec3(entity.origin), to_vec3(entity.angles));
    vkpt::append_null_model(transform, add_material(plain_material()), snapshot_.moving.loose());
    snapshot_.moving.mask_loose(shared::MASK_OPAQUE);
}

void SnapshotBuilder::add_particle(const Particle& particle)
{
    shared::Material material = plain_material();
    material.tint = decode_colour(textures_.palette()[size_t(particle.color & 255)]) * unlit_radiance;
    material.opacity = std::clamp(particle.alpha, 0.0f, 1.0f);
    material.flags = shared::MATERIAL_FULLBRIGHT | shared::MATERIAL_TRANSLUCENT | shared::MATERIAL_PARTICLE
        | (cvars::values().gl3_particle_square != 0 ? shared::MATERIAL_SQUARE : 0u);
    const float size = std::clamp(cvars::values().gl3_particle_size / usual_particle_size, 0.0f, 10.0f);
    const glm::vec3 origin = to_vec3(particle.origin);
    append_particle(origin, eye_, axes_at(origin), add_material(material), snapshot_.moving.loose(), size);
    snapshot_.moving.mask_loose(shared::MASK_TRANSLUCENT);
}

// What of a light's colour is negative takes light away; the rest shines.
void SnapshotBuilder::add_dlight(const DynamicLight& light)
{
    constexpr float lightmap_units = 128; // of a radiance of 1
    const glm::vec3 origin = to_vec3(light.origin), colour = to_vec3(light.color) / lightmap_units;
    const glm::vec3 taken = glm::max(-colour, glm::vec3(0)) * cvars::values().pt_dlight_scale;
    if (is_sane(colour) && is_sane(origin) && is_sane(light.intensity)) {
        snapshot_.dlights.push_back({ origin, light.intensity, colour });
        if (taken != glm::vec3(0) && is_sane(taken))
            snapshot_.dark_lights.push_back({ origin, light.intensity, taken });
    }
    shared::Emitter emitter = make_dynamic_light(origin, to_vec3(light.color), light.intensity);
    emitter.lightstyle = lightstyle_dlight;
    if (emitter.radiance != glm::vec3(0))
        snapshot_.emitters.push_back(emitter);
}

// Menus show a model alone: lit by a large soft light above the viewer's shoulder.
void SnapshotBuilder::add_preview_light()
{
    constexpr float radius = 24, radiance = 6;
    shared::Emitter light {};
    light.type = shared::EMITTER_SPHERE;
    light.p0 = eye_ + axes_.up * 48.0f + axes_.right * 40.0f;
    light.p1.x = radius;
    light.area = 4 * 3.14159265f * radius * radius;
    light.radiance = glm::vec3(radiance);
    light.lightstyle = lightstyle_dlight;
    snapshot_.emitters.push_back(light);
}

} // namespace

void add_entities(SceneSnapshot& snapshot, const RefDef& refdef, std::span<const Entity> player_body,
    const TextureStore& textures, const MaterialDefaults& defaults, SkinLampCache& skin_lamps)
{
    SnapshotBuilder builder(snapshot, refdef, textures, defaults, skin_lamps);
    const auto add = [&](const Entity& entity) {
        const MovingGeometry::Extent first = snapshot.moving.extent();
        builder.add_entity(entity);
        snapshot.things.push_back(
            { entity.model, entity.flags, to_vec3(entity.origin), first, snapshot.moving.extent() });
    };
    if (cvars::values().r_drawentities != 0) {
        std::for_each_n(refdef.entities, refdef.entity_count, add);
        std::ranges::for_each(player_body, add);
    }
    for (int i = 0; i < refdef.particle_count; i++)
        builder.add_particle(refdef.particles[i]);
    for (int i = 0; i < refdef.dlight_count && cvars::values().vk_dynamic != 0; i++)
        builder.add_dlight(refdef.dlights[i]);
    if (!snapshot.world)
        builder.add_preview_light();
}

} // namespace vkpt

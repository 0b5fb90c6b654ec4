// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/scene.hpp"

#include "common/colour.hpp"
#include "formats/entities.hpp"
#include "formats/material_file.hpp"
#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/files/output_folder.hpp"
#include "ref_vkpt/lights/light_aim.hpp"
#include "ref_vkpt/lights/spot_cone.hpp"
#include "ref_vkpt/pass_statistics.hpp"
#include "ref_vkpt/scene/entities.hpp"
#include "ref_vkpt/scene/entity_geometry.hpp"
#include "ref_vkpt/scene/handles.hpp"
#include "ref_vkpt/scene/screens.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <span>
#include <utility>

namespace vkpt {

namespace {

// Models of one map at most, several times what the engine can ask for.
constexpr size_t max_models = 4096;
// How much brighter the sun's glare may be in the textures of a physical sky than the rest of it.
constexpr float glare_headroom = 6;
// What white stands for in them.
float white_of_sky(const PhysicalSky& sky) { return glare_headroom * brightest_of_sky(sky); }

bool ends_with(std::string_view name, std::string_view ending)
{
    return name.size() >= ending.size() && name.substr(name.size() - ending.size()) == ending;
}

// Emitters in an order that lasts over the frames, and the lists of those that can light each cluster.
void list_lights(SceneSnapshot& snapshot, const World& world, ViewLights& lights)
{
    const CpuTimer timer("cpu lights");
    snapshot.moving.move_emitters(int(world.models[0].emitters.size()), lights.dynamic.arrange(snapshot.emitters));
    lights.lists.update(snapshot.emitters);
    snapshot.light_lists = &lights.lists;
    const size_t unlisted = lights.lists.unlisted_dynamic_count();
    if (unlisted > 0 && !std::exchange(lights.said_unlisted, true))
        engine::print(
            "vkpt: {}: its moving lights make more than {} entries in the light lists; {} of them light nothing now",
            world.bsp.name, LightLists::max_dynamic_entries, unlisted);
}

// maps/NAME.lights: what players and authors add to a map's lights, as entity text.
std::string load_more_entities(std::string_view map)
{
    constexpr size_t max_bytes = 1 << 20;
    const std::string path = "maps/" + std::string(map) + ".lights";
    const std::optional<engine::FileData> file = engine::load_file(path);
    if (!file)
        return {};
    if (file->bytes().size() > max_bytes) {
        engine::print("vkpt: {} is left out: it has more than {} bytes", path, max_bytes);
        return {};
    }
    const std::string text(reinterpret_cast<const char*>(file->bytes().data()), file->bytes().size());
    try {
        formats::parse_entities(text, path);
    } catch (const formats::FormatError& error) {
        engine::print("vkpt: {}; its lights are left out", error.what());
        return {};
    }
    return '\n' + text;
}

// What `read` (of formats/) makes of a text, with its messages printed. Nothing where there is no such file, or it
// cannot be read; then the console also says what comes of that.
template <class File>
File load_text(const std::string& path, File (&read)(std::string_view, std::string_view), std::string_view consequence)
{
    const std::optional<engine::FileData> file = engine::load_file(path);
    if (!file)
        return {};
    try {
        File result = read({ reinterpret_cast<const char*>(file->bytes().data()), file->bytes().size() }, path);
        for (const std::string& message : result.messages)
            engine::print("vkpt: {}", message);
        return result;
    } catch (const formats::FormatError& error) {
        engine::print("vkpt: {}; {}", error.what(), consequence);
        return {};
    }
}

std::vector<formats::SecurityCamera> load_cameras(std::string_view map)
{
    return load_text("maps/cameras/" + std::string(map) + ".txt", formats::read_cameras, "the map has no cameras now")
        .cameras;
}

formats::MaterialFile load_material_file(const std::string& path)
{
    formats::MaterialFile file = load_text(path, formats::read_materials, "the file is left out");
    if (!file.without_effect.empty())
        engine::print("vkpt: {}", file.without_effect);
    return file;
}

// Whether the texture's bright parts shine without a light value, by its material or by pt_glow_threshold.
bool is_glowing(const Texture& texture, const MaterialSettings* material)
{
    const int threshold
        = material && material->glow_threshold >= 0 ? material->glow_threshold : cvars::values().pt_glow_threshold;
    return threshold > 0 && texture.brightest >= threshold;
}

// First of the moving emitters, so that they keep their places; a change of pt_sun_scale counts at once. `lights` knows
// those that are muted; nullptr: none is.
void add_suns(SceneSnapshot& snapshot, std::span<const Sun> suns, glm::vec3 sky_colour, const MapLights* lights)
{
    for (size_t i = 0; i < suns.size(); i++) {
        shared::Emitter emitter = make_sun(suns[i], sky_colour);
        if (lights && lights->is_sun_muted(i))
            emitter.lightstyle = lightstyle_none;
        else if (emitter.lightstyle == 0)
            emitter.lightstyle = lightstyle_sun;
        snapshot.emitters.push_back(emitter);
    }
}

// Beside and below the eye, so that what it shows has shadows; 90 degrees wide.
shared::Emitter make_flashlight(const engine::RefDef& refdef)
{
    constexpr float pi = std::numbers::pi_v<float>;
    constexpr float radius = 1.5f, aside = 6, below = 6, reach = 2000;
    constexpr float intensity = 60000; // radiant: a white wall at 200 units has half the radiance of a lit one
    const Axes axes = angle_vectors(to_vec3(refdef.view_angles));
    shared::Emitter emitter {};
    emitter.type = shared::EMITTER_SPHERE;
    emitter.p0 = to_vec3(refdef.view_origin) + axes.right * aside - axes.up * below;
    emitter.p1.x = radius;
    emitter.area = 4 * pi * radius * radius;
    emitter.radiance = glm::vec3(1, 0.96f, 0.88f) * (intensity / (pi * radius * radius));
    emitter.reach = reach;
    emitter.lightstyle = lightstyle_dlight;
    set_cone(emitter, axes.forward, std::cos(glm::radians(35.0f)), std::cos(glm::radians(45.0f)));
    return emitter;
}

Model::Mesh make_mesh(std::vector<formats::Md2Model>&& surfaces)
{
    Model::Mesh mesh;
    for (formats::Md2Model& surface : surfaces)
        mesh.parts.push_back({ std::make_shared<Md2Mesh>(surface), std::move(surface.skins), {} });
    return mesh;
}

// False: there is none, or it cannot be read.
bool load_replacement(Model& model)
{
    if (cvars::values().r_retexturing == 0)
        return false;
    for (const std::string& path : formats::replacements_of_mesh(model.name)) {
        const std::optional<engine::FileData> file = engine::load_file(path);
        if (!file)
            continue;
        try {
            model.shape = make_mesh(formats::read_mesh(file->bytes(), path));
            model.file = path;
            return true;
        } catch (const formats::FormatError& error) {
            engine::print("vkpt: {}; {} is shown in its place", error.what(), model.name);
            return false;
        }
    }
    return false;
}

FaceTexture describe(const Texture& texture, const MaterialSettings* material)
{
    FaceTexture face;
    face.slot = texture.slot;
    face.packed_size = texture.packed_size;
    face.size = { texture.width, texture.height };
    face.missing = texture.missing;
    face.has_holes = texture.has_holes;
    face.maps = maps_of(texture);
    const bool has_map = face.maps.emissive.slot != 0;
    const Texture& shining = has_map ? *texture.emissive : texture;
    face.average = shining.average;
    face.parts = shining.parts;
    face.glows = has_map || is_glowing(texture, material);
    if (material) {
        face.emissive_factor = has_map ? material->emissive_factor : 1;
        face.default_radiance = material->default_radiance;
        face.takes_light_value = material->takes_light_value;
        face.takes_lightstyles = material->takes_lightstyles;
        face.medium = material->medium;
        face.is_sky = material->is_sky;
        face.is_invisible = material->is_invisible;
    }
    return face;
}

} // namespace

Scene::Scene(TextureStore& textures)
    : textures_(textures)
{
    models_.reserve(max_models);
    textures_.use_materials(materials_);
}

void Scene::begin_registration(std::string_view map)
{
    registration_++;
    textures_.begin_registration();
    // Not two maps in memory at once, and none where the new one cannot be read. Its brush models go with it: the next
    // map's number 5 is another one, or none.
    map_lights_.reset();
    world_ = nullptr;
    for (Model& model : models_)
        if (std::holds_alternative<Model::Brush>(model.shape))
            model = {};
    const std::string path = "maps/" + std::string(map) + ".bsp";
    map_path_ = path;
    const std::optional<engine::FileData> file = engine::load_file(path);
    if (!file)
        throw LevelError(path + " does not exist: is the map's package installed?");
    load_materials(map);
    EmissionScales scales;
    scales.point_light_radius = cvars::values().pt_point_light_radius;
    const FindFaceTexture find = [&](const std::string& name) {
        const Texture& texture = *textures_.find(name, TextureUse::wall);
        return describe(texture, materials_.find(texture.material));
    };
    world_ = load_world(file->bytes(), path, find, scales, load_more_entities(map));
    for (const std::string& message : world_->messages)
        engine::print_developer(message);
    world_->cameras = load_cameras(map);
    sky_ = {};
}

// Of those that are registered; nullptr: none.
Model* Scene::find_model(std::string_view name)
{
    const auto known = std::ranges::find_if(models_, [&](const Model& m) { return m.registration && m.name == name; });
    return known != models_.end() ? &*known : nullptr;
}

// Of the game's own files, from the most general to the map's; what the player saved goes before them.
void Scene::load_materials(std::string_view map)
{
    materials_.forget_files();
    const engine::Cvar* cvar = engine::get_cvar("game", "", engine::CVAR_NONE);
    const std::string game = cvar && cvar->text ? cvar->text : "";
    std::vector<std::string> paths { "materials/baseq2.mat" };
    if (is_plain_name(game) && game != "baseq2")
        paths.push_back("materials/" + game + ".mat");
    paths.push_back("maps/" + std::string(map) + ".mat");
    for (const std::string& path : paths)
        materials_.add(load_material_file(path));
    if (!std::exchange(has_edits_, true))
        materials_.take_edits(load_material_file(saved_materials_path));
}

Model* Scene::register_model(std::string_view name)
{
    if (name.empty())
        return nullptr;
    Model* model = find_model(name);
    if (!model) {
        try {
            if (std::optional<Model> loaded = load_model(std::string(name)))
                model = keep_model(std::move(*loaded));
        } catch (const formats::FormatError& error) {
            engine::print("vkpt: {}", error.what());
        }
    }
    if (!model)
        return nullptr;
    model->registration = registration_;
    find_textures(*model);
    return model;
}

Model* Scene::keep_model(Model model)
{
    const auto free = std::ranges::find(models_, 0u, &Model::registration);
    if (free != models_.end()) {
        *free = std::move(model);
        return &*free;
    }
    if (models_.size() == models_.capacity()) {
        engine::print("vkpt: {} is not shown: more than {} models in use", model.name, max_models);
        return nullptr;
    }
    return &models_.emplace_back(std::move(model));
}

std::optional<Model> Scene::load_model(const std::string& name) const
{
    Model model;
    model.name = name;
    model.light = formats::find_light_model(name);
    if (name[0] == '*') {
        const std::optional<size_t> index = formats::brush_model_index(name);
        if (!index || !world_ || *index >= world_->models.size())
            return std::nullopt;
        model.shape = Model::Brush { *index };
        return model;
    }
    if (ends_with(name, ".bsp")) {
        model.shape = Model::Brush { 0 };
        return world_ ? std::optional(std::move(model)) : std::nullopt;
    }
    if (load_replacement(model))
        return model;
    const std::optional<engine::FileData> file = engine::load_file(name);
    if (!file)
        return std::nullopt;
    model.file = name;
    if (ends_with(name, ".sp2"))
        model.shape = Model::Sprite { formats::read_sp2(file->bytes(), name), {} };
    else
        model.shape = make_mesh(formats::read_mesh(file->bytes(), name));
    return model;
}

// Loads the textures of a new model, and keeps those of a known one.
void Scene::find_textures(Model& model)
{
    if (auto* mesh = std::get_if<Model::Mesh>(&model.shape))
        for (Model::Part& part : mesh->parts) {
            part.skins.clear();
            for (const std::string& skin : part.skin_names)
                part.skins.push_back(textures_.find(skin, TextureUse::skin));
        }
    if (auto* sprite = std::get_if<Model::Sprite>(&model.shape)) {
        sprite->textures.clear();
        for (const formats::Sp2Sprite::Frame& frame : sprite->sp2.frames)
            sprite->textures.push_back(textures_.find(frame.picture, TextureUse::sprite));
    }
}

const Texture* Scene::register_skin(std::string_view name) { return textures_.find(name, TextureUse::skin); }

void Scene::set_sky(std::string_view name, float degrees_per_second, glm::vec3 axis)
{
    sky_ = {};
    if (world_ && cvars::values().pt_sky == "physical") {
        set_physical_sky();
        return;
    }
    sky_.degrees_per_second = degrees_per_second;
    const float length = glm::length(axis);
    sky_.axis = std::isfinite(length) && length > 0 ? axis / length : glm::vec3(0, 0, 1);
    // The engine names the sides in the order right, back, left, front, up, down; shaders want +x -x +y -y +z -z.
    constexpr size_t engine_order[6] = { 0, 2, 1, 3, 4, 5 };
    const std::array<const Texture*, 6> sides = textures_.find_sky(name);
    for (size_t i = 0; i < 6; i++) {
        const Texture* texture = sides[engine_order[i]];
        sky_.present |= texture != nullptr;
        sky_.textures[i] = texture;
        sky_.average += (texture ? texture->average : glm::vec3(0)) / 6.0f;
    }
    if (!sky_.present) {
        engine::print("vkpt: no texture of the sky \"{}\" in env/; a plain one is shown", name);
        sky_.average = glm::vec3(0.25f, 0.3f, 0.4f);
    }
}

void Scene::end_registration()
{
    for (Model& model : models_)
        if (model.registration != registration_)
            model = {};
    if (world_) {
        if (sky_.physical)
            light_physical_sky();
        const float sky_luminance = luminance(sky_.average);
        if (!sky_.physical)
            sky_.scale = world_->lit_sky_luminance > 0 && sky_luminance > 0 ? world_->lit_sky_luminance / sky_luminance
                                                                            : EmissionScales().sky;
        find_sky_sun();
        set_sky_radiance(*world_, sky_.average * sky_.scale);
    }
    skin_lamps_.clear();
    textures_.end_registration();
}

// Where a map has no sun of its own, the one in its sky's textures takes over a share of the sky's light: as much as
// falls on level ground without anything in the way.
void Scene::find_sky_sun()
{
    constexpr float lowest = 0.15f; // sine of the elevation
    const float share = cvars::values().pt_sky_sun;
    if (share <= 0 || !world_->suns.empty() || sky_.physical)
        return;
    for (size_t side = 0; side < sky_.textures.size(); side++) {
        const Texture* texture = sky_.textures[side];
        if (!texture || !texture->sun)
            continue;
        Sun sun;
        sun.to_sun = direction_on_sky(side, texture->sun->centre);
        if (sun.to_sun.z < lowest)
            continue;
        sun.light = 128 * share * luminance(sky_.average) * sky_.scale / sun.to_sun.z;
        sun.colour = texture->sun->colour / luminance(texture->sun->colour);
        sun.half_angle = glm::radians(0.5f * sun_diameter);
        sky_.sun = sun;
        sky_.scale *= 1 - share;
        return;
    }
}

// The sky as textures, with the sun where the map's first one stands, or where the player's settings say.
void Scene::set_physical_sky()
{
    constexpr int side_size = 256;
    const CvarValues& cvars = cvars::values();
    const glm::vec3 to_sun = world_->suns.empty() ? direction_of_angles(cvars.pt_sky_azimuth, cvars.pt_sky_elevation)
                                                  : world_->suns.front().to_sun;
    const PhysicalSky sky(to_sun, cvars.pt_sky_turbidity);
    const float white = white_of_sky(sky);
    sky_.present = true;
    for (size_t side = 0; side < sky_.textures.size(); side++) {
        const std::string name = fmt::format(
            "*sky {:.4f} {:.4f} {:.4f} {:.2f} {}", to_sun.x, to_sun.y, to_sun.z, cvars.pt_sky_turbidity, side);
        sky_.textures[side] = textures_.add_sky_side(name, [&] { return draw_sky_side(sky, side, side_size, white); });
        sky_.average += (sky_.textures[side] ? sky_.textures[side]->average : glm::vec3(0)) / 6.0f;
    }
    sky_.physical = sky;
}

// How bright the sky and its sun are. A map's own sun is as bright as the map says, and the sky goes with it; else
// level ground in the open gets what a map's sky faces with a light value send it, or what suits most rooms beside it.
void Scene::light_physical_sky()
{
    constexpr float usual_ground = 2; // radiance of white ground
    const PhysicalSky& sky = *sky_.physical;
    float shown = 0; // radiance of white ground that a thousand lux fall on
    if (!world_->suns.empty()) {
        shown = world_->suns.front().light / 128 / light_of_map_sun(sky);
    } else {
        const glm::vec3 of_sun = sky.sun_irradiance();
        const float level = luminance(of_sun) * sky.to_sun().z + luminance(sky.level_irradiance());
        shown = (world_->lit_sky_luminance > 0 ? world_->lit_sky_luminance : usual_ground) / level;
        Sun sun;
        sun.to_sun = sky.to_sun();
        sun.light = 128 * shown * luminance(of_sun);
        sun.colour = of_sun / luminance(of_sun);
        sun.half_angle = glm::radians(0.5f * sun_diameter);
        sky_.sun = sun;
    }
    // White stands for so much; a sky of even radiance L lights level ground by pi L.
    constexpr float pi = std::numbers::pi_v<float>;
    sky_.scale = shown * pi * white_of_sky(sky);
}

shared::Sky Scene::make_sky(float time) const
{
    shared::Sky sky {};
    const glm::mat4 turn = glm::rotate(glm::mat4(1), glm::radians(sky_.degrees_per_second * time), sky_.axis);
    for (int i = 0; i < 3; i++)
        sky.rotation[i] = glm::vec3(turn[i]);
    const float scale = sky_.scale * cvars::values().pt_sky_scale;
    sky.present = sky_.present ? 1 : 0;
    sky.radiance = sky_.present ? glm::vec3(scale) : sky_.average * scale;
    for (size_t i = 0; i < 6; i++)
        sky.textures[i] = sky_.textures[i] ? sky_.textures[i]->slot : textures_.white().slot;
    return sky;
}

std::vector<engine::Entity> Scene::find_player_body(const engine::RefDef& refdef)
{
    const CvarValues& cvars = cvars::values();
    if (cvars.pt_player_body == 0)
        return {};
    // The engine registers every player's model, skin and weapons, this one's too.
    const RegisteredBody registered { [this](const std::string& path) { return find_model(path); },
        [this](const std::string& path) { return const_cast<Texture*>(register_skin(path)); } };
    return player_body_.stand(refdef, *world_, cvars.skin, registered);
}

// Those of the map and the sky's, which turns with it.
std::vector<Sun> Scene::find_suns_of_moment(const shared::Sky& sky) const
{
    std::vector<Sun> suns = world_->suns;
    if (sky_.physical) {
        const glm::vec3 light = sky_.physical->sun_irradiance();
        for (Sun& sun : suns)
            sun.colour = sun.colour.value_or(light / luminance(light));
    }
    if (sky_.sun) {
        suns.push_back(*sky_.sun);
        suns.back().to_sun = glm::mat3(sky.rotation[0], sky.rotation[1], sky.rotation[2]) * sky_.sun->to_sun;
    }
    return suns;
}

MapLights& Scene::map_lights()
{
    if (!map_lights_)
        map_lights_.emplace(*world_, world_->suns.size() + (sky_.sun ? 1 : 0));
    return *map_lights_;
}

Scene::CheckedView Scene::check_handles(const engine::RefDef& refdef) const
{
    CheckedView view { { refdef.entities, refdef.entities + refdef.entity_count }, refdef };
    for (engine::Entity& entity : view.entities) {
        entity.model = const_cast<Model*>(find_handle(entity.model, models_.data(), models_.size()));
        entity.skin = const_cast<Texture*>(textures_.of_handle(entity.skin));
    }
    view.refdef.entities = view.entities.data();
    return view;
}

SceneSnapshot Scene::take_snapshot(
    const engine::RefDef& given, ViewLights& lights, const engine::RefDef* player, bool looks_around)
{
    const CvarValues& cvars = cvars::values();
    const CheckedView checked = check_handles(given);
    const std::optional<CheckedView> checked_player
        = player ? std::optional(check_handles(*player)) : std::nullopt; // else as `checked`
    const engine::RefDef &refdef = checked.refdef, &eye = checked_player ? checked_player->refdef : refdef;
    SceneSnapshot snapshot;
    snapshot.looks_around = looks_around;
    snapshot.time = refdef.time;
    snapshot.lightstyles.assign(lightstyle_count, cvars.pt_emission_scale);
    for (size_t i = 0; refdef.lightstyles && i < size_t(engine::max_lightstyles); i++)
        snapshot.lightstyles[i] = refdef.lightstyles[i].white / 3 * cvars.pt_emission_scale;
    snapshot.lightstyles[lightstyle_dlight] = cvars.pt_dlight_scale;
    snapshot.lightstyles[lightstyle_sky] = cvars.pt_sky_scale;
    snapshot.lightstyles[lightstyle_none] = 0;
    snapshot.lightstyles[lightstyle_sun] = cvars.pt_sun_scale;
    std::vector<engine::Entity> player_body;
    const MaterialDefaults defaults { cvars.pt_roughness_default, cvars.pt_metallic_default, &materials_,
        cvars.pt_bump_scale };
    if (!(refdef.flags & engine::RDF_NOWORLDMODEL) && world_) {
        snapshot.world = world_.get();
        if (map_lights_)
            snapshot.shown_lights = map_lights_->shown();
        snapshot.has_alpha_test = world_->models[0].has_alpha_test;
        snapshot.moving = MovingGeometry(uint32_t(world_->models[0].triangles.size()));
        snapshot.materials = world_->make_materials(refdef.time, defaults);
        if (cvars.pt_cameras != 0)
            snapshot.screens = find_screens(*world_, materials_, refdef.time, snapshot.materials);
        snapshot.sky = make_sky(refdef.time);
        player_body = find_player_body(eye);
        for (engine::Entity& part : player_body)
            part.flags &= player ? ~engine::RF_VIEWERMODEL : ~0;
        world_->animated_lights.append_rows(snapshot.lightstyles, refdef.time);
        add_suns(snapshot, find_suns_of_moment(snapshot.sky), sky_.average, map_lights_ ? &*map_lights_ : nullptr);
        if (cvars.pt_flashlight != 0)
            snapshot.emitters.push_back(make_flashlight(eye));
    }
    add_entities(snapshot, refdef, player_body, textures_, defaults, skin_lamps_);
    if (snapshot.world)
        list_lights(snapshot, *world_, lights);
    return snapshot;
}

void Scene::print_models() const
{
    size_t count = 0;
    for (const Model& model : models_) {
        if (!model.registration)
            continue;
        count++;
        if (const auto* mesh = std::get_if<Model::Mesh>(&model.shape)) {
            size_t triangles = 0;
            for (const Model::Part& part : mesh->parts)
                triangles += part.md2->triangle_count();
            engine::print("{:6} triangles {:4} frames  {}", triangles, mesh->parts[0].md2->frame_count(), model.file);
        } else if (const auto* brush = std::get_if<Model::Brush>(&model.shape))
            engine::print("{:6} triangles    1 frame   {}", world_->models[brush->index].triangles.size(), model.name);
        else
            engine::print(
                "     2 triangles {:4} frames  {}", std::get<Model::Sprite>(model.shape).sp2.frames.size(), model.name);
    }
    engine::print("{} models", count);
}

} // namespace vkpt

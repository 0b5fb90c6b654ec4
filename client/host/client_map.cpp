// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/client_map.hpp"

#include "client/host/errors.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <numbers>

namespace vkpt::client {

namespace {

constexpr float eye_height = 22; // of the player's eye over the origin
constexpr float default_fov = 90; // degrees, horizontally on a 4:3 screen

float radians(float degrees) { return degrees * std::numbers::pi_v<float> / 180; }

std::optional<glm::vec3> parse_vector(std::string_view text)
{
    formats::EntityText entity;
    entity.pairs["vector"] = text;
    return entity.vector("vector");
}

formats::Bsp read_map(FileSystem& files, const std::string& map)
{
    const auto bytes = files.read(map);
    if (bytes)
        return formats::read_bsp(*bytes, map);
    std::vector<std::string> others = files.list("maps", ".bsp");
    const size_t count = others.size();
    others.resize(std::min<size_t>(count, 20));
    throw Failure(fmt::format("no map {}; looked in\n  {}\n{}", map, fmt::join(files.search_path(), "\n  "),
        count == 0 ? std::string("There is no map at all: name the folder that contains \"baseq2\" with --basedir DIR.")
                   : fmt::format(
                       "There {}: {}{}", count == 1 ? "is" : "are", fmt::join(others, " "), count > 20 ? " ..." : "")));
}

float distance_to_box(glm::vec3 p, glm::vec3 mins, glm::vec3 maxs)
{
    return glm::distance(p, glm::clamp(p, mins, maxs));
}

} // namespace

std::optional<Camera> find_player_start(const std::vector<formats::EntityText>& entities)
{
    for (const std::string_view wanted : { "info_player_start", "info_player_deathmatch" })
        for (const formats::EntityText& entity : entities)
            if (entity.class_name() == wanted)
                if (const auto origin = entity.vector("origin"))
                    return Camera { *origin + glm::vec3(0, 0, eye_height), 0, entity.number("angle", 0) };
    return std::nullopt;
}

ClientMap::ClientMap(FileSystem& files, const SceneName& name)
    : map_(name.map)
{
    if (!name.file.empty())
        files.add_file(map_, name.file);
    bsp_ = read_map(files, map_);
    entities_ = formats::parse_entities(bsp_.entity_text, map_);
    const std::optional<Camera> camera = name.camera ? name.camera : find_player_start(entities_);
    if (!camera)
        throw Failure(fmt::format("{} has no player start: name a camera, {}@x,y,z,pitch,yaw", map_, map_));
    camera_ = *camera;
    set_lightstyles();
}

void ClientMap::register_with(Host& host)
{
    models_.clear();
    shown_.clear();
    notes_.clear();
    register_map(host);
    place_brush_models();
}

// In the client's order; its first model is the world itself.
void ClientMap::register_map(Host& host)
{
    const engine::Exports8& module = host.module();
    constexpr size_t prefix = std::string_view("maps/").size(), suffix = std::string_view(".bsp").size();
    const std::string short_name = map_.substr(prefix, map_.size() - prefix - suffix);
    module.begin_registration(short_name.c_str());
    models_.push_back(module.register_model(map_.c_str()));
    for (size_t i = 1; i < bsp_.models.size(); i++)
        models_.push_back(module.register_model(fmt::format("*{}", i).c_str()));
    const formats::EntityText world = entities_.empty() ? formats::EntityText() : entities_.front();
    const glm::vec3 axis = parse_vector(world.get("skyaxis")).value_or(glm::vec3(0));
    const std::string sky(world.get("sky", "unit1_"));
    module.set_sky(sky.c_str(), world.number("skyrotate", 0), &axis.x);
    module.end_registration();
}

void ClientMap::place_brush_models()
{
    struct Candidate {
        engine::Entity entity;
        float distance;
    };
    std::vector<Candidate> candidates;
    for (const formats::EntityText& text : entities_) {
        const size_t index = formats::brush_model_index(text.get("model")).value_or(0);
        if (index == 0 || index >= models_.size() || !models_[index])
            continue;
        const formats::BspModel& box = bsp_.models[index];
        const auto placement = place_brush_model(text, box, entities_);
        if (!placement)
            continue;
        engine::Entity entity {};
        entity.model = models_[index];
        for (int i = 0; i < 3; i++) {
            entity.origin[i] = entity.previous_origin[i] = placement->origin[i];
            entity.angles[i] = placement->angles[i];
        }
        candidates.push_back(
            { entity, distance_to_box(camera_.position, box.mins + placement->origin, box.maxs + placement->origin) });
    }
    if (candidates.size() > size_t(engine::max_entities)) {
        notes_.push_back(fmt::format(
            "{} brush models are visible at the start, but the refresh API takes {}: only the nearest are shown",
            candidates.size(), engine::max_entities));
        std::ranges::stable_sort(candidates, {}, &Candidate::distance);
        candidates.resize(size_t(engine::max_entities));
    }
    for (const Candidate& candidate : candidates)
        shown_.push_back(candidate.entity);
}

// All styles shine as compiled; the game's animated ones at their usual level, so that a still picture does not depend
// on the moment. Dark are 63 (the map makers' test style) and the switched styles of lights that start off.
void ClientMap::set_lightstyles()
{
    const auto set = [&](size_t style, float level) { lightstyles_[style] = { { level, level, level }, 3 * level }; };
    for (size_t style = 0; style < lightstyles_.size(); style++)
        set(style, style == 63 ? 0.0f : 1.0f);
    for (const formats::EntityText& entity : entities_) {
        const float style = entity.number("style", 0);
        const bool starts_off = (spawn_flags(entity) & 1) != 0;
        if (entity.class_name().starts_with("light") && starts_off && style >= 32 && style < float(lightstyles_.size()))
            set(size_t(style), 0);
    }
}

const engine::RefDef& ClientMap::view(int width, int height, float seconds)
{
    refdef_ = {};
    refdef_.width = width;
    refdef_.height = height;
    // As the engine's client: the vertical angle is that of a 4:3 screen, wider screens see more at the sides.
    const float half_height = std::tan(radians(default_fov) / 2) * 3 / 4;
    refdef_.fov_y = 2 * std::atan(half_height) * 180 / std::numbers::pi_v<float>;
    refdef_.fov_x = 2 * std::atan(half_height * float(width) / float(height)) * 180 / std::numbers::pi_v<float>;
    for (int i = 0; i < 3; i++)
        refdef_.view_origin[i] = camera_.position[i];
    refdef_.view_angles[0] = camera_.pitch;
    refdef_.view_angles[1] = camera_.yaw;
    refdef_.time = seconds;
    const size_t leaf = bsp_.find_leaf(camera_.position);
    if (bsp_.leaves[leaf].contents & (formats::CONTENTS_WATER | formats::CONTENTS_SLIME | formats::CONTENTS_LAVA))
        refdef_.flags |= engine::RDF_UNDERWATER;
    refdef_.lightstyles = lightstyles_.data();
    refdef_.entity_count = int32_t(shown_.size());
    refdef_.entities = shown_.data();
    return refdef_;
}

} // namespace vkpt::client

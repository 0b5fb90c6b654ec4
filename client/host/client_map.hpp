// SPDX-License-Identifier: GPL-2.0-or-later
// A map as the engine's client first shows it: registered in the client's order, brush models where they stand at the
// start.
#pragma once

#include "client/host/host.hpp"
#include "client/host/scene_name.hpp"
#include "formats/bsp.hpp"
#include "formats/entities.hpp"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt::client {

class ClientMap {
public:
    // Reads the map; no module is needed yet. Throws Failure; FormatError where the map is broken.
    ClientMap(FileSystem& files, const SceneName& name);
    ClientMap(const ClientMap&) = delete;
    ClientMap& operator=(const ClientMap&) = delete;
    // Registers the map with the module and places its brush models. Once for every host.
    void register_with(Host& host);

    const Camera& camera() const { return camera_; }
    void set_camera(const Camera& camera) { camera_ = camera; }
    // Things that were left out or replaced, one line each.
    const std::vector<std::string>& notes() const { return notes_; }
    // The view at `seconds`; valid until the next call.
    const engine::RefDef& view(int width, int height, float seconds);

private:
    void register_map(Host& host);
    void place_brush_models();
    void set_lightstyles();

    std::string map_; // "maps/NAME.bsp"
    formats::Bsp bsp_;
    std::vector<formats::EntityText> entities_;
    Camera camera_;
    std::vector<void*> models_; // of the module, one per brush model
    std::vector<engine::Entity> shown_;
    std::array<engine::Lightstyle, engine::max_lightstyles> lightstyles_ {};
    std::vector<std::string> notes_;
    engine::RefDef refdef_ {};
};

// Where the first player start looks from: info_player_start, else info_player_deathmatch. Nothing: the map has none.
std::optional<Camera> find_player_start(const std::vector<formats::EntityText>& entities);

// The entity's "spawnflags"; a number that is out of range: none.
uint32_t spawn_flags(const formats::EntityText& entity);

// How a brush model's entity stands when the level begins. Nothing: the client never sees it (triggers and the like).
struct BrushPlacement {
    glm::vec3 origin { 0 };
    glm::vec3 angles { 0 }; // pitch, yaw, roll
};
std::optional<BrushPlacement> place_brush_model(const formats::EntityText& entity, const formats::BspModel& model,
    const std::vector<formats::EntityText>& entities);

} // namespace vkpt::client

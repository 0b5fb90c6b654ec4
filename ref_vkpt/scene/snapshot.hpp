// SPDX-License-Identifier: GPL-2.0-or-later
// Everything that one 3D view shows and that may differ in the next one. CPU side.
#pragma once

#include "ref_vkpt/scene/map_lights.hpp"
#include "ref_vkpt/scene/moving_geometry.hpp"
#include "ref_vkpt/scene/world.hpp"
#include "shaders/shared/frame.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vkpt {

// What one entity added to `moving`, and what tells it from the others of a view.
struct MovingThing {
    const void* model = nullptr;
    int32_t flags = 0; // of the entity
    glm::vec3 origin { 0 };
    MovingGeometry::Extent first, end;
};

struct SceneSnapshot {
    const World* world = nullptr; // nullptr: models alone (menus)
    std::shared_ptr<const ShownLights> shown_lights; // instead of the world's own; nullptr: none of them is muted
    const LightLists* light_lists = nullptr; // of the view, where there is a world: as they are with these emitters
    // What moves: ids continue after the world's triangles, emitters after the world's emitters, materials after the
    // world's.
    MovingGeometry moving;
    std::vector<MovingThing> things; // of `moving`, in its order
    std::vector<shared::Emitter> emitters;
    std::vector<shared::Dlight> dark_lights; // what those of negative colour take away
    std::vector<shared::Dlight> dlights; // all, as the classic renderers add them
    std::vector<shared::Material> materials; // all: the world's first
    std::vector<shared::Screen> screens; // that they name, at most MAX_SCREENS
    std::vector<float> lightstyles; // lightstyle_count of them, then those of animated faces
    shared::Sky sky {};
    std::vector<shared::FilterBox> filter_boxes; // of moving things, at most MAX_FILTER_BOXES
    bool has_alpha_test = false;
    bool looks_around = false; // sprites and particles face the eye, not the image's plane
    float time = 0; // seconds of the game
};

// The camera and its place in the image.
struct Viewpoint {
    shared::Camera camera {};
    glm::ivec2 origin { 0 }; // in the image
    glm::uvec2 size { 0 };
    glm::vec4 blend { 0 };
    bool underwater = false;
    int projection = shared::PROJECTION_PERSPECTIVE; // any other, where images are averaged
    // Of photo mode:
    bool is_photo = false; // it does not sway under water
    float exposure_stops = 0; // beside pt_exposure_bias
    uint32_t max_samples = 0; // that are averaged; 0: no limit
};
// Whether what they show may be averaged.
bool is_same(const Viewpoint& a, const Viewpoint& b);

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// A view of the world: one camera's images, one after the other. Whatever has a past is in here, so that views which
// are drawn in turn do not disturb each other. A view that was never drawn has no buffers.
#pragma once

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/frame/view_buffers.hpp"
#include "ref_vkpt/frame/view_history.hpp"
#include "ref_vkpt/lights/view_lights.hpp"
#include "ref_vkpt/scene/snapshot.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace vkpt {

struct View {
    // The scene of its last frame. pt_accumulate freezes it.
    ViewLights lights;
    std::optional<SceneSnapshot> snapshot;
    bool is_frozen = false;
    bool blends_next = false; // see Extension::blend_next_view

    // On the device.
    ViewBuffers buffers;
    Buffer exposure; // two ExposureState: of the world, and of menus

    // Of its last frame.
    Viewpoint viewpoint;
    CvarValues cvars;
    std::string light_sampler;
    glm::uvec2 radiance_size { 0 }; // pixels of `radiance`: of the world, after anti-aliasing, or of a menu
    glm::uvec2 rendered_size { 0 }; // pixels that were rendered of the world, whose surfaces the buffers still hold
    const Buffer* radiance = nullptr; // nullptr: no image yet
    ViewHistory history;
    bool lists_changed = false;
    bool samples_are_lost = false; // a menu has been drawn since: its light lies where the world's did
    struct LightCacheUse {
        uint32_t flags = 0; // FRAME_LIGHT_CACHE, FRAME_GUIDES
        uint32_t publications = 0; // see LightCacheKeeper
        bool operator==(const LightCacheUse&) const = default;
    };
    LightCacheUse light_cache;
    uint32_t light_visibility = 0; // LightVisibilityKeeper::state
    uint32_t history_frame_index = 0, offset_index = 0, noise_index = 0;
    uint32_t accumulated_frames = 0; // 0: the next one starts anew
    std::chrono::steady_clock::time_point time;

    // Another map comes, with these lists. The device is idle.
    void begin_world(const LightLists& lists)
    {
        snapshot.reset();
        lights = { {}, lists };
        radiance = nullptr;
        accumulated_frames = 0;
    }
};

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The running renderer: everything that exists between InitContext and ShutdownContext.
#pragma once

#include "ref_vkpt/draw2d/draw2d.hpp"
#include "ref_vkpt/frame/capture.hpp"
#include "ref_vkpt/frame/graphics.hpp"
#include "ref_vkpt/frame/sampler_choice.hpp"
#include "ref_vkpt/frame/scene_queries.hpp"
#include "ref_vkpt/frame/shader_reload.hpp"
#include "ref_vkpt/frame/shader_warm_up.hpp"
#include "ref_vkpt/free_memory.hpp"
#include "ref_vkpt/light_inspector.hpp"
#include "ref_vkpt/material_inspector.hpp"
#include "ref_vkpt/overlay/overlay.hpp"
#include "ref_vkpt/photo/pause_watch.hpp"
#include "ref_vkpt/photo/photo_mode.hpp"
#include "ref_vkpt/preset_command.hpp"
#include "ref_vkpt/rays/trace_choice.hpp"
#include "ref_vkpt/replay/replay.hpp"
#include "ref_vkpt/replay/replay_ring.hpp"
#include "ref_vkpt/scene/scene.hpp"
#include "ref_vkpt/workers.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace vkpt {

struct Module {
    explicit Module(const GraphicsSettings& settings);
    // Waits for the device: any of the members may have what it still reads.
    ~Module();

    Workers workers;
    Graphics graphics;
    TraceChoice trace_choice;
    TextureStore textures;
    Draw2d draw2d;
    Scene scene;
    Frame frame;
    GpuWorld gpu_world; // of scene.world()
    SamplerChoice sampler_choice;
    std::optional<shared::Camera> last_camera; // of the last view of a map
    bool frame_has_view = false; // the frame that is being recorded
    // See Extension::select_view: views that are drawn in turn, so that settings can be compared side by side.
    std::array<View, view_count> views;
    uint32_t selected_view = 0;
    View& view() { return views[selected_view]; }
    const View& view() const { return views[selected_view]; }
    // Materials or lights are others: images that are averaged take the scene anew.
    void renew_scene();
    // About the selected view's scene, if it has one.
    SceneQueries queries() { return { graphics, frame, view(), gpu_world }; }
    ShaderReload shader_reload;
    std::optional<ShaderWarmUp> warm_up; // from the first map's registration on
    FrameCapture capture;
    PresetCommand preset;
    Overlay overlay;
    PhotoMode photo;
    PauseWatch pause_watch;
    ReplayRing replay_ring;
    std::optional<Replay> replay; // that photo mode shows
    std::string replay_name_for_key; // waits for the player's key
    LightInspector light_inspector;
    MaterialInspector material_inspector;
    PassStatistics pass_statistics; // with pt_times 1
    FreeMemory free_memory;
    const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    double first_frame_seconds = 0; // from the start to the end of the first view; 0: there was none
};

// nullptr outside of InitContext .. ShutdownContext.
Module* module();

// `pt_info`: what runs where, and what it holds.
void print_info();

} // namespace vkpt

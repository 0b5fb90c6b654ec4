// SPDX-License-Identifier: GPL-2.0-or-later
// What the viewer shows, and everything that keys and panel can change about it.
#pragma once

#include "client/view/fly_camera.hpp"
#include "client/view/graph.hpp"
#include "client/view/window.hpp"

#include <array>
#include <chrono>
#include <cstdint>

namespace vkpt::client::view {

using Clock = std::chrono::steady_clock;

// One of the two pictures that are compared.
struct SideState {
    Settings settings;
    formats::Image picture;
    SdlTexture texture;
    PassHistory passes;
    ErrorHistory errors;
    double milliseconds = 0; // of the last frame
    uint32_t averaged_frames = 0;
    std::string backend;
};

struct State {
    std::string scene;
    SceneFacts facts;
    std::vector<LiveSetting> live;
    std::array<SideState, 2> sides;
    Split split;
    Side active = Side::a; // which the panel and the keys change

    Camera camera; // of the last frame, or where the user has flown
    bool has_flown = false; // else every frame has its own camera
    float speed = 320; // units per second

    int frame = 0;
    bool plays = true;

    bool has_reference = false;
    uint32_t reference_frames = 0;
    std::optional<double> reference_rmse;

    std::optional<glm::ivec2> marked; // pixel of the picture
    bool must_inspect = false;
    Side inspected_side = Side::a;
    std::optional<Inspection> inspection;

    bool shows_panel = true, shows_help = false, must_quit = false, must_save_window = false;
    bool must_reload_shaders = false;
    size_t highlighted = 0; // of `live`, by keyboard
    std::string notice; // at the bottom for a while
    bool notice_is_bad = false;
    Clock::time_point notice_time;
    std::deque<std::string> console;
    Area shown; // of the picture in the window

    SideState& side(Side which) { return sides[size_t(which)]; }
    const SideState& side(Side which) const { return sides[size_t(which)]; }
    bool is_endless() const { return !facts.frame_count; }
    // The last frame of a trace.
    int last_frame() const { return facts.frame_count ? std::max(*facts.frame_count - 1, 0) : 0; }
    glm::ivec2 picture_size() const { return { sides[0].picture.width, sides[0].picture.height }; }
};

void set_value(State& state, Side side, const std::string& name, const std::string& value);
const std::string& value_of(const State& state, Side side, std::string_view name); // "": there is no such setting
void show_notice(State& state, std::string text, bool is_bad = false);

// Time passes unless pictures are averaged, which shows one moment.
bool does_time_pass(const State& state);
void show_frame(State& state, int frame);

// The side whose picture is at this pixel.
Side side_at(const State& state, glm::ivec2 pixel);
void mark_pixel(State& state, glm::ivec2 pixel);

// One line that tells a side's settings: sampler and filters, and what differs from the other side.
std::string describe_side(const State& state, Side side);
std::string describe_title(const State& state);

} // namespace vkpt::client::view

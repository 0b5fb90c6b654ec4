// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/actions.hpp"

#include "client/host/output_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <glm/common.hpp>

namespace vkpt::client::view {

namespace {

constexpr float divider_step = 0.05f;
constexpr float speed_step = 1.5f;
constexpr float turning_speed = 70; // degrees per second, by keys

void change(State& state, std::string_view name, int steps, decltype(step_value)* next = step_value)
{
    const LiveSetting* setting = find_setting(state.live, name);
    if (!setting)
        return;
    const std::string value = next(*setting, value_of(state, state.active, name), steps);
    set_value(state, state.active, setting->name, value);
    show_notice(state, fmt::format("{}: {} {}", state.active == Side::a ? "A" : "B", setting->name, value));
}

template <int steps> void change_sampler(State& state) { change(state, "pt_light_sampler", steps); }
template <int steps> void change_subset(State& state) { change(state, "pt_light_subset", steps, double_value); }
template <int steps> void change_bounces(State& state) { change(state, "pt_bounces", steps); }
template <int steps> void change_denoiser(State& state) { change(state, "flt_denoiser", steps); }
template <int steps> void change_backend(State& state) { change(state, "pt_trace", steps); }
template <int steps> void change_debug_view(State& state) { change(state, "pt_debug_view", steps); }
template <int steps> void change_highlighted(State& state)
{
    if (state.highlighted < state.live.size())
        change(state, state.live[state.highlighted].name, steps);
}
template <int steps> void highlight(State& state)
{
    const int count = int(state.live.size());
    if (count > 0)
        state.highlighted = size_t((int(state.highlighted) + steps + count) % count);
}
template <int steps> void step_frame(State& state)
{
    state.plays = false;
    show_frame(state, state.frame + steps);
}
template <int steps> void change_speed(State& state)
{
    state.speed
        = std::clamp(steps > 0 ? state.speed * speed_step : state.speed / speed_step, slowest_speed, fastest_speed);
    show_notice(state, fmt::format("speed {:.0f} units per second", state.speed));
}
template <int steps> void move_divider(State& state)
{
    state.split.set_place(state.split.place() + float(steps) * divider_step);
}

void toggle_average(State& state)
{
    const bool was_on = value_of(state, state.active, "pt_accumulate") == "1";
    set_value(state, state.active, "pt_accumulate", was_on ? "0" : "1");
    show_notice(state, was_on ? "live picture" : "averaging: time stands still");
}

void toggle_split(State& state)
{
    state.split.is_on = !state.split.is_on;
    state.active = state.split.is_on ? Side::b : Side::a;
    if (state.split.is_on)
        show_notice(state, "keys and panel now change side B (1 and 2 select)");
}

template <Side side> void activate(State& state)
{
    state.split.is_on |= side == Side::b;
    state.active = side;
}

void copy_side(State& state)
{
    const Side other = state.active == Side::a ? Side::b : Side::a;
    for (const LiveSetting& setting : state.live)
        set_value(state, other, setting.name, value_of(state, state.active, setting.name));
    show_notice(state, other == Side::b ? "B is now as A" : "A is now as B");
}

void toggle_reference(State& state)
{
    state.has_reference = !state.has_reference;
    state.reference_frames = 0;
    for (SideState& side : state.sides)
        side.errors = {};
}

void inspect_centre(State& state)
{
    const glm::ivec2 size = state.picture_size();
    if (size.x > 0)
        mark_pixel(state, state.marked.value_or(size / 2));
}

template <int x, int y> void move_mark(State& state)
{
    const glm::ivec2 size = state.picture_size();
    if (size.x > 0)
        mark_pixel(state, glm::clamp(state.marked.value_or(size / 2) + glm::ivec2(x, y), glm::ivec2(0), size - 1));
}

void go_home(State& state)
{
    state.has_flown = false;
    state.marked.reset();
}

void toggle_playing(State& state) { state.plays = !state.plays; }

void leave(State& state)
{
    if (state.shows_help)
        state.shows_help = false;
    else
        state.must_quit = true;
}

constexpr Modifier plain = Modifier::none, shift = Modifier::shift, control = Modifier::control;
constexpr const char *settings_group = "Settings of the selected side", *compare_group = "Comparing",
                     *time_group = "Time and place", *window_group = "Window";

constexpr Action table[] = {
    { SDLK_l, plain, settings_group, "L, Shift+L", "next, previous light sampler", change_sampler<1> },
    { SDLK_l, shift, settings_group, "", "", change_sampler<-1> },
    { SDLK_r, plain, settings_group, "R, Shift+R", "double, halve the subset length R", change_subset<1> },
    { SDLK_r, shift, settings_group, "", "", change_subset<-1> },
    { SDLK_b, plain, settings_group, "B, Shift+B", "one bounce more, fewer", change_bounces<1> },
    { SDLK_b, shift, settings_group, "", "", change_bounces<-1> },
    { SDLK_n, plain, settings_group, "N, Shift+N", "next, previous denoiser", change_denoiser<1> },
    { SDLK_n, shift, settings_group, "", "", change_denoiser<-1> },
    { SDLK_t, plain, settings_group, "T, Shift+T", "next, previous trace backend", change_backend<1> },
    { SDLK_t, shift, settings_group, "", "", change_backend<-1> },
    { SDLK_v, plain, settings_group, "V, Shift+V", "next, previous debug view", change_debug_view<1> },
    { SDLK_v, shift, settings_group, "", "", change_debug_view<-1> },
    { SDLK_g, plain, settings_group, "G", "average frames (pt_accumulate)", toggle_average },
    { SDLK_DOWN, control, settings_group, "Ctrl+Down, Ctrl+Up", "choose any other setting", highlight<1> },
    { SDLK_UP, control, settings_group, "", "", highlight<-1> },
    { SDLK_RIGHT, control, settings_group, "Ctrl+Right, Ctrl+Left", "and change it", change_highlighted<1> },
    { SDLK_LEFT, control, settings_group, "", "", change_highlighted<-1> },
    { SDLK_x, plain, compare_group, "X", "split the picture: A | B", toggle_split },
    { SDLK_1, plain, compare_group, "1, 2", "choose side A, B", activate<Side::a> },
    { SDLK_2, plain, compare_group, "", "", activate<Side::b> },
    { SDLK_c, plain, compare_group, "C", "copy its settings to the other side", copy_side },
    { SDLK_LEFTBRACKET, plain, compare_group, "[, ]", "move the divider", move_divider<-1> },
    { SDLK_RIGHTBRACKET, plain, compare_group, "", "", move_divider<1> },
    { SDLK_m, plain, compare_group, "M", "error against a converging reference", toggle_reference },
    { SDLK_p, plain, compare_group, "P, click", "a pixel's surface and lights", inspect_centre },
    { SDLK_RIGHT, shift, compare_group, "Shift+arrows", "move the marked pixel", move_mark<4, 0> },
    { SDLK_LEFT, shift, compare_group, "", "", move_mark<-4, 0> },
    { SDLK_UP, shift, compare_group, "", "", move_mark<0, -4> },
    { SDLK_DOWN, shift, compare_group, "", "", move_mark<0, 4> },
    { SDLK_SPACE, plain, time_group, "Space", "play, pause", toggle_playing },
    { SDLK_PERIOD, plain, time_group, ". ,", "one frame on, back", step_frame<1> },
    { SDLK_COMMA, plain, time_group, "", "", step_frame<-1> },
    { SDLK_PAGEDOWN, plain, time_group, "PageDown, PageUp", "a second on, back", step_frame<60> },
    { SDLK_PAGEUP, plain, time_group, "", "", step_frame<-60> },
    { SDLK_HOME, plain, time_group, "Home", "back to the scene's own camera", go_home },
    { SDLK_EQUALS, plain, time_group, "+, -, wheel", "fly faster, slower", change_speed<1> },
    { SDLK_EQUALS, shift, time_group, "", "", change_speed<1> },
    { SDLK_PLUS, plain, time_group, "", "", change_speed<1> },
    { SDLK_KP_PLUS, plain, time_group, "", "", change_speed<1> },
    { SDLK_MINUS, plain, time_group, "", "", change_speed<-1> },
    { SDLK_KP_MINUS, plain, time_group, "", "", change_speed<-1> },
    { SDLK_o, plain, window_group, "O, F12", "write the picture to a PNG file", save_picture },
    { SDLK_F12, plain, window_group, "", "", save_picture },
    { SDLK_o, shift, window_group, "Shift+O", "write the whole window",
        [](State& state) { state.must_save_window = true; } },
    { SDLK_TAB, plain, window_group, "Tab, F11", "the panel; full screen",
        [](State& state) { state.shows_panel = !state.shows_panel; } },
    { SDLK_F5, plain, window_group, "F5", "look for edited shaders (pt_shader_dir)",
        [](State& state) { state.must_reload_shaders = true; } },
    { SDLK_F1, plain, window_group, "F1, H", "this help", [](State& state) { state.shows_help = !state.shows_help; } },
    { SDLK_h, plain, window_group, "", "", [](State& state) { state.shows_help = !state.shows_help; } },
    { SDLK_ESCAPE, plain, window_group, "Esc", "close the help; leave", leave },
    { SDLK_q, control, window_group, "Ctrl+Q", "leave", [](State& state) { state.must_quit = true; } },
};

constexpr MoveKey held_keys[] = {
    { "W A S D", "fly forward, left, back, right" },
    { "E, Q", "up, down" },
    { "arrows, drag", "look around" },
    { "Shift, Alt", "while flying: fast, slow" },
};

Modifier modifier_of(const SDL_KeyboardEvent& event)
{
    if (event.keysym.mod & KMOD_CTRL)
        return Modifier::control;
    return event.keysym.mod & KMOD_SHIFT ? Modifier::shift : Modifier::none;
}

} // namespace

std::span<const Action> actions() { return table; }
std::span<const MoveKey> move_keys() { return held_keys; }

bool run_key(State& state, const SDL_KeyboardEvent& event)
{
    for (const Action& action : table)
        if (action.key == event.keysym.sym && action.modifier == modifier_of(event)) {
            action.run(state);
            return true;
        }
    return false;
}

FlyInput read_move_keys(float seconds)
{
    const uint8_t* keys = SDL_GetKeyboardState(nullptr);
    const SDL_Keymod modifiers = SDL_GetModState();
    FlyInput input;
    if (modifiers & KMOD_CTRL)
        return input;
    const auto axis = [&](SDL_Scancode more, SDL_Scancode less) { return float(keys[more]) - float(keys[less]); };
    input.move = { axis(SDL_SCANCODE_W, SDL_SCANCODE_S), axis(SDL_SCANCODE_D, SDL_SCANCODE_A),
        axis(SDL_SCANCODE_E, SDL_SCANCODE_Q) };
    if (modifiers & KMOD_SHIFT) // then arrows move the marked pixel
        return input;
    input.yaw = axis(SDL_SCANCODE_LEFT, SDL_SCANCODE_RIGHT) * turning_speed * seconds;
    input.pitch = axis(SDL_SCANCODE_DOWN, SDL_SCANCODE_UP) * turning_speed * seconds;
    return input;
}

float held_speed_factor()
{
    const SDL_Keymod modifiers = SDL_GetModState();
    return modifiers & KMOD_SHIFT ? 4.0f : modifiers & KMOD_ALT ? 0.25f : 1.0f;
}

std::string next_free_name(std::string_view prefix)
{
    std::error_code ignored;
    for (int n = 1;; n++)
        if (std::string name = fmt::format("{}{:03}.png", prefix, n); !std::filesystem::exists(name, ignored))
            return name;
}

void save_picture(State& state)
{
    if (state.picture_size().x == 0)
        return;
    try {
        const std::string name = next_free_name("vkpt-view-");
        OutputFile file(name);
        file.write(formats::write_png(compose(state.sides[0].picture, state.sides[1].picture, state.split)));
        file.commit();
        show_notice(state, fmt::format("wrote {}", std::filesystem::absolute(name).string()));
    } catch (const std::exception& error) {
        show_notice(state, error.what(), true);
    }
}

} // namespace vkpt::client::view

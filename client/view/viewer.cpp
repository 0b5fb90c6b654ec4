// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/viewer.hpp"

#include "client/host/output_file.hpp"
#include "client/view/actions.hpp"
#include "client/view/panels.hpp"
#include "client/view/theme.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <utility>

namespace vkpt::client::view {

namespace {

constexpr double frame_seconds = 1.0 / 60; // of the interface, and of a map's time
constexpr double idle_seconds = 0.25; // between redraws while nothing happens
constexpr float degrees_per_pixel = 0.2f;
constexpr float click_distance = 4; // pixels; farther is a drag
constexpr float stillness_seconds = 0.25f; // before the reference starts
constexpr int max_frames_at_once = 30; // of a map's time, however slow the device
constexpr size_t kept_lines = 50;

float seconds_since(Clock::time_point time) { return std::chrono::duration<float>(Clock::now() - time).count(); }

glm::ivec2 window_size(const ViewerOptions& options)
{
    return { options.render.host.width + int(panel_width), std::max(options.render.host.height + 374, 820) };
}

bool is_same(const Camera& a, const Camera& b)
{
    return a.position == b.position && a.pitch == b.pitch && a.yaw == b.yaw;
}

} // namespace

Side Turns::next(bool has_b, bool has_reference)
{
    if (last_ == Side::a && has_b)
        last_ = Side::b;
    else if (last_ != Side::reference && has_reference)
        last_ = Side::reference;
    else
        last_ = Side::a;
    return last_;
}

Viewer::Viewer(const ViewerOptions& options)
    : options_(options)
    , window_(fmt::format("vkpt view - {}", options.render.scene), window_size(options))
    , thread_(options.render, Window::wake)
{
    state_.scene = options.render.scene.substr(0, options.render.scene.rfind('@'));
}

void Viewer::run()
{
    Clock::time_point last_draw {};
    while (!state_.must_quit) {
        const bool is_moving = seconds_since(last_camera_change_) < stillness_seconds || is_pressed_;
        bool must_draw = window_.wait_events(
            is_moving ? frame_seconds : idle_seconds, [&](const SDL_Event& event) { handle(event); });
        move_camera();
        must_draw |= has_news();
        if (is_ready_ && thread_.is_idle())
            request_frame();
        if ((must_draw && seconds_since(last_draw) >= float(frame_seconds) / 2)
            || seconds_since(last_draw) > float(idle_seconds)) {
            draw();
            last_draw = Clock::now();
        }
    }
}

bool Viewer::wants_keys() const { return !ImGui::GetIO().WantTextInput; }

void Viewer::handle(const SDL_Event& event)
{
    switch (event.type) {
    case SDL_QUIT:
        state_.must_quit = true;
        break;
    case SDL_KEYDOWN:
        if (event.key.keysym.sym == SDLK_F11)
            window_.toggle_full_screen();
        else if (wants_keys() && !(is_ready_ && run_key(state_, event.key)) && event.key.keysym.sym == SDLK_ESCAPE)
            state_.must_quit = true; // while loading
        break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
    case SDL_MOUSEMOTION:
    case SDL_MOUSEWHEEL:
        handle_mouse(event);
        break;
    }
}

// Asked of the place, for Dear ImGui knows of the mouse's way only from its next frame on.
bool Viewer::is_over_picture() const
{
    int x = 0, y = 0;
    SDL_GetMouseState(&x, &y);
    const bool has_popup = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    return state_.shown.contains({ float(x), float(y) }) && !state_.shows_help && !has_popup;
}

void Viewer::handle_mouse(const SDL_Event& event)
{
    const bool is_interface = !is_pressed_ && !is_over_picture();
    if (event.type == SDL_MOUSEWHEEL && !is_interface) {
        state_.speed = std::clamp(state_.speed * std::pow(1.25f, float(event.wheel.y)), slowest_speed, fastest_speed);
        show_notice(state_, fmt::format("speed {:.0f} units per second", state_.speed));
    } else if (event.type == SDL_MOUSEBUTTONDOWN && !is_interface) {
        pressed_at_ = { float(event.button.x), float(event.button.y) };
        if (state_.split.is_at_divider(state_.shown, pressed_at_) && event.button.button == SDL_BUTTON_LEFT)
            state_.split.begin_drag();
        else if (!state_.shown.contains(pressed_at_))
            return;
        is_pressed_ = true;
        is_looking_ = event.button.button == SDL_BUTTON_RIGHT;
        window_.set_mouse_look(is_looking_);
    } else if (event.type == SDL_MOUSEBUTTONUP && is_pressed_) {
        const bool is_click = !is_looking_ && !state_.split.is_dragged();
        if (const auto pixel = find_pixel(state_.shown, state_.picture_size(), pressed_at_); is_click && pixel)
            mark_pixel(state_, *pixel);
        is_pressed_ = is_looking_ = false;
        state_.split.end_drag();
        window_.set_mouse_look(false);
    } else if (event.type == SDL_MOUSEMOTION && is_pressed_) {
        const glm::vec2 now(float(event.motion.x), float(event.motion.y));
        state_.split.drag_to(state_.shown, now);
        is_looking_ |= !state_.split.is_dragged() && glm::distance(now, pressed_at_) > click_distance;
        if (!is_looking_)
            return;
        FlyInput input;
        input.yaw = -degrees_per_pixel * float(event.motion.xrel);
        input.pitch = degrees_per_pixel * float(event.motion.yrel);
        state_.camera = fly(state_.camera, input, 0, 0);
        state_.has_flown = true;
        state_.marked.reset();
        last_camera_change_ = Clock::now();
    }
}

void Viewer::move_camera()
{
    const float seconds = std::min(seconds_since(last_move_), 0.1f);
    last_move_ = Clock::now();
    if (!is_ready_ || !wants_keys())
        return;
    const FlyInput input = read_move_keys(seconds);
    const Camera moved = fly(state_.camera, input, state_.speed * held_speed_factor(), seconds);
    if (is_same(moved, state_.camera))
        return;
    state_.camera = moved;
    state_.has_flown = true;
    state_.marked.reset();
    last_camera_change_ = Clock::now();
}

bool Viewer::is_camera_still() const { return seconds_since(last_camera_change_) >= stillness_seconds; }

bool Viewer::has_news()
{
    bool any = false;
    for (std::string& line : thread_.take_lines()) {
        state_.console.push_back(std::move(line));
        if (state_.console.size() > kept_lines)
            state_.console.pop_front();
        any = true;
    }
    if (std::optional<SceneFacts> facts = thread_.take_facts()) {
        start(std::move(*facts));
        any = true;
    }
    if (std::optional<RenderedFrame> frame = thread_.take_frame()) {
        take_frame(std::move(*frame));
        any = true;
    }
    return any;
}

void Viewer::start(SceneFacts facts)
{
    state_.facts = std::move(facts);
    state_.live = find_live_settings(state_.facts.light_samplers);
    Settings settings;
    for (const LiveSetting& setting : state_.live)
        if (const auto found = state_.facts.settings.find(setting.name); found != state_.facts.settings.end())
            settings[setting.name] = found->second;
    state_.sides[0].settings = state_.sides[1].settings = settings;
    for (const auto& [name, value] : options_.b)
        state_.sides[1].settings[name] = value;
    if (!options_.b.empty()) {
        state_.split.is_on = true;
        state_.active = Side::b;
    }
    state_.frame = state_.facts.first_frame;
    state_.camera = state_.facts.camera;
    for (const std::string& note : state_.facts.notes)
        state_.console.push_back(note);
    last_passing_ = Clock::now();
    is_ready_ = true;
}

// A and B of one moment are shown together, once there is any B.
void Viewer::take_frame(RenderedFrame frame)
{
    state_.reference_frames = frame.reference_frames;
    state_.reference_rmse = frame.reference_rmse;
    if (frame.side == Side::reference)
        return;
    if (frame.side == Side::a && state_.split.is_on && state_.sides[1].texture) {
        waiting_a_ = std::move(frame);
        return;
    }
    if (waiting_a_) {
        show_side(std::move(*waiting_a_));
        waiting_a_.reset();
    }
    show_side(std::move(frame));
}

void Viewer::show_side(RenderedFrame frame)
{
    SideState& side = state_.side(frame.side);
    side.picture = std::move(frame.picture);
    side.milliseconds = frame.milliseconds;
    side.averaged_frames = frame.averaged_frames;
    side.backend = frame.backend;
    if (frame.inspection)
        state_.inspection = std::move(frame.inspection);
    if (!state_.has_flown)
        state_.camera = frame.camera;
    if (frame.asked == side.settings) { // else the user has changed some meanwhile
        side.passes.add(frame.passes);
        if (frame.error && state_.has_reference)
            side.errors.add(*frame.error);
        for (auto& [name, value] : side.settings)
            if (const auto used = frame.used.find(name); used != frame.used.end())
                value = used->second;
    }
    window_.upload(side.texture, side.picture);
    has_picture_ = true;
}

void Viewer::pass_time()
{
    const int passed = int(seconds_since(last_passing_) / float(frame_seconds));
    last_passing_ = Clock::now();
    if (!does_time_pass(state_))
        return;
    if (!state_.is_endless() && state_.frame >= state_.last_frame())
        state_.plays = false; // the trace has ended
    else // every frame of a trace, for that is what filters are made for
        show_frame(state_, state_.frame + (state_.is_endless() ? std::clamp(passed, 1, max_frames_at_once) : 1));
}

void Viewer::request_frame()
{
    RenderRequest request;
    request.side = turns_.next(state_.split.is_on, state_.has_reference && is_camera_still());
    if (request.side == Side::a) {
        pass_time();
        request.frame = state_.frame;
        if (state_.has_flown)
            request.camera = state_.camera;
    } else {
        request.frame = last_a_.frame;
        request.camera = last_a_.camera;
    }
    if (request.side == Side::reference) {
        request.settings = reference_settings(state_.sides[0].settings, state_.live);
        const bool goes_on = last_reference_ && last_reference_->settings == request.settings
            && last_reference_->frame == request.frame
            && last_reference_->camera.has_value() == request.camera.has_value()
            && (!request.camera || is_same(*last_reference_->camera, *request.camera));
        request.starts_anew = !goes_on;
        last_reference_ = request;
    } else {
        request.settings = state_.side(request.side).settings;
        request.compares = state_.has_reference && last_reference_ && is_camera_still();
        if (state_.must_inspect && state_.marked && state_.inspected_side == request.side) {
            request.inspected = state_.marked;
            state_.must_inspect = false;
        }
    }
    if (request.side == Side::a)
        last_a_ = request;
    request.reloads_shaders = std::exchange(state_.must_reload_shaders, false);
    thread_.submit(std::move(request));
}

void Viewer::draw()
{
    window_.set_title(describe_title(state_));
    window_.begin_frame();
    const glm::vec2 size = window_.size();
    const float room = state_.shows_panel && is_ready_ ? std::max(size.x - panel_width, 64.0f) : size.x;
    const float dock = is_ready_ ? dock_height(state_, size) : 0;
    state_.shown = fit_picture({ 0, 0, room, size.y - dock }, state_.picture_size());
    if (has_picture_) {
        const int width = state_.picture_size().x, columns = state_.split.columns_of_a(width);
        const bool has_b = state_.split.is_on && state_.sides[1].texture;
        window_.draw_picture(state_.sides[0].texture.get(), state_.shown, { 0, has_b ? columns : width });
        if (has_b)
            window_.draw_picture(state_.sides[1].texture.get(), state_.shown, { columns, width });
        draw_overlay(state_, size);
    } else {
        draw_loading(state_, size);
    }
    if (is_ready_ && state_.shows_panel)
        draw_panel(state_, size);
    if (dock > 0)
        draw_dock(state_, size);
    if (state_.shows_help)
        draw_help(state_, size);
    window_.end_frame();
    if (state_.must_save_window) {
        state_.must_save_window = false;
        try {
            const std::string name = next_free_name("vkpt-window-");
            OutputFile file(name);
            file.write(formats::write_png(window_.read_back()));
            file.commit();
            show_notice(state_, fmt::format("wrote {}", name));
        } catch (const std::exception& error) {
            show_notice(state_, error.what(), true);
        }
    }
}

} // namespace vkpt::client::view

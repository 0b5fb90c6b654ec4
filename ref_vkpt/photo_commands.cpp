// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/photo_commands.hpp"

#include "common/numbers.hpp"
#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/cvars_rows.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/files/new_files.hpp"
#include "ref_vkpt/files/output_folder.hpp"
#include "ref_vkpt/module.hpp"
#include "ref_vkpt/photo/photo_files.hpp"
#include "ref_vkpt/replay_commands.hpp"
#include "ref_vkpt/scene/entity_geometry.hpp"
#include "shaders/shared/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/ranges.h>
#include <vector>

namespace vkpt {

namespace {

constexpr float ray_far = 1e5f;

void say(Module& m, const std::string& message)
{
    engine::print("pt_photo: {}", message);
    m.photo.say(message);
}

// How far away the crosshair's surface is; nothing: it is the sky, or there is no image yet.
std::optional<float> measure_distance(Module& m)
{
    if (!m.view().snapshot || !m.view().snapshot->world)
        return std::nullopt;
    const PhotoCamera& camera = m.photo.camera();
    TracedRay ray {};
    ray.origin = camera.eye;
    ray.direction = angle_vectors(camera.angles).forward;
    ray.t_max = ray_far;
    TraceRequest request;
    request.ray_mask = shared::MASK_OPAQUE | shared::MASK_ALPHA_TEST;
    TracedHit hit {};
    m.queries().trace_rays({ &ray, 1 }, request, &hit);
    return hit.triangle != 0xffffffff ? std::optional(hit.t) : std::nullopt;
}

void focus_on_crosshair(Module& m)
{
    cvars::set("pt_focus", fmt::format("{:.3f}", measure_distance(m).value_or(ray_far)));
    cvars::update();
}

void step_lens(int direction)
{
    constexpr std::array widths { 0.0f, 0.5f, 1.0f, 1.5f, 2.0f, 3.0f, 4.0f, 6.0f, 8.0f, 12.0f, 16.0f, 24.0f, 32.0f };
    const float now = cvars::shader_values().pt_aperture;
    const auto* next = std::ranges::upper_bound(widths, now);
    if (direction < 0) {
        next = std::ranges::lower_bound(widths, now);
        next -= next != widths.begin();
    }
    cvars::set("pt_aperture", fmt::format("{:g}", next != widths.end() ? *next : widths.back()));
}

std::vector<std::string_view> projection_names()
{
    std::vector<std::string_view> names;
    for (std::string_view rest = find_cvar_row("pt_projection")->choices; !rest.empty();) {
        names.push_back(rest.substr(0, rest.find('|')));
        rest.remove_prefix(std::min(rest.size(), names.back().size() + 1));
    }
    return names;
}

void step_projection()
{
    const std::vector<std::string_view> names = projection_names();
    const size_t next = size_t(cvars::shader_values().pt_projection + 1) % names.size();
    cvars::set("pt_projection", std::string(names[next]));
}

void step_exposure(Module& m, float stops)
{
    constexpr float limit = 8;
    PhotoCamera camera = m.photo.camera();
    camera.exposure = std::clamp(camera.exposure + stops, -limit, limit);
    m.photo.set_camera(camera);
}

void obey_key(Module& m, PhotoKey key)
{
    constexpr float stops = 0.25f;
    switch (key) {
    case PhotoKey::brighter:
        return step_exposure(m, stops);
    case PhotoKey::darker:
        return step_exposure(m, -stops);
    case PhotoKey::wider:
        return step_lens(1);
    case PhotoKey::narrower:
        return step_lens(-1);
    case PhotoKey::focus:
        m.photo.follow_focus(false);
        return focus_on_crosshair(m);
    case PhotoKey::autofocus:
        return m.photo.follow_focus(true);
    case PhotoKey::home:
        return m.photo.go_home();
    case PhotoKey::panel:
        return m.photo.toggle_panel();
    case PhotoKey::projection:
        return step_projection();
    case PhotoKey::save:
        return m.photo.wish_for({ std::exchange(m.photo.name_for_key, {}) });
    case PhotoKey::close:
        return leave_photo_mode(m);
    default: // those that are held, and a replay's
        return obey_replay_key(m, key);
    }
}

// ---- the command

void print_help()
{
    engine::print("pt_photo: on and off; pt_photo on, off, info, home");
    for (const std::string_view line : describe_words())
        engine::print("pt_photo {}", line);
    engine::print("pt_photo focus [DISTANCE]: focuses there, or on what the crosshair shows; pt_photo focus auto: "
                  "wherever it points");
    engine::print("pt_photo aperture UNITS: the lens's diameter; 0: all is sharp");
    engine::print("pt_photo projection {}", fmt::join(projection_names(), "|"));
    engine::print("pt_photo save [NAME [SAMPLES]]: vkpt/photos/NAME.png and NAME.exr, once it has so many samples");
}

void print_state(const Module& m)
{
    const PhotoCamera& camera = m.photo.camera();
    const shared::ShaderCvars lens = cvars::shader_values();
    engine::print("pt_photo: at {:.2f} {:.2f} {:.2f}, look {:.2f} {:.2f} {:.2f}, fov {:.2f}, exposure {:.2f}, aperture "
                  "{:g}, focus {:g}{}, {}, {} samples",
        camera.eye.x, camera.eye.y, camera.eye.z, camera.angles.x, camera.angles.y, camera.angles.z, camera.fov,
        camera.exposure, lens.pt_aperture, lens.pt_focus, m.photo.follows_focus() ? " (auto)" : "",
        projection_names()[size_t(camera.projection)], m.view().accumulated_frames);
}

void set_lens(Module& m, const char* cvar, float low, float high)
{
    const auto number = parse_number<float>(engine::argument(2));
    if (!number || !(*number >= low && *number <= high))
        return engine::print("pt_photo: \"{}\" is no number from {:g} to {:g}", engine::argument(2), low, high);
    if (std::string_view(cvar) == "pt_focus")
        m.photo.follow_focus(false);
    cvars::set(cvar, fmt::format("{:g}", *number));
    cvars::update();
}

void run_focus(Module& m)
{
    if (engine::argument(2) == "auto")
        return m.photo.follow_focus(true);
    if (engine::argument_count() > 2)
        return set_lens(m, "pt_focus", 1, 100000);
    m.photo.follow_focus(false);
    focus_on_crosshair(m);
}

void run_projection()
{
    const std::vector<std::string_view> names = projection_names();
    if (std::ranges::find(names, engine::argument(2)) == names.end())
        return engine::print("pt_photo: \"{}\" is none of {}", engine::argument(2), fmt::join(names, ", "));
    cvars::set("pt_projection", std::string(engine::argument(2)));
    cvars::update();
}

void run_save(Module& m)
{
    PhotoWish wish { std::string(engine::argument(2)) };
    if (const std::string wrong = wish.name.empty() ? "" : check_new_name(wish.name); !wrong.empty())
        return say(m, wrong);
    if (engine::argument_count() > 3) {
        const auto samples = parse_number<uint32_t>(engine::argument(3));
        if (!samples || *samples < 1 || *samples > PhotoMode::max_samples)
            return say(m,
                fmt::format(
                    "\"{}\" is no number of samples from 1 to {}", engine::argument(3), PhotoMode::max_samples));
        wish.samples = *samples;
    }
    if (cvars::values().pt_photo_save != 0)
        return m.photo.wish_for(wish);
    m.photo.name_for_key = wish.name;
    say(m,
        "press Enter outside of the console to save it; the start option +set pt_photo_save 1 lets the console do it");
}

std::vector<std::string_view> arguments_from(int first)
{
    std::vector<std::string_view> arguments;
    for (int i = first; i < engine::argument_count(); i++)
        arguments.push_back(engine::argument(i));
    return arguments;
}

void obey_camera_words(Module& m, std::string_view word)
{
    PhotoCamera camera = m.photo.camera();
    const std::string wrong = obey_words(camera, word, arguments_from(2));
    if (!wrong.empty())
        return engine::print("pt_photo: {}; `pt_photo help` lists all", wrong);
    m.photo.set_camera(camera);
}

void run_word(Module& m, std::string_view word)
{
    if (word == "focus")
        return run_focus(m);
    if (word == "aperture")
        return set_lens(m, "pt_aperture", 0, 1000);
    if (word == "projection")
        return run_projection();
    if (word == "save")
        return run_save(m);
    if (word == "home")
        return m.photo.go_home();
    if (word == "info")
        return print_state(m);
    obey_camera_words(m, word);
}

// The part of the window that shows the view.
formats::Image cut_out(const formats::Image& window, const Viewpoint& view)
{
    formats::Image part { int(view.size.x), int(view.size.y), {} };
    for (int y = 0; y < part.height; y++) {
        const auto row = window.pixels.begin() + (view.origin.y + y) * window.width + view.origin.x;
        part.pixels.insert(part.pixels.end(), row, row + part.width);
    }
    return part;
}

void take_photograph(Module& m, const PhotoWish& wish, const formats::Image& image)
{
    const View& view = m.view();
    const glm::uvec2 size = view.radiance_size;
    Photograph photo { cut_out(image, view.viewpoint), int(size.x), int(size.y), {} };
    photo.radiance.resize(size_t(size.x) * size.y * 3);
    if (!m.frame.read_radiance(view, photo.radiance.data()))
        return say(m, "no photograph: there is no image yet");
    try {
        const auto files = save_photograph(
            engine::game_directory(), wish.name, photo, uint64_t(cvars::values().pt_capture_mib) * mebibyte);
        for (const std::filesystem::path& file : files)
            engine::print("pt_photo: wrote {}", file.string());
        m.photo.say(fmt::format("wrote {} and .exr", files[0].filename().string()));
    } catch (const FileError& error) {
        say(m, error.what());
    }
}

} // namespace

// Its automatic exposure starts anew, from the first image.
void enter_photo_mode(Module& m, bool by_pause)
{
    m.graphics.finish();
    m.photo.game_exposure = std::move(m.view().exposure);
    m.view().history.forget();
    m.photo.enter(by_pause);
}

void leave_photo_mode(Module& m)
{
    if (!m.photo.is_on())
        return;
    m.graphics.finish();
    View& view = m.view();
    view.exposure = std::move(m.photo.game_exposure);
    view.history.forget();
    view.is_frozen = false;
    view.accumulated_frames = 0;
    m.photo.leave();
    m.replay.reset();
    m.overlay.give_keys_to_photo(false);
}

static bool can_enter_photo_mode(const Module& m)
{
    return m.scene.world() && m.view().snapshot && !m.graphics.is_recording();
}

void run_photo_command(Module& m)
{
    const std::string_view word = engine::argument(1);
    if (word == "help")
        return print_help();
    const bool on = m.photo.is_on();
    if (word == "off" || (word.empty() && on))
        return leave_photo_mode(m);
    if (!on) {
        if (!word.empty() && word != "on")
            return engine::print("pt_photo: photo mode is off; `pt_photo` turns it on, `pt_photo help` lists all");
        if (!can_enter_photo_mode(m))
            return engine::print("pt_photo: photographs are taken in a map: start one first");
        return enter_photo_mode(m);
    }
    if (word == "on")
        return;
    if (!m.photo.has_view())
        return engine::print("pt_photo: there is no image yet: `wait` for a frame first");
    run_word(m, word);
}

// pt_photo_on_pause
static void follow_pause(Module& m)
{
    const PauseWatch::Event event = m.pause_watch.look(PhotoMode::is_game_paused(), m.overlay.engine_screen.had_keys());
    const bool begins = event == PauseWatch::Event::paused && cvars::values().pt_photo_on_pause != 0;
    if (begins && !m.photo.is_on() && can_enter_photo_mode(m))
        enter_photo_mode(m, true);
    else if (event == PauseWatch::Event::resumed && m.photo.was_entered_by_pause())
        leave_photo_mode(m);
}

void begin_photo_frame(Module& m)
{
    follow_pause(m);
    PhotoMode& photo = m.photo;
    if (!photo.is_on())
        return;
    m.overlay.give_keys_to_photo(true);
    if (!photo.has_view())
        return;
    photo.set_camera(with_projection(photo.camera(), cvars::shader_values().pt_projection));
    const PhotoInput input = m.overlay.take_photo_input();
    const auto now = PhotoMode::Clock::now();
    const float seconds = photo.pass_time(now);
    if (m.replay)
        m.replay->advance(double(seconds));
    photo.obey(input, now, seconds);
    for (const PhotoKey key : input.pressed)
        if (photo.is_on())
            obey_key(m, key);
    if (!photo.is_on())
        return;
    photo.hold_game(m.overlay.engine_screen.had_keys());
    if (cvars::shader_values().pt_aperture > 0 && !photo.is_moving(now) && !m.graphics.is_recording()
        && photo.takes_focus())
        focus_on_crosshair(m);
    photo.plan_photo(m.view().accumulated_frames);
}

void end_photo_frame(Module& m, const std::function<formats::Image()>& read_image)
{
    const auto wish = m.photo.wish();
    if (!m.photo.takes_photo() || !m.photo.has_view() || m.view().accumulated_frames < wish->samples)
        return;
    m.photo.end_wish();
    take_photograph(m, *wish, read_image());
}

} // namespace vkpt

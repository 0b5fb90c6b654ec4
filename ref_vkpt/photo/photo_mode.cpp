// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/photo/photo_mode.hpp"

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/engine/engine.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <initializer_list>
#include <utility>

namespace vkpt {

namespace {

constexpr std::chrono::milliseconds rest_after(250);
constexpr float max_frame_seconds = 0.25f; // of a camera's way in one frame

} // namespace

bool PhotoMode::is_game_paused()
{
    const engine::Cvar* paused = engine::get_cvar("paused", "0", engine::CVAR_NONE);
    return paused && paused->number != 0;
}

void PhotoMode::enter(bool by_pause)
{
    is_on_ = takes_scene_ = follows_focus_ = shows_panel_ = true;
    by_pause_ = by_pause;
    pauses_asked_for_ = frames_to_next_ = 0;
}

void PhotoMode::leave()
{
    if (is_on_)
        release_game();
    is_on_ = is_replay_ = rides_ = false;
    kept_.reset();
    end_wish();
    focused_for_.reset();
    name_for_key.clear();
    message_.clear();
}

void PhotoMode::keep(const engine::RefDef& refdef)
{
    if (kept_)
        return;
    kept_ = std::make_unique<const KeptRefDef>(refdef);
    go_home();
}

void PhotoMode::show(const engine::RefDef& refdef)
{
    rides_ |= !kept_;
    is_replay_ = takes_scene_ = true;
    kept_ = std::make_unique<const KeptRefDef>(refdef);
    if (!rides_)
        return;
    const float exposure = camera_.exposure;
    camera_ = with_projection(camera_of(refdef), camera_.projection);
    camera_.exposure = exposure;
}

void PhotoMode::go_home()
{
    set_camera(with_projection(camera_of(player_view()), camera_.projection));
    takes_scene_ |= rides_ != is_replay_;
    rides_ = is_replay_;
}

engine::RefDef PhotoMode::camera_view(VkExtent2D window) const
{
    engine::RefDef view = player_view();
    glm::ivec2 size(window.width, window.height);
    if (camera_.projection == shared::PROJECTION_EQUIRECTANGULAR) {
        size.x = std::max(std::min(size.x, 2 * size.y), 2);
        size.y = size.x / 2;
    }
    view.x = (int32_t(window.width) - size.x) / 2;
    view.y = (int32_t(window.height) - size.y) / 2;
    view.width = size.x;
    view.height = size.y;
    set_fov(view, camera_.fov, float(size.x), float(size.y));
    for (int i = 0; i < 3; i++) {
        view.view_origin[i] = camera_.eye[i];
        view.view_angles[i] = camera_.angles[i];
    }
    std::ranges::fill(view.blend, 0.0f);
    view.flags &= ~engine::RDF_UNDERWATER; // of the player's eyes
    if (rides_)
        return view;
    view.entities = kept_->seen_from_outside().data();
    view.entity_count = int32_t(kept_->seen_from_outside().size());
    return view;
}

void PhotoMode::set_camera(const PhotoCamera& camera)
{
    if (camera == camera_)
        return;
    PhotoCamera same_place = camera;
    same_place.exposure = camera_.exposure; // which needs no new image
    takes_scene_ |= !(same_place == camera_);
    rides_ &= same_place == camera_;
    camera_ = camera;
}

float PhotoMode::pass_time(Clock::time_point now)
{
    return std::min(std::chrono::duration<float>(now - std::exchange(last_time_, now)).count(), max_frame_seconds);
}

void PhotoMode::obey(const PhotoInput& input, Clock::time_point now, float seconds)
{
    PhotoCamera camera = camera_;
    if (!obey_input(camera, input, seconds))
        return;
    set_camera(camera);
    rests_from_ = now + rest_after;
}

void PhotoMode::follow_focus(bool follow)
{
    follows_focus_ = follow;
    focused_for_.reset();
}

bool PhotoMode::takes_focus()
{
    if (!follows_focus_ || focused_for_ == camera_)
        return false;
    focused_for_ = camera_;
    return true;
}

std::vector<PanelLine> PhotoMode::describe(uint32_t samples, std::vector<PanelLine> lines) const
{
    if (!is_on_ || !shows_panel_ || !kept_)
        return {};
    const CvarValues& cvars = cvars::values();
    const shared::ShaderCvars lens = cvars::shader_values();
    const std::initializer_list<PanelLine> own {
        { "photo mode", true },
        { samples < max_samples ? fmt::format("{} of {} samples", samples, max_samples)
                                : fmt::format("{} samples: done", samples) },
        { fmt::format("at {:.0f} {:.0f} {:.0f}, looks {:.0f} {:.0f} {:.0f}", camera_.eye.x, camera_.eye.y,
            camera_.eye.z, camera_.angles.x, camera_.angles.y, camera_.angles.z) },
        { camera_.projection == shared::PROJECTION_EQUIRECTANGULAR
                ? fmt::format("all around, exposure {:+.2f}", camera_.exposure)
                : fmt::format("fov {:.1f}, exposure {:+.2f}", camera_.fov, camera_.exposure) },
        { cvars.pt_projection + " projection" },
        { lens.pt_aperture > 0 ? fmt::format("lens {:.1f} wide, focus at {:.0f}{}", lens.pt_aperture, lens.pt_focus,
              follows_focus_ ? ", by the crosshair" : "")
                               : "all is sharp" },
        { "" },
        { "W A S D E Q  move, Z X roll" },
        { "shift, ctrl  faster, slower" },
        { "mouse, wheel turn, zoom" },
        { "up, down     exposure" },
        { "left, right  lens" },
        { "F or click   focus here" },
        { "G or right   focus by the crosshair" },
        { "P            projection" },
        { "Enter        saves" },
        { "home H esc   back, hide this, end" },
    };
    lines.insert(lines.end(), own);
    if (cvars.pt_accumulate != 0)
        lines.push_back({ "pt_accumulate is 1" });
    if (!message_.empty()) {
        lines.push_back({ "" });
        lines.push_back({ message_, true });
    }
    return lines;
}

// The console pauses the game while it is open, and lets it go on when it is closed; so the engine is asked once it is.
// In games of several players it does not pause.
void PhotoMode::hold_game(bool engine_has_keys)
{
    constexpr int max_pauses = 3, frames_between = 5;
    if (engine_has_keys || is_game_paused() || pauses_asked_for_ >= max_pauses || frames_to_next_-- > 0)
        return;
    engine::run_next("pause\n");
    pauses_asked_for_++;
    frames_to_next_ = frames_between;
}

void PhotoMode::release_game()
{
    if ((by_pause_ || pauses_asked_for_ > 0) && is_game_paused())
        engine::run_next("pause\n");
}

} // namespace vkpt

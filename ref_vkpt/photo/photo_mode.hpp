// SPDX-License-Identifier: GPL-2.0-or-later
// Photo mode: one view of the game is kept, a free camera looks at it, and what it sees is averaged.
#pragma once

#include "ref_vkpt/overlay/engine_screen.hpp"
#include "ref_vkpt/overlay/panel.hpp"
#include "ref_vkpt/photo/kept_refdef.hpp"
#include "ref_vkpt/photo/photo_camera.hpp"
#include "ref_vkpt/vulkan/resources.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vkpt {

// A photograph that is asked for.
struct PhotoWish {
    std::string name; // empty: the next free number
    uint32_t samples = 1; // it is taken with so many
};

class PhotoMode {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr uint32_t max_samples = 65536;

    bool is_on() const { return is_on_; }
    // The next view of the map is the one. `by_pause`: the game is paused already, and goes on when photo mode ends.
    void enter(bool by_pause);
    bool was_entered_by_pause() const { return is_on_ && by_pause_; }
    void leave();

    // ---- the view

    bool has_view() const { return kept_ != nullptr; }
    // The first one since enter(); others are not wanted.
    void keep(const engine::RefDef& refdef);
    // A replay's moment, in its place. The camera goes with the player's eyes until somebody moves it.
    void show(const engine::RefDef& refdef);
    bool rides() const { return rides_; }
    const engine::RefDef& player_view() const { return kept_->refdef(); }
    // What the camera sees of it, in the whole window; all around, as much of it as is twice as wide as high.
    engine::RefDef camera_view(VkExtent2D window) const;
    // Whether it is to be made anew, for the camera has changed or renew_scene() was called; asked once.
    bool takes_scene() { return std::exchange(takes_scene_, false); }
    void renew_scene() { takes_scene_ = true; }

    // ---- the camera

    const PhotoCamera& camera() const { return camera_; }
    void set_camera(const PhotoCamera& camera);
    void go_home();
    // Seconds since it was last called, at most a quarter of one.
    float pass_time(Clock::time_point now);
    // Keys that are held for so long, and the mouse.
    void obey(const PhotoInput& input, Clock::time_point now, float seconds);
    // While it is moved by hand, and shortly after: then the game's live image is shown.
    bool is_moving(Clock::time_point now) const { return now < rests_from_; }
    // Whether the lens is focused on what the crosshair shows; if so, whether it has yet to be, asked once a camera.
    bool follows_focus() const { return follows_focus_; }
    void follow_focus(bool follow);
    bool takes_focus();

    // ---- what is drawn over the image

    // Nothing of the engine's 2D is shown, until it draws its console or a menu.
    bool hides_2d(const EngineScreen& screen) const { return is_on_ && (takes_photo_ || !screen.is_shown()); }
    void toggle_panel() { shows_panel_ = !shows_panel_; }
    // `replay`: its lines, in front.
    std::vector<PanelLine> describe(uint32_t samples, std::vector<PanelLine> replay) const;
    void say(const std::string& message) { message_ = message; }

    // ---- photographs

    // Waits for the player's key.
    std::string name_for_key;
    std::optional<PhotoWish> wish() const { return wish_; }
    void wish_for(const PhotoWish& wish) { wish_ = wish; }
    // Whether this frame's image, in which nothing stands over the view, is to be the photograph. `samples`: of the
    // last one.
    void plan_photo(uint32_t samples) { takes_photo_ = wish_ && samples + 1 >= wish_->samples; }
    bool takes_photo() const { return takes_photo_; }
    void end_wish()
    {
        wish_.reset();
        takes_photo_ = false;
    }

    // ---- the game

    static bool is_game_paused();
    // Has the engine pause the game, as far as it does that.
    void hold_game(bool engine_has_keys);
    // The game's automatic exposure, which the camera's images leave alone.
    Buffer game_exposure;

private:
    void release_game();

    bool is_on_ = false, takes_scene_ = false, follows_focus_ = true, shows_panel_ = true;
    bool is_replay_ = false, rides_ = false, by_pause_ = false;
    std::unique_ptr<const KeptRefDef> kept_;
    PhotoCamera camera_;
    std::optional<PhotoCamera> focused_for_;
    Clock::time_point last_time_ {}, rests_from_ {};
    std::string message_;
    std::optional<PhotoWish> wish_;
    bool takes_photo_ = false;
    int pauses_asked_for_ = 0, frames_to_next_ = 0;
};

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The viewer's loop: events to state, state to requests, frames to the window.
#pragma once

#include "client/view/state.hpp"

namespace vkpt::client::view {

struct ViewerOptions {
    RenderThreadOptions render;
    Settings b; // side B's settings where they differ; any: the picture is split from the start
};

// Which picture is drawn next: A, then B while the picture is split, then the reference while there is one.
class Turns {
public:
    Side next(bool has_b, bool has_reference);

private:
    Side last_ = Side::reference;
};

class Viewer {
public:
    explicit Viewer(const ViewerOptions& options);
    // Until the user leaves. Throws what ends the renderer.
    void run();

private:
    void handle(const SDL_Event& event);
    void handle_mouse(const SDL_Event& event);
    bool is_over_picture() const;
    void move_camera();
    bool has_news(); // takes what the render thread has
    void start(SceneFacts facts);
    void take_frame(RenderedFrame frame);
    void show_side(RenderedFrame frame);
    void request_frame();
    void pass_time();
    bool is_camera_still() const;
    void draw();
    bool wants_keys() const;

    ViewerOptions options_;
    State state_;
    Window window_;
    RenderThread thread_;
    Turns turns_;
    std::optional<RenderedFrame> waiting_a_; // shown together with B's
    RenderRequest last_a_; // B's and the reference's show the same
    std::optional<RenderRequest> last_reference_;
    Clock::time_point last_move_ {}, last_camera_change_ {}, last_passing_ {};
    bool is_ready_ = false, has_picture_ = false;
    bool is_pressed_ = false, is_looking_ = false; // with the mouse on the picture
    glm::vec2 pressed_at_ { 0 };
};

} // namespace vkpt::client::view

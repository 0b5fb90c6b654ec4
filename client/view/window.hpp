// SPDX-License-Identifier: GPL-2.0-or-later
// The window: SDL's software renderer, so that it opens on any display and leaves the GPU to the module, and Dear
// ImGui.
#pragma once

#include "client/view/split.hpp"

#include <SDL.h>
#include <functional>
#include <memory>
#include <string>

namespace vkpt::client::view {

template <auto destroy> struct SdlDelete {
    template <class T> void operator()(T* object) const { destroy(object); }
};
using SdlTexture = std::unique_ptr<SDL_Texture, SdlDelete<SDL_DestroyTexture>>;

class Window {
public:
    // Throws Failure where there is no display.
    Window(const std::string& title, glm::ivec2 size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Waits for events, `seconds` at most; Dear ImGui sees each before the caller. True: there was one.
    bool wait_events(double seconds, const std::function<void(const SDL_Event&)>& handle);
    // Makes wait_events return; from any thread.
    static void wake();

    void set_title(const std::string& title);
    void toggle_full_screen();
    glm::vec2 size() const;
    // While it is on the mouse turns the camera and is not seen.
    void set_mouse_look(bool on);

    void begin_frame();
    // `columns`: of the texture, [first, second). It fills those columns' part of `area`.
    void draw_picture(SDL_Texture* picture, const Area& area, glm::ivec2 columns);
    void end_frame(); // draws the interface and shows all

    // Fills the texture, made anew where the size is another.
    void upload(SdlTexture& texture, const formats::Image& image);
    formats::Image read_back(); // what the window shows, between draw calls and end_frame's show

private:
    void make_interface();

    std::unique_ptr<SDL_Window, SdlDelete<SDL_DestroyWindow>> window_;
    std::unique_ptr<SDL_Renderer, SdlDelete<SDL_DestroyRenderer>> renderer_;
    SdlTexture font_;
    std::string title_;
};

} // namespace vkpt::client::view

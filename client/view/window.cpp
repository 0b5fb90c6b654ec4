// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/window.hpp"

#include "client/host/errors.hpp"
#include "client/view/draw_interface.hpp"
#include "client/view/theme.hpp"

#if __has_include(<backends/imgui_impl_sdl2.h>)
#include <backends/imgui_impl_sdl2.h>
#else // Dear ImGui before 1.89
#include <backends/imgui_impl_sdl.h>
#endif
#include <fmt/format.h>
#include <glm/common.hpp>
#include <imgui.h>

namespace vkpt::client::view {

namespace {

constexpr SDL_Color background { 12, 13, 15, 255 };

[[noreturn]] void fail(const char* what)
{
    throw Failure(fmt::format("{}: {}. A window needs a display (DISPLAY or WAYLAND_DISPLAY); without one use `vkpt "
                              "render`, or run this under xvfb-run",
        what, SDL_GetError()));
}

uint32_t wake_event()
{
    static const uint32_t type = SDL_RegisterEvents(1);
    return type;
}

} // namespace

Window::Window(const std::string& title, glm::ivec2 size)
    : title_(title)
{
    // Not through OpenGL, which a display may lack and which the CPU driver's wide vectors do not go with.
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
    SDL_SetHint(SDL_HINT_RENDER_SCALE_QUALITY, "linear");
    SDL_SetMainReady();
    if (SDL_Init(SDL_INIT_VIDEO) != 0)
        fail("cannot open a window");
    SDL_Rect desktop { 0, 0, size.x, size.y };
    if (SDL_GetDisplayUsableBounds(0, &desktop) == 0)
        size = glm::min(size, glm::ivec2(desktop.w, desktop.h));
    window_.reset(SDL_CreateWindow(
        title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, size.x, size.y, SDL_WINDOW_RESIZABLE));
    if (!window_)
        fail("cannot open a window");
    SDL_SetWindowMinimumSize(window_.get(), 480, 320);
    renderer_.reset(SDL_CreateRenderer(window_.get(), -1, SDL_RENDERER_SOFTWARE));
    if (!renderer_) // some displays have no plain framebuffer
        renderer_.reset(SDL_CreateRenderer(window_.get(), -1, 0));
    if (!renderer_)
        fail("cannot draw in a window");
    wake_event();
    make_interface();
}

Window::~Window()
{
    ImGui_ImplSDL2_Shutdown();
    ImGui::DestroyContext();
    font_.reset();
    renderer_.reset();
    window_.reset();
    SDL_Quit();
}

void Window::make_interface()
{
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    apply_theme();
#if IMGUI_VERSION_NUM >= 18700
    ImGui_ImplSDL2_InitForSDLRenderer(window_.get(), renderer_.get());
#else
    ImGui_ImplSDL2_InitForSDLRenderer(window_.get());
#endif
    font_.reset(make_font_texture(renderer_.get()));
    if (!font_)
        fail("cannot make the interface's font");
}

bool Window::wait_events(double seconds, const std::function<void(const SDL_Event&)>& handle)
{
    SDL_Event event;
    bool any = SDL_WaitEventTimeout(&event, std::max(int(seconds * 1000), 1)) == 1;
    if (!any)
        return false;
    do {
        ImGui_ImplSDL2_ProcessEvent(&event);
        handle(event);
    } while (SDL_PollEvent(&event) == 1);
    return true;
}

void Window::wake()
{
    SDL_Event event {};
    event.type = wake_event();
    SDL_PushEvent(&event);
}

void Window::set_title(const std::string& title)
{
    if (title == title_)
        return;
    title_ = title;
    SDL_SetWindowTitle(window_.get(), title.c_str());
}

void Window::toggle_full_screen()
{
    const bool is_full = SDL_GetWindowFlags(window_.get()) & SDL_WINDOW_FULLSCREEN_DESKTOP;
    SDL_SetWindowFullscreen(window_.get(), is_full ? 0 : SDL_WINDOW_FULLSCREEN_DESKTOP);
}

glm::vec2 Window::size() const
{
    int width = 0, height = 0;
    SDL_GetRendererOutputSize(renderer_.get(), &width, &height);
    return { float(width), float(height) };
}

void Window::set_mouse_look(bool on) { SDL_SetRelativeMouseMode(on ? SDL_TRUE : SDL_FALSE); }

void Window::begin_frame()
{
    ImGui_ImplSDL2_NewFrame();
    ImGui::NewFrame();
    SDL_RenderSetClipRect(renderer_.get(), nullptr);
    SDL_SetRenderDrawColor(renderer_.get(), background.r, background.g, background.b, 255);
    SDL_RenderClear(renderer_.get());
}

void Window::draw_picture(SDL_Texture* picture, const Area& area, glm::ivec2 columns)
{
    int width = 0, height = 0;
    if (!picture || SDL_QueryTexture(picture, nullptr, nullptr, &width, &height) != 0 || columns.x >= columns.y)
        return;
    const SDL_Rect source { columns.x, 0, columns.y - columns.x, height };
    const float scale = area.width / float(width);
    const int left = int(area.x + float(columns.x) * scale), right = int(area.x + float(columns.y) * scale);
    const SDL_Rect target { left, int(area.y), right - left, int(area.height) };
    SDL_RenderCopy(renderer_.get(), picture, &source, &target);
}

void Window::end_frame()
{
    ImGui::Render();
    draw_interface(renderer_.get(), *ImGui::GetDrawData());
    SDL_RenderPresent(renderer_.get());
}

void Window::upload(SdlTexture& texture, const formats::Image& image)
{
    int width = 0, height = 0;
    if (texture)
        SDL_QueryTexture(texture.get(), nullptr, nullptr, &width, &height);
    if (!texture || width != image.width || height != image.height) {
        texture.reset(SDL_CreateTexture(
            renderer_.get(), SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STREAMING, image.width, image.height));
        if (!texture)
            throw Failure(
                fmt::format("cannot show a picture of {} x {}: {}", image.width, image.height, SDL_GetError()));
        SDL_SetTextureBlendMode(texture.get(), SDL_BLENDMODE_NONE);
    }
    SDL_UpdateTexture(texture.get(), nullptr, image.pixels.data(), image.width * int(sizeof(formats::Rgba8)));
}

formats::Image Window::read_back()
{
    const glm::ivec2 drawn(size());
    formats::Image image { drawn.x, drawn.y, std::vector<formats::Rgba8>(size_t(drawn.x) * size_t(drawn.y)) };
    SDL_RenderReadPixels(renderer_.get(), nullptr, SDL_PIXELFORMAT_RGBA32, image.pixels.data(),
        image.width * int(sizeof(formats::Rgba8)));
    for (formats::Rgba8& pixel : image.pixels)
        pixel.a = 255;
    return image;
}

} // namespace vkpt::client::view

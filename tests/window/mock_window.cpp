// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/window/mock_window.hpp"

#include <vulkan/vulkan.h>

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <new>

namespace {

vkpt::tests::MockWindow* as_window(void* window) { return static_cast<vkpt::tests::MockWindow*>(window); }

using EventFilter = int (*)(void* context, void* event);
EventFilter event_filter = nullptr;
void* event_filter_context = nullptr;

} // namespace

#pragma GCC visibility push(default) // for dlsym
extern "C" {

int SDL_Vulkan_GetInstanceExtensions(void*, unsigned* count, const char** names)
{
    *count = 2;
    if (names) {
        names[0] = VK_KHR_SURFACE_EXTENSION_NAME;
        names[1] = VK_EXT_HEADLESS_SURFACE_EXTENSION_NAME;
    }
    return 1;
}

int SDL_Vulkan_CreateSurface(void*, VkInstance instance, VkSurfaceKHR* surface)
{
    void* loader = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_NOLOAD);
    const auto find = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(loader, "vkGetInstanceProcAddr"));
    dlclose(loader);
    const auto create = reinterpret_cast<PFN_vkCreateHeadlessSurfaceEXT>(find(instance, "vkCreateHeadlessSurfaceEXT"));
    const VkHeadlessSurfaceCreateInfoEXT info { VK_STRUCTURE_TYPE_HEADLESS_SURFACE_CREATE_INFO_EXT, nullptr, 0 };
    return create && create(instance, &info, nullptr, surface) == VK_SUCCESS;
}

void SDL_Vulkan_GetDrawableSize(void* window, int* width, int* height)
{
    *width = as_window(window)->width * as_window(window)->density;
    *height = as_window(window)->height * as_window(window)->density;
}

uint32_t SDL_GetWindowFlags(void* window) { return as_window(window)->flags; }

void SDL_SetEventFilter(EventFilter filter, void* context)
{
    event_filter = filter;
    event_filter_context = context;
}

int SDL_GetEventFilter(EventFilter* filter, void** context)
{
    *filter = event_filter;
    *context = event_filter_context;
    return event_filter != nullptr;
}

} // extern "C"
#pragma GCC visibility pop

namespace vkpt::tests {

bool send_event(std::span<const std::byte> event)
{
    std::vector<std::byte> copy(event.begin(), event.end());
    return !event_filter || event_filter(event_filter_context, copy.data()) != 0;
}

struct ModuleInWindow::Table {
    engine::Exports8 exports;
    Table() = delete;
    Table(const Table&) = delete;
    ~Table() { }
};

ModuleInWindow::ModuleInWindow(MockEngine& engine, MockWindow& window, const Settings& settings,
    const std::function<void(const engine::Exports8&)>& as_window_opens)
    : engine_(engine)
    , window_(window)
{
    for (const auto& [name, value] : Settings { { "r_mode", "-1" }, { "r_customwidth", std::to_string(window.width) },
             { "r_customheight", std::to_string(window.height) }, { "pt_validation", "1" } })
        engine.set(name, value);
    for (const auto& [name, value] : settings)
        engine.set(name, value);
    library_ = dlopen(REAL_MODULE, RTLD_NOW | RTLD_LOCAL);
    if (!library_) {
        ADD_FAILURE() << dlerror();
        return;
    }
    using GetExports = Table (*)(engine::Imports);
    const auto get = reinterpret_cast<GetExports>(dlsym(library_, "GetRefAPI"));
    table_ = new Table(get(engine.imports()));
    engine.make_window = [this, as_window_opens] {
        if (exports().prepare_for_window() < 0 || !exports().init_context(&window_))
            return false;
        if (as_window_opens)
            as_window_opens(exports());
        return true;
    };
    running_ = exports().init() != 0;
    EXPECT_TRUE(running_) << (engine.console.empty() ? "" : engine.console.back());
}

ModuleInWindow::~ModuleInWindow()
{
    shut_down();
    EXPECT_TRUE(engine_.lines_with("validation:").empty()) << engine_.lines_with("validation:").front();
    delete table_;
    if (library_)
        dlclose(library_);
}

const engine::Exports8& ModuleInWindow::exports() const { return table_->exports; }

const Extension& ModuleInWindow::extension() const
{
    return *reinterpret_cast<GetExtension>(dlsym(library_, "vkpt_extension"))(extension_version);
}

void ModuleInWindow::draw(int frames) const
{
    for (int frame = 0; frame < frames; frame++) {
        exports().begin_frame(0);
        exports().draw_fill(0, 0, window_.width * window_.density, window_.height * window_.density, 100);
        exports().end_frame();
    }
}

void ModuleInWindow::shut_down()
{
    if (running_)
        exports().shutdown();
    running_ = false;
}

} // namespace vkpt::tests

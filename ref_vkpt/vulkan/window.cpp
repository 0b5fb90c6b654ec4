// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/window.hpp"

#include "ref_vkpt/engine/engine.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace vkpt {

namespace {

constexpr uint64_t sdl_window_minimised = 0x40; // the same in SDL 2 and 3

template <class Function> Function sdl_function(const char* name)
{
    void* symbol = engine::symbol(name);
    if (!symbol)
        throw FatalError(fmt::format("the engine's SDL lacks {}: it was built without Vulkan", name));
    return reinterpret_cast<Function>(symbol);
}

bool is_sdl3() { return engine::sdl_major() >= 3; }

} // namespace

std::vector<const char*> Window::instance_extensions() const
{
    if (!window_)
        return {};
    constexpr const char* name = "SDL_Vulkan_GetInstanceExtensions";
    unsigned count = 0;
    if (is_sdl3()) {
        const char* const* names = sdl_function<const char* const* (*)(unsigned*)>(name)(&count);
        if (!names)
            throw FatalError("SDL does not support Vulkan on this display");
        return { names, names + count };
    }
    const auto get = sdl_function<int (*)(void*, unsigned*, const char**)>(name);
    if (!get(window_, &count, nullptr))
        throw FatalError("SDL does not support Vulkan on this display");
    std::vector<const char*> names(count);
    get(window_, &count, names.data());
    return names;
}

VkSurfaceKHR Window::create_surface(VkInstance instance) const
{
    constexpr const char* name = "SDL_Vulkan_CreateSurface";
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    const bool made = is_sdl3()
        ? sdl_function<bool (*)(void*, VkInstance, const void*, VkSurfaceKHR*)>(name)(
            window_, instance, nullptr, &surface)
        : sdl_function<int (*)(void*, VkInstance, VkSurfaceKHR*)>(name)(window_, instance, &surface) != 0;
    if (!made)
        throw FatalError("the window has no Vulkan surface: is the display's driver installed?");
    return surface;
}

VkExtent2D Window::drawable_size() const
{
    int width = 0, height = 0;
    if (is_sdl3())
        sdl_function<bool (*)(void*, int*, int*)>("SDL_GetWindowSizeInPixels")(window_, &width, &height);
    else
        sdl_function<void (*)(void*, int*, int*)>("SDL_Vulkan_GetDrawableSize")(window_, &width, &height);
    return { uint32_t(std::max(width, 0)), uint32_t(std::max(height, 0)) };
}

bool Window::is_minimised() const
{
    constexpr const char* name = "SDL_GetWindowFlags";
    const uint64_t flags = is_sdl3() ? sdl_function<uint64_t (*)(void*)>(name)(window_)
                                     : sdl_function<uint32_t (*)(void*)>(name)(window_);
    return (flags & sdl_window_minimised) != 0;
}

} // namespace vkpt

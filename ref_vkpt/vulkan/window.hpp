// SPDX-License-Identifier: GPL-2.0-or-later
// The engine's SDL window as Vulkan needs it. SDL 2 and 3 are called through the symbols that the engine brought along,
// so that one module serves engines built with either.
#pragma once

#include "ref_vkpt/vulkan/functions.hpp"

#include <vector>

namespace vkpt {

// SDL's window flag for Vulkan; the same in SDL 2 and 3.
inline constexpr int sdl_vulkan_window_flag = 0x10000000;

class Window {
public:
    // nullptr: no window; then there is nothing to present to.
    explicit Window(void* sdl_window)
        : window_(sdl_window)
    {
    }

    explicit operator bool() const { return window_ != nullptr; }
    // Instance extensions that the surface needs. Throws FatalError.
    std::vector<const char*> instance_extensions() const;
    VkSurfaceKHR create_surface(VkInstance instance) const;
    VkExtent2D drawable_size() const;
    bool is_minimised() const;

private:
    void* window_;
};

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// A window on a display of double density has four times the pixels that the engine asked for. A window that only the
// functions of SDL know, which the module finds in this process, and a surface without a display.
#include "ref_vkpt/extension.hpp"
#include "tests/contract/mock_engine.hpp"

#include <vulkan/vulkan.h>

#include <cstring>
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <new>

namespace {

struct Window {
    int width, height; // in the units that windows are asked for
    int density;
};
Window* as_window(void* window) { return static_cast<Window*>(window); }

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

uint32_t SDL_GetWindowFlags(void*) { return 0; }

} // extern "C"
#pragma GCC visibility pop

namespace vkpt::tests {
namespace {

struct ReturnedExports {
    engine::Exports8 table;
    ReturnedExports() = delete;
    ReturnedExports(const ReturnedExports&) = delete;
    ~ReturnedExports() { }
};
using GetExports = ReturnedExports (*)(engine::Imports);

TEST(WindowOfHighDensity, IsFilledFromTheFirstFrameOn)
{
    for (const int density : { 1, 2 }) {
        SCOPED_TRACE("density " + std::to_string(density));
        Window window { 96, 64, density };
        MockEngine engine("8.70 x86_64");
        for (const auto& [name, value] : { std::pair { "r_mode", "-1" }, { "r_customwidth", "96" },
                 { "r_customheight", "64" }, { "pt_validation", "1" } })
            engine.set(name, value);
        void* library = dlopen(REAL_MODULE, RTLD_NOW | RTLD_LOCAL);
        ASSERT_TRUE(library) << dlerror();
        {
            const auto get = reinterpret_cast<GetExports>(dlsym(library, "GetRefAPI"));
            const ReturnedExports exports(get(engine.imports()));
            const engine::Exports8& module = exports.table;
            const auto expect_size = [&] {
                int width = 0, height = 0;
                module.get_drawable_size(&width, &height);
                EXPECT_EQ(width, 96 * density);
                EXPECT_EQ(height, 64 * density);
            };
            engine.make_window = [&] {
                if (module.prepare_for_window() < 0 || !module.init_context(&window))
                    return false;
                expect_size(); // here the engine asks
                return true;
            };
            ASSERT_TRUE(module.init()) << (engine.console.empty() ? "" : engine.console.back());
            expect_size();
            for (int frame = 0; frame < 3; frame++) {
                module.begin_frame(0);
                module.draw_fill(0, 0, 96 * density, 64 * density, 100);
                module.end_frame();
            }
            expect_size();
            const auto door = reinterpret_cast<GetExtension>(dlsym(library, "vkpt_extension"));
            const ImageSize picture = door(extension_version)->frame_size();
            EXPECT_EQ(picture.width, 96 * density);
            EXPECT_EQ(picture.height, 64 * density);
            module.shutdown();
        }
        EXPECT_TRUE(engine.lines_with("validation:").empty()) << engine.lines_with("validation:").front();
        dlclose(library);
    }
}

} // namespace
} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/functions.hpp"

#include "ref_vkpt/engine/errors.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <string>

#define VKPT_DEFINE(name) PFN_##name name = nullptr;
VKPT_DEFINE(vkGetInstanceProcAddr)
VKPT_GLOBAL_FUNCTIONS(VKPT_DEFINE)
VKPT_INSTANCE_FUNCTIONS(VKPT_DEFINE)
VKPT_OPTIONAL_INSTANCE_FUNCTIONS(VKPT_DEFINE)
VKPT_DEVICE_FUNCTIONS(VKPT_DEFINE)
VKPT_OPTIONAL_DEVICE_FUNCTIONS(VKPT_DEFINE)
#undef VKPT_DEFINE

namespace vkpt {

namespace {

#ifdef __APPLE__
constexpr const char* library_names[]
    = { "libvulkan.1.dylib", "libvulkan.dylib", "/usr/local/lib/libvulkan.1.dylib", "libMoltenVK.dylib" };
constexpr const char* library_remedy = "install the Vulkan SDK or MoltenVK";
#else
constexpr const char* library_names[] = { "libvulkan.so.1", "libvulkan.so" };
constexpr const char* library_remedy = "install libvulkan1 and mesa-vulkan-drivers or your card's driver";
#endif

template <class Function> void require(Function function, const char* name)
{
    if (!function)
        throw FatalError(std::string("the Vulkan driver lacks ") + name + ": update the graphics driver");
}

} // namespace

void load_vulkan_library()
{
    if (vkGetInstanceProcAddr)
        return;
    // Never closed: drivers leave threads and exit handlers behind.
    void* library = nullptr;
    for (const char* name : library_names)
        if (!library)
            library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (!library)
        throw FatalError(
            fmt::format("no Vulkan on this machine ({} is missing): {}", library_names[0], library_remedy));
    vkGetInstanceProcAddr = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
    require(vkGetInstanceProcAddr, "vkGetInstanceProcAddr");
#define VKPT_LOAD(name)                                                                                                \
    name = reinterpret_cast<PFN_##name>(vkGetInstanceProcAddr(nullptr, #name));                                        \
    require(name, #name);
    VKPT_GLOBAL_FUNCTIONS(VKPT_LOAD)
#undef VKPT_LOAD
}

void load_instance_functions(VkInstance instance)
{
#define VKPT_LOAD(name) name = reinterpret_cast<PFN_##name>(vkGetInstanceProcAddr(instance, #name));
#define VKPT_LOAD_REQUIRED(name) VKPT_LOAD(name) require(name, #name);
    VKPT_INSTANCE_FUNCTIONS(VKPT_LOAD_REQUIRED)
    VKPT_OPTIONAL_INSTANCE_FUNCTIONS(VKPT_LOAD)
#undef VKPT_LOAD_REQUIRED
#undef VKPT_LOAD
}

void load_device_functions(VkDevice device)
{
#define VKPT_LOAD(name) name = reinterpret_cast<PFN_##name>(vkGetDeviceProcAddr(device, #name));
#define VKPT_LOAD_REQUIRED(name) VKPT_LOAD(name) require(name, #name);
    VKPT_DEVICE_FUNCTIONS(VKPT_LOAD_REQUIRED)
    VKPT_OPTIONAL_DEVICE_FUNCTIONS(VKPT_LOAD)
#undef VKPT_LOAD_REQUIRED
#undef VKPT_LOAD
}

} // namespace vkpt

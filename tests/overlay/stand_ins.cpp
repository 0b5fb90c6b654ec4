// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/overlay/stand_ins.hpp"

#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/preset_command.hpp"
#include "ref_vkpt/vulkan/shaders.hpp"

#include <string_view>
#include <vector>

namespace vkpt::tests {

std::map<std::string, std::string> stand_in_cvars;
int stand_in_sdl = 2;

namespace {

using Filter2 = int (*)(void* context, void* event);
using Filter3 = bool (*)(void* context, void* event);
Filter2 filter2 = nullptr;
Filter3 filter3 = nullptr;
void* filter_context = nullptr;

void set_filter2(Filter2 filter, void* context)
{
    filter2 = filter;
    filter_context = context;
}
void set_filter3(Filter3 filter, void* context)
{
    filter3 = filter;
    filter_context = context;
}
// There is none before ours.
int get_filter2(Filter2* filter, void** context)
{
    *filter = nullptr;
    *context = nullptr;
    return 0;
}
bool get_filter3(Filter3* filter, void** context)
{
    *filter = nullptr;
    *context = nullptr;
    return false;
}

} // namespace

bool send_to_filter(std::span<const std::byte> event)
{
    std::vector<std::byte> copy(event.begin(), event.end());
    if (stand_in_sdl >= 3)
        return !filter3 || filter3(filter_context, copy.data());
    return !filter2 || filter2(filter_context, copy.data()) != 0;
}

} // namespace vkpt::tests

namespace vkpt::engine {

void* symbol(const char* name)
{
    const bool is_sdl3 = tests::stand_in_sdl >= 3;
    if (std::string_view(name) == "SDL_SetEventFilter")
        return is_sdl3 ? reinterpret_cast<void*>(tests::set_filter3) : reinterpret_cast<void*>(tests::set_filter2);
    if (std::string_view(name) == "SDL_GetEventFilter")
        return is_sdl3 ? reinterpret_cast<void*>(tests::get_filter3) : reinterpret_cast<void*>(tests::get_filter2);
    return nullptr;
}

int sdl_major() { return tests::stand_in_sdl; }

Cvar* get_cvar(const char* name, const char* default_text, int)
{
    static Cvar cvar {};
    cvar.text = tests::stand_in_cvars.try_emplace(name, default_text).first->second.data();
    return &cvar;
}

void set_cvar(const char* name, const std::string& text) { tests::stand_in_cvars[name] = text; }

} // namespace vkpt::engine

namespace vkpt {

void apply_preset(const Preset& preset)
{
    for (const PresetSetting& setting : preset.settings)
        tests::stand_in_cvars[setting.name] = setting.value;
}

std::string_view current_preset()
{
    return match_preset([](const char* name) {
        const auto found = tests::stand_in_cvars.find(name);
        return found != tests::stand_in_cvars.end() ? found->second : std::string();
    });
}

std::span<const LightSampler> light_samplers()
{
    static constexpr LightSampler samplers[] = { { "first", 0 }, { "second", 0 } };
    return samplers;
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/presets.hpp"

#include "common/quantile.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace vkpt {

namespace {

constexpr Preset make_preset(const char* name, std::array<const char*, 8> values)
{
    constexpr std::array names { "pt_bounces", "pt_bounce_pixels", "pt_light_subset", "flt_denoiser", "flt_taa",
        "pt_render_scale", "pt_target_ms", "pt_accumulate" };
    Preset preset { name, {} };
    for (size_t i = 0; i < names.size(); i++)
        preset.settings[i] = { names[i], values[i] };
    return preset;
}

// `high` is what all of these are by default.
constexpr Preset all_presets[] = {
    make_preset("low", { "0", "quarter", "4", "asvgf", "upscale", "50", "0", "0" }),
    make_preset("medium", { "1", "quarter", "8", "asvgf", "upscale", "67", "0", "0" }),
    make_preset("high", { "1", "auto", "8", "asvgf", "upscale", "100", "0", "0" }),
    make_preset("ultra", { "2", "all", "16", "asvgf", "on", "100", "0", "0" }),
    make_preset("reference", { "4", "all", "16", "off", "off", "100", "0", "1" }),
};

double number(const char* text) { return std::atof(text); }

// The frame's time where the image shrinks as far as pt_target_ms lets it.
double time_of_smallest(const Preset& preset, double milliseconds)
{
    constexpr double smallest = 50; // percent
    const auto scale = std::ranges::find_if(
        preset.settings, [](const PresetSetting& s) { return std::string_view(s.name) == "pt_render_scale"; });
    const double share = std::min(1.0, smallest / number(scale->value));
    return milliseconds * share * share;
}

} // namespace

std::span<const Preset> presets() { return all_presets; }

const Preset* find_preset(std::string_view name)
{
    const auto* found = std::ranges::find_if(all_presets, [&](const Preset& preset) { return name == preset.name; });
    return found != std::end(all_presets) ? found : nullptr;
}

std::string_view match_preset(const std::function<std::string(const char* name)>& value)
{
    // Numbers as numbers: the engine writes 50 as 50.000000. The wanted time is the player's own, also with `auto`.
    const auto is_set = [&](const PresetSetting& setting) {
        const std::string text = value(setting.name);
        return text == setting.value || std::string_view(setting.name) == "pt_target_ms"
            || (setting.value[0] >= '0' && setting.value[0] <= '9' && number(text.c_str()) == number(setting.value));
    };
    for (const Preset& preset : all_presets)
        if (std::ranges::all_of(preset.settings, is_set))
            return preset.name;
    return "custom";
}

bool PresetMeasurement::add_frame(double now, double milliseconds)
{
    // Until then the device may have been at work on the last settings' frames, or their shaders were compiled.
    constexpr uint32_t frames_under_way = 4;
    if (is_over() || ++frames_seen_ <= frames_under_way)
        return false;
    if (!start_)
        start_ = now;
    times_.push_back(milliseconds);
    if (now - *start_ < seconds_each)
        return false;
    medians_[stage_++] = find_median(std::exchange(times_, {}));
    start_.reset();
    frames_seen_ = 0;
    return true;
}

PresetMeasurement::Answer PresetMeasurement::answer() const
{
    for (size_t i = 0; i < measured.size(); i++)
        if (medians_[i] <= wanted_)
            return { measured[i], medians_ };
    for (size_t i = 0; i < measured.size(); i++)
        if (time_of_smallest(*find_preset(measured[i]), medians_[i]) <= wanted_)
            return { measured[i], medians_ };
    return { presets().front().name, medians_ };
}

} // namespace vkpt

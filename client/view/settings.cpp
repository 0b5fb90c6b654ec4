// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/settings.hpp"

#include "ref_vkpt/cvars_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace vkpt::client::view {

namespace {

constexpr double longest_short_range = 64;

std::vector<std::string> split_choices(std::string_view text)
{
    std::vector<std::string> choices;
    while (!text.empty()) {
        const size_t end = std::min(text.find('|'), text.size());
        choices.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return choices;
}

// At once, and not the business of captures and figures, which the viewer makes itself.
bool is_live(const CvarRow& row)
{
    const std::string_view name = row.name;
    return row.owner == CvarOwner::module && row.counts == CvarCounts::at_once && !name.starts_with("pt_capture_")
        && !name.starts_with("pt_times") && !name.starts_with("pt_bench");
}

double parse(std::string_view text) { return std::strtod(std::string(text).c_str(), nullptr); }

std::string show_number(const LiveSetting& setting, double number)
{
    number = std::clamp(number, setting.lowest, setting.highest);
    return setting.kind == SettingKind::integer ? fmt::format("{}", std::lround(number))
                                                : fmt::format("{:.4g}", number);
}

// What decides how noisy a picture is, and not what it converges to.
constexpr std::string_view sampling_settings[] = { "pt_light_sampler", "pt_light_subset", "pt_light_weight",
    "pt_light_point", "pt_noise", "pt_seed", "pt_max_radiance", "pt_debug_view" };

} // namespace

bool LiveSetting::is_short() const
{
    return kind == SettingKind::choice || (kind == SettingKind::integer && highest - lowest <= longest_short_range);
}

std::vector<LiveSetting> find_live_settings(const std::vector<std::string>& light_samplers)
{
    std::vector<LiveSetting> result;
    for (const CvarRow& row : cvar_rows) {
        if (!is_live(row))
            continue;
        LiveSetting setting { row.name, row.help, row.initial, SettingKind::choice, {}, row.lowest, row.highest };
        if (row.type == CvarType::integer)
            setting.kind = SettingKind::integer;
        else if (row.type == CvarType::number)
            setting.kind = SettingKind::number;
        else
            setting.choices = setting.name == "pt_light_sampler" ? light_samplers : split_choices(row.choices);
        if (setting.kind != SettingKind::choice || !setting.choices.empty())
            result.push_back(std::move(setting));
    }
    return result;
}

const LiveSetting* find_setting(std::span<const LiveSetting> settings, std::string_view name)
{
    const auto found = std::ranges::find(settings, name, &LiveSetting::name);
    return found == settings.end() ? nullptr : &*found;
}

std::string step_value(const LiveSetting& setting, std::string_view value, int steps)
{
    if (setting.kind == SettingKind::choice) {
        const auto found = std::ranges::find(setting.choices, value);
        const int count = int(setting.choices.size());
        const int place = found == setting.choices.end() ? 0 : int(found - setting.choices.begin()) + steps;
        return setting.choices[size_t((place % count + count) % count)];
    }
    const double number = parse(value);
    if (setting.kind == SettingKind::integer)
        return show_number(setting, number + steps);
    constexpr double factor = 1.25;
    const double smallest = (setting.highest - setting.lowest) * 1e-6;
    if (setting.lowest < 0) // a scale with a zero in its middle
        return show_number(setting, number + steps * (setting.highest - setting.lowest) / 64);
    if (number < smallest)
        return show_number(setting, steps > 0 ? std::min(1.0, setting.highest) : 0);
    return show_number(setting, number * std::pow(factor, steps));
}

std::string double_value(const LiveSetting& setting, std::string_view value, int steps)
{
    return show_number(setting, std::floor(parse(value) * std::pow(2.0, steps)));
}

Settings reference_settings(const Settings& settings, std::span<const LiveSetting> live)
{
    Settings result = settings;
    for (const std::string_view name : sampling_settings)
        if (const LiveSetting* setting = find_setting(live, name))
            result[setting->name] = setting->initial;
    for (const LiveSetting& setting : live)
        if (const auto off = std::ranges::find(setting.choices, "off");
            setting.name.starts_with("flt_") && off != setting.choices.end())
            result[setting.name] = *off;
    result.insert_or_assign("pt_accumulate", fmt::format("{}", 1));
    return result;
}

} // namespace vkpt::client::view

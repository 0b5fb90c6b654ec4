// SPDX-License-Identifier: GPL-2.0-or-later
// The renderer's settings that can change while it runs, made from the table of console variables.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt::client::view {

// Values of console variables by name.
using Settings = std::map<std::string, std::string, std::less<>>;

enum class SettingKind { choice, integer, number };

struct LiveSetting {
    std::string name, help, initial;
    SettingKind kind = SettingKind::choice;
    std::vector<std::string> choices;
    double lowest = 0, highest = 0; // of numbers
    // Few enough values to go through one by one: a list, or a short range.
    bool is_short() const;
};

// light_samplers: what the module lists, for the table leaves pt_light_sampler's names to the build.
std::vector<LiveSetting> find_live_settings(const std::vector<std::string>& light_samplers);
const LiveSetting* find_setting(std::span<const LiveSetting> settings, std::string_view name);

// The value `steps` further: the next choice (round about), the next whole number, a number about a quarter larger.
// Numbers stop at their range.
std::string step_value(const LiveSetting& setting, std::string_view value, int steps);
// As step_value, but whole numbers from 1 on double and halve: lengths of subsets.
std::string double_value(const LiveSetting& setting, std::string_view value, int steps);

// Settings whose pictures, averaged for ever, are those that `settings` should give: no filters, no bias, no debug
// view.
Settings reference_settings(const Settings& settings, std::span<const LiveSetting> live);

} // namespace vkpt::client::view

// SPDX-License-Identifier: GPL-2.0-or-later
// The command pt_preset: settings for a kind of machine at once, and one that measures which they are.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

struct PresetSetting {
    const char *name, *value;
};
struct Preset {
    const char* name;
    std::array<PresetSetting, 8> settings;
};
std::span<const Preset> presets(); // the cheapest first
// nullptr: no preset of that name.
const Preset* find_preset(std::string_view name);
// The preset whose settings these are; "custom": none. `value` tells a cvar's text.
std::string_view match_preset(const std::function<std::string(const char* name)>& value);

// What `pt_preset auto` does: three presets for a second each, then the best one that takes no longer than is wanted.
class PresetMeasurement {
public:
    explicit PresetMeasurement(double wanted_milliseconds)
        : wanted_(wanted_milliseconds)
    {
    }

    static constexpr std::array measured { "ultra", "high", "medium" };
    static constexpr double seconds_each = 1;

    // The preset that the next frames are to be rendered with.
    const char* current() const { return measured[stage_]; }
    // A frame of the current preset was shown at this moment, in seconds, and had taken so long on the device. True:
    // what is to be rendered has changed, or the measurement is over.
    bool add_frame(double now, double milliseconds);
    bool is_over() const { return stage_ == measured.size(); }

    struct Answer {
        const char* preset;
        std::array<double, measured.size()> milliseconds; // of each measured preset
    };
    Answer answer() const; // when it is over

private:
    double wanted_;
    size_t stage_ = 0;
    std::optional<double> start_; // of the stage
    uint32_t frames_seen_ = 0;
    std::vector<double> times_;
    std::array<double, measured.size()> medians_ {};
};

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// Presets name cvars that exist and values that these take; `auto` finds the one that a machine of given times can
// bear.
#include "ref_vkpt/cvars_rows.hpp"
#include "ref_vkpt/presets.hpp"

#include <cstdlib>
#include <gtest/gtest.h>
#include <map>

namespace vkpt::tests {
namespace {

std::map<std::string, std::string> settings_of(const Preset& preset)
{
    std::map<std::string, std::string> settings;
    for (const PresetSetting& setting : preset.settings)
        settings[setting.name] = setting.value;
    return settings;
}

TEST(Presets, SetWhatThereIs)
{
    EXPECT_EQ(presets().size(), 5u);
    for (const Preset& preset : presets())
        for (const auto& [name, value] : settings_of(preset)) {
            SCOPED_TRACE(std::string(preset.name) + ": " + name + " " + value);
            const CvarRow* row = find_cvar_row(name);
            ASSERT_TRUE(row);
            if (row->type == CvarType::text)
                EXPECT_GE(find_choice(row->choices, value), 0);
            else
                EXPECT_TRUE(std::atof(value.c_str()) >= row->lowest && std::atof(value.c_str()) <= row->highest);
        }
    EXPECT_EQ(find_preset("best"), nullptr);
}

TEST(Presets, HighIsTheDefault)
{
    for (const auto& [name, value] : settings_of(*find_preset("high")))
        EXPECT_EQ(value, find_cvar_row(name)->initial) << name;
}

TEST(Presets, AreKnownByTheirSettings)
{
    for (const Preset& preset : presets()) {
        auto settings = settings_of(preset);
        const auto value = [&](const char* name) { return settings[name]; };
        EXPECT_EQ(match_preset(value), preset.name);
        settings["pt_target_ms"] = std::string("16.667"); // the player's own
        settings["pt_render_scale"] += ".000000"; // as the engine writes it
        EXPECT_EQ(match_preset(value), preset.name);
        settings["pt_bounces"] = std::string("7");
        EXPECT_EQ(match_preset(value), "custom");
    }
}

// Frames that take what `times` says of each measured preset, until the measurement is over.
PresetMeasurement::Answer measure(const std::map<std::string, double>& times, double wanted)
{
    PresetMeasurement measurement(wanted);
    double now = 100;
    std::vector<std::string> order;
    for (int frame = 0; frame < 10000 && !measurement.is_over(); frame++) {
        const std::string preset = measurement.current();
        if (order.empty() || order.back() != preset)
            order.push_back(preset);
        // Frames of the last preset come in late, and now and then one is slow for other reasons.
        const double milliseconds = frame % 7 == 3 ? 5 * times.at(preset) : times.at(preset);
        now += milliseconds / 1000;
        measurement.add_frame(now, milliseconds);
    }
    EXPECT_TRUE(measurement.is_over());
    EXPECT_EQ(order, std::vector<std::string>({ "ultra", "high", "medium" }));
    EXPECT_GT(now - 100, PresetMeasurement::seconds_each * 3);
    EXPECT_LT(now - 100, PresetMeasurement::seconds_each * 3 + 60 * times.at("ultra") / 1000);
    return measurement.answer();
}

TEST(Presets, AutoTakesTheBestThatIsFastEnough)
{
    const std::map<std::string, double> times { { "ultra", 40 }, { "high", 16 }, { "medium", 8 } };
    EXPECT_STREQ(measure(times, 41).preset, "ultra");
    EXPECT_STREQ(measure(times, 39).preset, "high");
    EXPECT_STREQ(measure(times, 10).preset, "medium");
    EXPECT_STREQ(measure(times, 7).preset, "high") << "at half the width and height it takes 4 ms, ultra 10";
    EXPECT_STREQ(measure(times, 2).preset, "low");
    EXPECT_EQ(measure(times, 41).milliseconds, (std::array<double, 3> { 40, 16, 8 }));
}

} // namespace
} // namespace vkpt::tests

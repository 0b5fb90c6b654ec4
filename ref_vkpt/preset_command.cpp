// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/preset_command.hpp"

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/cvars_rows.hpp"
#include "ref_vkpt/engine/engine.hpp"

#include <chrono>
#include <cstdlib>
#include <fmt/format.h>

namespace vkpt {

namespace {

constexpr double default_frames_per_second = 60, max_frames_per_second = 1000;

std::string cvar_text(const char* name)
{
    const engine::Cvar* cvar = engine::get_cvar(name, find_cvar_row(name)->initial, engine::CVAR_NONE);
    return cvar && cvar->text ? cvar->text : "";
}

std::string preset_names()
{
    std::string names = "auto";
    for (const Preset& preset : presets())
        names += std::string(", ") + preset.name;
    return names;
}

} // namespace

void apply_preset(const Preset& preset)
{
    for (const PresetSetting& setting : preset.settings)
        cvars::set(setting.name, setting.value);
}

std::string_view current_preset() { return match_preset(cvar_text); }

void PresetCommand::run()
{
    const std::string name(engine::argument(1));
    if (name.empty()) {
        engine::print("pt_preset is \"{}\"; there are: {}", current_preset(), preset_names());
        return;
    }
    measurement_.reset();
    if (name == "auto") {
        begin_measurement();
        return;
    }
    const Preset* preset = find_preset(name);
    if (!preset) {
        engine::print("ref_vkpt: pt_preset \"{}\" is unknown; there are: {}", name, preset_names());
        return;
    }
    apply_preset(*preset);
}

void PresetCommand::begin_measurement()
{
    const std::string text(engine::argument(2));
    const double frames = text.empty() ? default_frames_per_second : std::atof(text.c_str());
    if (!(frames >= 1 && frames <= max_frames_per_second)) {
        engine::print("ref_vkpt: pt_preset auto takes the frames a second that are wanted, 1 to {}, not \"{}\"",
            max_frames_per_second, text);
        return;
    }
    wanted_milliseconds_ = 1000 / frames;
    measurement_.emplace(wanted_milliseconds_);
    apply_preset(*find_preset(measurement_->current()));
    engine::print("ref_vkpt: measuring frames for {:.0f} seconds",
        PresetMeasurement::seconds_each * double(PresetMeasurement::measured.size()));
}

void PresetCommand::end_measurement()
{
    const PresetMeasurement::Answer answer = measurement_->answer();
    measurement_.reset();
    apply_preset(*find_preset(answer.preset));
    cvars::set("pt_target_ms", fmt::format("{:.2f}", wanted_milliseconds_));
    std::string times;
    for (size_t i = 0; i < answer.milliseconds.size(); i++)
        times += fmt::format("{}{} {:.1f}", i ? ", " : "", PresetMeasurement::measured[i], answer.milliseconds[i]);
    engine::print("ref_vkpt: milliseconds of a frame here: {}; wanted {:.1f}: pt_preset {}, pt_target_ms {:.1f}", times,
        wanted_milliseconds_, answer.preset, wanted_milliseconds_);
}

void PresetCommand::note_frame(double milliseconds)
{
    if (!measurement_)
        return;
    const double now = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    if (!measurement_->add_frame(now, milliseconds))
        return;
    if (measurement_->is_over())
        end_measurement();
    else
        apply_preset(*find_preset(measurement_->current()));
}

} // namespace vkpt

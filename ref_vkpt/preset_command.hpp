// SPDX-License-Identifier: GPL-2.0-or-later
// The console command pt_preset.
#pragma once

#include "ref_vkpt/presets.hpp"

#include <optional>

namespace vkpt {

void apply_preset(const Preset& preset);
// The one that the settings match now, or "custom".
std::string_view current_preset();

class PresetCommand {
public:
    // With the engine's arguments: a preset's name, `auto` and perhaps the frames a second that are wanted, or nothing.
    void run();
    // A view was shown whose frame had taken so long on the device.
    void note_frame(double milliseconds);

private:
    void begin_measurement();
    void end_measurement();

    double wanted_milliseconds_ = 0;
    std::optional<PresetMeasurement> measurement_;
};

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of `vkpt report`, each with a module of its own. Throw Failure and what the module throws.
#pragma once

#include "client/options.hpp"
#include "client/report/picture_check.hpp"

#include <nlohmann/json.hpp>
#include <string>

namespace vkpt::client {

struct ReportOptions {
    ModuleOptions module;
    std::string output;
    std::string scene; // what is timed, a trace or a map
    std::string base_folder, game;
    std::vector<std::string> sizes { "1920x1080", "2560x1440" };
    double seconds = 4; // that a preset is timed for
};

using Json = nlohmann::ordered_json;

// Device, driver, ways to trace with their nanoseconds a ray, and all that the module said.
Json describe_device(const ReportOptions& options);
// "preset", "size", "frame_ms", "first_frame_seconds", "gpu_mib", "passes" (name: median in ms) ...
Json time_preset(const ReportOptions& options, const std::string& preset, const std::string& size);
// "backend", "layer": whether it is installed; "messages", "texts": the first of them.
Json validate_frames(const ReportOptions& options, const std::string& backend);
// "backend", "pictures": name, differences, "png" in base64, "is_right".
Json check_pictures(const ReportOptions& options, const std::string& backend);

// A view as the game would show it after some frames, with the default settings.
formats::Image draw_checked_view(const ReportOptions& options, const CheckedView& view, const std::string& backend);

} // namespace vkpt::client

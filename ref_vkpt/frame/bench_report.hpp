// SPDX-License-Identifier: GPL-2.0-or-later
// The times of many frames as JSON, with the keys of `vkpt bench --json` (docs/client.md).
#pragma once

#include "ref_vkpt/extension.hpp"
#include "ref_vkpt/pass_statistics.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

// What PassStatistics call the time from one frame's completion to the next one's, and what the names of the CPU's
// tasks begin with.
inline constexpr const char* whole_frame = "frame";
inline constexpr std::string_view cpu_task = "cpu ";

// What every report begins with: a file that does not is none of ours.
inline constexpr std::string_view bench_report_head = "{\n  \"schema\": ";

struct BenchFacts {
    std::string scene; // "maps/NAME.bsp"
    int width = 0, height = 0;
    double first_frame_seconds = 0; // from the module's start to the end of the first view
    std::vector<std::pair<std::string, std::string>> settings; // that are not at their default
};
// `statistics` is not empty.
std::string make_bench_report(const PassStatistics& statistics, const ModuleInfo& info, const BenchFacts& facts);

} // namespace vkpt

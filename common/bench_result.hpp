// SPDX-License-Identifier: GPL-2.0-or-later
// What a bench run found, and its JSON, which `vkpt bench --json` and the module's pt_bench_json write (docs/client.md
// has the keys).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace vkpt {

inline constexpr int bench_schema = 1;

struct TimedTask {
    std::string name;
    std::vector<float> ms; // one a frame that was timed
};

struct BenchResult {
    std::string scene; // as on the command line, or "maps/NAME.bsp"
    int width = 0, height = 0;
    std::vector<std::pair<std::string, std::string>> settings; // that are not at their default
    std::string device, driver, trace_backend;
    int frames = 0; // that were drawn; the samples are fewer, as frames and passes are timed by turns
    std::vector<float> frame_ms;
    std::vector<TimedTask> passes, cpu;
    double nearest_rays = 0, visibility_rays = 0; // a frame; 0: not counted
    double peak_rss_mib = 0, gpu_mib = 0;
    double first_frame_seconds = 0;

    double rays_per_frame() const { return nearest_rays + visibility_rays; }
    double mrays_per_second() const;
};

// Milliseconds to 1e-4: microseconds are as fine as any clock here is.
double round_time(double value);

// Without samples the length does not depend on the number of frames.
enum class BenchSamples { written, left_out };
nlohmann::ordered_json to_json(const BenchResult& result, BenchSamples samples);

} // namespace vkpt

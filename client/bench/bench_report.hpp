// SPDX-License-Identifier: GPL-2.0-or-later
// What a bench run found: as a table, as JSON (docs/client.md has the keys), and compared with another run.
#pragma once

#include "client/bench/statistics.hpp"

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace vkpt::client {

struct TimedTask {
    std::string name;
    std::vector<float> ms; // one a frame that was timed
};

struct BenchResult {
    std::string scene; // as on the command line
    int width = 0, height = 0;
    std::vector<std::pair<std::string, std::string>> settings; // that are not at their default
    std::string device, driver, trace_backend;
    int frames = 0; // that were drawn; the samples are fewer, as frames and passes are timed by turns
    std::vector<float> frame_ms;
    std::vector<TimedTask> passes, cpu;
    double nearest_rays = 0, visibility_rays = 0; // a frame
    double peak_rss_mib = 0, gpu_mib = 0;
    double first_frame_seconds = 0;

    double rays_per_frame() const { return nearest_rays + visibility_rays; }
    double mrays_per_second() const;
};

nlohmann::ordered_json to_json(const BenchResult& result);
// Throws Failure: missing, no JSON of ours, or of a newer schema.
BenchResult read_bench_json(const std::filesystem::path& path);

void print_table(const BenchResult& result);
// Both runs' medians side by side, and their ratios. `block`: see find_ratio.
void print_comparison(const BenchResult& first, const std::string& first_title, const BenchResult& second,
    const std::string& second_title, size_t block);
nlohmann::ordered_json compare_to_json(const BenchResult& first, const BenchResult& second, size_t block);

} // namespace vkpt::client

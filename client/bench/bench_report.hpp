// SPDX-License-Identifier: GPL-2.0-or-later
// What a bench run found: read from its JSON, as a table, and compared with another run.
#pragma once

#include "client/bench/statistics.hpp"
#include "common/bench_result.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace vkpt::client {

// Throws Failure: missing, no JSON of ours, or of a newer schema.
BenchResult read_bench_json(const std::filesystem::path& path);

void print_table(const BenchResult& result);
// Both runs' medians side by side, and their ratios. `block`: see find_ratio.
void print_comparison(const BenchResult& first, const std::string& first_title, const BenchResult& second,
    const std::string& second_title, size_t block);
nlohmann::ordered_json compare_to_json(const BenchResult& first, const BenchResult& second, size_t block);

} // namespace vkpt::client

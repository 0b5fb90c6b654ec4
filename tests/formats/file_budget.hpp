// SPDX-License-Identifier: GPL-2.0-or-later
// What reading a stranger's file may cost: a file of less than 1 MB no more than 512 MB and 5 s of CPU time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace vkpt::tests {

inline constexpr size_t small_file_bytes = 1000000;
inline constexpr size_t budget_bytes = size_t(512) << 20;
inline constexpr double budget_cpu_seconds = 5;

struct Cost {
    bool ended = false; // false: killed, by a fault or by the limits that protect the machine
    std::string outcome; // "read"; "refused: " and the exception's text; or how it was killed
    size_t peak_bytes = 0; // of memory that was touched, above what the process held before
    double cpu_seconds = 0;

    bool refused() const { return outcome.starts_with("refused"); }
};

// Runs `use` in a child process, which ends badly where an expectation fails there. Only exceptions derived from
// std::exception count as a refusal.
Cost measure_cost(const std::function<void()>& use);

// Expects that `use`, which reads a small file, stays within the budget; gives the cost.
Cost expect_within_budget(const std::string& what, const std::function<void()>& use);

// All of the folder's files whose names end so; expects that there are some.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, const std::string& ending);
std::vector<std::byte> file_bytes(const std::filesystem::path& path);

} // namespace vkpt::tests

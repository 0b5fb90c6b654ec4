// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace vkpt::client {

// What a trace holds; `vkpt info TRACE --json` as it stands.
nlohmann::ordered_json make_trace_info(const std::filesystem::path& path);
void print_trace_info(const nlohmann::ordered_json& info);

} // namespace vkpt::client

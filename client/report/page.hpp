// SPDX-License-Identifier: GPL-2.0-or-later
// What `vkpt report` found, for people.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace vkpt::client {

// One line for each thing that is not as it should be.
std::vector<std::string> list_problems(const nlohmann::ordered_json& report);
// A page for a browser that needs no other file.
std::string make_report_page(const nlohmann::ordered_json& report);
// The same in short, for a terminal.
std::string make_report_text(const nlohmann::ordered_json& report);

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// Work in a process of its own, so that a driver that crashes or hangs there ends only that work.
#pragma once

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>

namespace vkpt::client {

// What `work` returned; {"error": text} if it threw, crashed or took longer than `limit`. The program may have no other
// thread, and must not have loaded a module yet.
nlohmann::ordered_json run_apart(
    const std::function<nlohmann::ordered_json()>& work, std::chrono::seconds limit = std::chrono::minutes(15));

} // namespace vkpt::client

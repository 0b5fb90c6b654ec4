// SPDX-License-Identifier: GPL-2.0-or-later
// What the overlay calls, without an engine: its cvars, and an SDL that has nothing but a filter of events.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>

namespace vkpt::tests {

extern std::map<std::string, std::string> stand_in_cvars;

extern int stand_in_sdl; // 2 or 3
// Whether the engine gets the event.
bool send_to_filter(std::span<const std::byte> event);

} // namespace vkpt::tests

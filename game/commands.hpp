// SPDX-License-Identifier: GPL-2.0-or-later
// The console commands of this module.
#pragma once

#include <string_view>

namespace vkpt::game {

class Module;
struct Command;

using CommandHandler = void (*)(Module&, const Command&);
// nullptr: none of ours.
CommandHandler find_command(std::string_view name);

} // namespace vkpt::game

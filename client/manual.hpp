// SPDX-License-Identifier: GPL-2.0-or-later
// The man page and the shell completion, made from the options that the program itself has.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace vkpt::client {

std::string make_man_page(CLI::App& program);
std::string make_bash_completion(CLI::App& program);
// Options of the program that print these and end it: --man-page, --completion.
void add_manual_options(CLI::App& program);

} // namespace vkpt::client

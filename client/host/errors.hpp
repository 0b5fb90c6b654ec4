// SPDX-License-Identifier: GPL-2.0-or-later
// How a command of `vkpt` ends early; main() turns these into exit status and message.
#pragma once

#include <stdexcept>

namespace vkpt::client {

// Exit status 1. Say what, where, why and what to do.
class Failure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// Exit status 2: the command line asks for something that there is not.
class WrongUse : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "ref_vkpt/engine/contract.hpp"

namespace vkpt::client {

class Host;

// The engine's functions on behalf of the one host.
struct HostImports {
    static void bind(Host* host); // nullptr: unbind
    static engine::Imports table();
};

} // namespace vkpt::client

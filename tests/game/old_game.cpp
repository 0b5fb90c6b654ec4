// SPDX-License-Identifier: GPL-2.0-or-later
// A game library of another interface's version.
#include "game/contract.hpp"

extern "C" __attribute__((visibility("default"))) void* GetGameAPI(vkpt::game::Imports*)
{
    static vkpt::game::Exports table {};
    table.api_version = 2;
    return &table;
}

// SPDX-License-Identifier: GPL-2.0-or-later
// Console variables as the engine keeps them, for a module that takes the host for the engine.
#pragma once

#include "ref_vkpt/engine/contract.hpp"

#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace vkpt::client {

class CvarStore {
public:
    CvarStore();
    ~CvarStore();

    // Creates it where it is not yet there; an existing one keeps its value. Pointers stay valid as long as the store.
    engine::Cvar* get(std::string_view name, std::string_view default_text, int flags);
    engine::Cvar* set(std::string_view name, std::string_view text);
    // nullptr: nobody has set or asked for it.
    const engine::Cvar* find(std::string_view name) const;
    // Whether get() was called for it: a name that only set() knows means nothing to the module.
    bool was_asked_for(std::string_view name) const;

private:
    struct Entry;
    Entry& entry(std::string_view name);

    std::map<std::string, std::unique_ptr<Entry>, std::less<>> entries_;
};

} // namespace vkpt::client

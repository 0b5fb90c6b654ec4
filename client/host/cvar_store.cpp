// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/cvar_store.hpp"

#include <cstdlib>

namespace vkpt::client {

struct CvarStore::Entry {
    std::string name, text, default_text;
    bool is_set = false, was_asked_for = false;
    engine::Cvar cvar {};

    void assign(std::string_view new_text)
    {
        text = new_text;
        is_set = true;
        cvar.name = name.data();
        cvar.text = text.data();
        cvar.modified = 1;
        cvar.number = std::strtof(text.c_str(), nullptr);
    }
};

CvarStore::CvarStore() = default;
CvarStore::~CvarStore() = default;

CvarStore::Entry& CvarStore::entry(std::string_view name)
{
    auto found = entries_.find(name);
    if (found == entries_.end()) {
        found = entries_.emplace(std::string(name), std::make_unique<Entry>()).first;
        found->second->name = name;
    }
    return *found->second;
}

engine::Cvar* CvarStore::get(std::string_view name, std::string_view default_text, int flags)
{
    Entry& found = entry(name);
    if (!found.is_set)
        found.assign(default_text);
    found.was_asked_for = true;
    found.default_text = default_text;
    found.cvar.default_text = found.default_text.data();
    found.cvar.flags |= flags;
    return &found.cvar;
}

engine::Cvar* CvarStore::set(std::string_view name, std::string_view text)
{
    Entry& found = entry(name);
    found.assign(text);
    return &found.cvar;
}

const engine::Cvar* CvarStore::find(std::string_view name) const
{
    const auto found = entries_.find(name);
    return found == entries_.end() ? nullptr : &found->second->cvar;
}

bool CvarStore::was_asked_for(std::string_view name) const
{
    const auto found = entries_.find(name);
    return found != entries_.end() && found->second->was_asked_for;
}

} // namespace vkpt::client

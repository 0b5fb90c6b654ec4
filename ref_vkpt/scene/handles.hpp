// SPDX-License-Identifier: GPL-2.0-or-later
// Handles that the engine gives back. It keeps those of explosions and the like over a restart of video: they are
// addresses that a module which is gone has handed out, and must not be looked at.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vkpt {

// The element in use (registration is not 0) that a handle is the address of; nullptr: none.
template <class Element> const Element* find_handle(const void* handle, const Element* first, size_t count)
{
    const uintptr_t offset = reinterpret_cast<uintptr_t>(handle) - reinterpret_cast<uintptr_t>(first);
    if (offset % sizeof(Element) != 0 || offset / sizeof(Element) >= count)
        return nullptr;
    const Element* element = first + offset / sizeof(Element);
    return element->registration != 0 ? element : nullptr;
}

} // namespace vkpt

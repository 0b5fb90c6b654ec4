// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/formats/memory_watch.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <malloc.h>
#include <new>

namespace {

std::atomic<size_t> held { 0 }, held_peak { 0 }, held_at_reset { 0 };

void* take_or_nothing(size_t size) noexcept
{
    void* memory = std::malloc(std::max<size_t>(size, 1));
    if (!memory)
        return nullptr;
    held += malloc_usable_size(memory);
    held_peak = std::max<size_t>(held_peak, held);
    return memory;
}

void* take(size_t size)
{
    if (void* memory = take_or_nothing(size))
        return memory;
    throw std::bad_alloc();
}

void give_back(void* memory)
{
    if (!memory)
        return;
    held -= malloc_usable_size(memory);
    std::free(memory);
}

} // namespace

void* operator new(size_t size) { return take(size); }
void* operator new[](size_t size) { return take(size); }
void* operator new(size_t size, const std::nothrow_t&) noexcept { return take_or_nothing(size); }
void* operator new[](size_t size, const std::nothrow_t&) noexcept { return take_or_nothing(size); }
void operator delete(void* memory) noexcept { give_back(memory); }
void operator delete[](void* memory) noexcept { give_back(memory); }
void operator delete(void* memory, size_t) noexcept { give_back(memory); }
void operator delete[](void* memory, size_t) noexcept { give_back(memory); }

namespace vkpt::memory_watch {

void reset_peak() { held_peak = held_at_reset = held.load(); }
size_t peak() { return held_peak - held_at_reset; }

} // namespace vkpt::memory_watch

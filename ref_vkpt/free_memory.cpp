// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/free_memory.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace vkpt {

namespace {

// The size that malloc_info(3) gives in the element that begins with `element`, or 0.
uint64_t read_size(std::string_view text, std::string_view element)
{
    constexpr std::string_view attribute = "size=\"";
    const size_t begin = text.find(element);
    const size_t size = begin == text.npos ? text.npos : text.find(attribute, begin);
    return size == text.npos ? 0 : std::strtoull(text.data() + size + attribute.size(), nullptr, 10);
}

} // namespace

void give_back_free_memory()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

std::optional<HeapMemory> measure_heaps()
{
#ifdef __GLIBC__
    char* text = nullptr;
    size_t length = 0;
    FILE* stream = open_memstream(&text, &length);
    if (!stream)
        return std::nullopt;
    const bool told = malloc_info(0, stream) == 0;
    std::fclose(stream);
    const std::string all = told && text ? std::string(text, length) : "";
    std::free(text);
    // Behind those of each heap stand the sums over all of them.
    const size_t last_heap = all.rfind("</heap>");
    if (last_heap == all.npos)
        return std::nullopt;
    const std::string_view sums = std::string_view(all).substr(last_heap);
    const uint64_t held = read_size(sums, "<system type=\"current\"") + read_size(sums, "<total type=\"mmap\"");
    const uint64_t free = read_size(sums, "<total type=\"fast\"") + read_size(sums, "<total type=\"rest\"");
    return free > held ? std::nullopt : std::optional(HeapMemory { held - free, free });
#else
    return std::nullopt;
#endif
}

void FreeMemory::end_frame(const Loaded& loaded, Clock::time_point now)
{
    if (loaded != loaded_) {
        loaded_ = loaded;
        loaded_at_ = now;
        frames_ = 0;
        is_due_ = true;
    }
    if (!is_due_ || ++frames_ <= delay_frames || now - loaded_at_ < delay)
        return;
    is_due_ = false;
    giving_back_ = std::async(std::launch::async, give_back_free_memory); // tens of milliseconds
}

} // namespace vkpt

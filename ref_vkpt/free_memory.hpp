// SPDX-License-Identifier: GPL-2.0-or-later
// What levels, drivers and their compilers have freed stays with the C library, in the heaps of the threads that asked
// for it. On the CPU driver that was 230 MiB after the first frames in our map, beside 320 MiB that are used.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <optional>

namespace vkpt {

// Gives it back to the system.
void give_back_free_memory();

// Bytes that the process has asked of the C library and not freed, and those that lie free in its heaps.
struct HeapMemory {
    uint64_t used = 0, free = 0;
};
// None where the C library does not tell.
std::optional<HeapMemory> measure_heaps();

// Once what was loaded has long been in use.
class FreeMemory {
public:
    using Clock = std::chrono::steady_clock;
    struct Loaded {
        uint64_t world = 0, pipelines = 0; // other numbers: other ones
        bool operator==(const Loaded&) const = default;
    };
    static constexpr uint32_t delay_frames = 16;
    static constexpr std::chrono::seconds delay { 2 };

    // After every frame. Does not wait for what it begins; the destructor does.
    void end_frame(const Loaded& loaded, Clock::time_point now);

private:
    Loaded loaded_;
    Clock::time_point loaded_at_;
    uint32_t frames_ = 0; // since then
    bool is_due_ = false;
    std::future<void> giving_back_;
};

} // namespace vkpt

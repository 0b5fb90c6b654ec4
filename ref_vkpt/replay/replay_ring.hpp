// SPDX-License-Identifier: GPL-2.0-or-later
// The last seconds of the game as a trace in memory: what is registered, and a ring of chunks of views.
#pragma once

#include "common/trace/trace_chunk.hpp"

#include <cstddef>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace vkpt {

class ReplayRing {
public:
    struct Limits {
        float seconds = 60; // 0: nothing is kept
        size_t bytes = 32 << 20;
    };

    // Another map: all that was kept is forgotten.
    void begin_map(std::string_view map);
    // nullptr, what does not exist, is left out.
    void note_model(std::string_view name, const void* handle);
    void note_skin(std::string_view name, const void* handle);
    void note_sky(std::string_view name, float rotate, const float axis[3]);
    void end_registration();

    // A view of the map. Of a paused game, and of more than some 80 in a second, none is kept.
    void add(const engine::RefDef& refdef, const Limits& limits);
    void forget_views();

    std::string_view map() const { return map_; }
    bool is_empty() const { return chunks_.empty(); }
    float seconds() const;
    size_t bytes() const { return bytes_; } // of the views
    size_t views() const;

    // A whole file: `head`, what is registered, and all views.
    std::vector<std::byte> make_trace(std::span<const trace::Call> head);
    // By the trace's numbers; number 0 is nullptr.
    const std::vector<void*>& handles() const { return handles_; }

private:
    struct Chunk {
        std::vector<std::byte> packed; // empty: the one that is being written
        float start, end; // of the engine's clock
        uint32_t views;
    };
    void note(trace::CallKind kind, std::string_view name, const void* handle);
    uint32_t number_of(const void* handle) const;
    void keep_limits(const Limits& limits);

    std::string map_;
    std::vector<trace::Call> registration_;
    std::vector<void*> handles_ { nullptr };
    std::unordered_map<const void*, uint32_t> numbers_;
    trace::ChunkWriter writer_;
    std::deque<Chunk> chunks_;
    size_t bytes_ = 0;
};

} // namespace vkpt

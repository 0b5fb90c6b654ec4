// SPDX-License-Identifier: GPL-2.0-or-later
// Calls and views as the chunks of a trace (file_format.hpp).
#pragma once

#include "common/trace/call_codec.hpp"
#include "common/trace/file_format.hpp"
#include "common/trace/view_codec.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace vkpt::trace {

// The whole file's head.
std::vector<std::byte> make_header();
// With its ChunkHeader. `level`: of compression, 1 (fast) to 9 (small).
std::vector<std::byte> pack_chunk(uint32_t tag, std::span<const std::byte> raw, uint32_t views, int level);

class ChunkWriter {
public:
    void write(Call& call); // any but render_view
    void write(View& view); // render_view
    // It should end with the frame that is being written.
    bool is_full() const;
    // Calls so far, packed; empty: there were none. The next chunk begins.
    std::vector<std::byte> take(int level);

private:
    // What ends with a chunk.
    struct Coding {
        Encoder bytes;
        CallCodec calls;
        ViewCodec views;
        uint32_t view_count = 0;
    };
    std::unique_ptr<Coding> coding_ = std::make_unique<Coding>();
};

} // namespace vkpt::trace

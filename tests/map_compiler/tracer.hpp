// SPDX-License-Identifier: GPL-2.0-or-later
// A box moved through a compiled map's collision data, as a game does it: through the tree to leaves, to their brushes.
#pragma once

#include "formats/bsp.hpp"

#include <cstdint>

namespace vkpt::tests {

struct TraceResult {
    float fraction = 1; // of the way, 1: free
    glm::vec3 normal { 0 };
    bool starts_solid = false;
    uint32_t contents = 0; // of the brush that stops
};

struct TraceBox {
    glm::vec3 mins, maxs;
};
inline const TraceBox player_box { { -16, -16, -24 }, { 16, 16, 32 } };

TraceResult trace_box(const formats::Bsp& bsp, const TraceBox& box, glm::vec3 from, glm::vec3 to,
    uint32_t mask = formats::CONTENTS_SOLID | formats::CONTENTS_WINDOW | formats::CONTENTS_PLAYERCLIP,
    int head_node = 0);

} // namespace vkpt::tests

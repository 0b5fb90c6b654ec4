// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "ref_vkpt/scene/moving_geometry.hpp"

#include <cstdint>

namespace vkpt::fuzz {

// As a frame does it: triangles, masks, tree and the poses before, into arrays that are exactly as long as promised.
inline void write_moving(const MovingGeometry& geometry)
{
    static Workers alone(1);
    static MovingWriter writer(alone);
    const size_t count = geometry.triangle_count();
    std::vector<shared::Triangle> triangles(count);
    std::vector<uint32_t> masks(count), nodes(geometry.node_count() * bvh_node_words),
        records(count * bvh_triangle_words);
    std::vector<std::array<glm::vec3, 3>> previous(count);
    MovingTarget target;
    target.triangles = triangles.data();
    target.masks = masks.data();
    target.nodes = nodes.data();
    target.records = records.data();
    target.previous_positions = previous.data();
    writer.write(geometry, target);
}

} // namespace vkpt::fuzz

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/motion.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace vkpt {

namespace {

bool is_same_kind(const MovingThing& a, const MovingThing& b)
{
    return a.model == b.model && a.flags == b.flags && a.triangle_count == b.triangle_count;
}

// The nearest thing of the same kind that is not taken yet; count: none.
size_t find_thing(const MovingThing& thing, const std::vector<MovingThing>& before, const std::vector<bool>& taken)
{
    size_t found = before.size();
    float least = most_movement;
    for (size_t i = 0; i < before.size(); i++) {
        if (taken[i] || !is_same_kind(thing, before[i]))
            continue;
        const float distance = glm::distance(thing.origin, before[i].origin);
        if (distance < least) {
            least = distance;
            found = i;
        }
    }
    return found;
}

} // namespace

void find_previous_positions(SceneSnapshot& now, const SceneSnapshot& before)
{
    now.previous_positions.clear();
    now.previous_positions.reserve(now.triangles.size() * 3);
    for (const shared::Triangle& triangle : now.triangles)
        now.previous_positions.insert(now.previous_positions.end(), triangle.positions, triangle.positions + 3);
    std::vector<bool> taken(before.things.size());
    for (const MovingThing& thing : now.things) {
        const size_t found = find_thing(thing, before.things, taken);
        if (found == before.things.size())
            continue;
        taken[found] = true;
        for (size_t i = 0; i < thing.triangle_count; i++)
            std::copy_n(before.triangles[before.things[found].first_triangle + i].positions, 3,
                &now.previous_positions[(thing.first_triangle + i) * 3]);
    }
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/motion.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace vkpt {

namespace {

bool is_same_kind(const MovingThing& a, const MovingThing& b)
{
    return a.model == b.model && a.flags == b.flags && a.end.items - a.first.items == b.end.items - b.first.items
        && a.end.loose - a.first.loose == b.end.loose - b.first.loose;
}

// The nearest thing of the same kind that is not taken yet; count: none.
size_t find_thing(const MovingThing& thing, const std::vector<MovingThing>& before, const std::vector<bool>& taken)
{
    size_t found = before.size();
    float least = max_movement;
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

void find_previous_poses(SceneSnapshot& now, const SceneSnapshot& before)
{
    std::vector<bool> taken(before.things.size());
    for (const MovingThing& thing : now.things) {
        const size_t found = find_thing(thing, before.things, taken);
        if (found == before.things.size())
            continue;
        taken[found] = true;
        const MovingThing& old = before.things[found];
        now.moving.keep_previous(
            thing.first.items, thing.end.items - thing.first.items, before.moving, old.first.items);
        if (thing.end.loose > thing.first.loose)
            now.moving.keep_previous_loose(
                thing.first.loose, thing.end.loose - thing.first.loose, before.moving, old.first.loose);
    }
}

} // namespace vkpt

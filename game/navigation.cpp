// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/navigation.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace vkpt::game {

namespace {

constexpr float jump_height = 42; // what a jump's feet clear: 270 units/s against 800 units/s^2 is 45
constexpr float gravity = 800, full_speed = 300;
constexpr float deepest_fall = 480, harmless_fall = 180;
constexpr float steepest_ground = 0.7f; // normal's z, the engine's limit
constexpr float swim_step = 32;
constexpr float same_place = 12; // in height
constexpr float leap_lengths[] { 80, 128, 176 };
constexpr size_t max_nodes = 200'000;
const glm::vec3 up(0, 0, 1);

float level_distance(glm::vec3 a, glm::vec3 b) { return std::hypot(a.x - b.x, a.y - b.y); }

glm::vec3 to_lattice(glm::vec3 p)
{
    return { std::round(p.x / Navigation::step) * Navigation::step,
        std::round(p.y / Navigation::step) * Navigation::step, p.z };
}

} // namespace

uint64_t Navigation::key_of(glm::vec3 p)
{
    const auto part = [](float v) { return uint64_t(uint32_t(int32_t(std::lround(v / step)))); };
    return part(p.x) << 32 | part(p.y);
}

uint32_t Navigation::find_at(glm::vec3 p, float tolerance) const
{
    const auto column = by_column_.find(key_of(p));
    if (column == by_column_.end())
        return none;
    uint32_t best = none;
    float best_distance = tolerance;
    for (const uint32_t node : column->second)
        if (const float distance = std::abs(nodes_[node].position.z - p.z); distance <= best_distance) {
            best = node;
            best_distance = distance;
        }
    return best;
}

uint32_t Navigation::find_near(glm::vec3 p) const
{
    constexpr int rings = 3;
    uint32_t best = none;
    float best_distance = INFINITY;
    for (int y = -rings; y <= rings; y++)
        for (int x = -rings; x <= rings; x++) {
            const uint32_t node = find_at(p + glm::vec3(x, y, 0) * step, 40);
            if (node == none)
                continue;
            const glm::vec3 delta = nodes_[node].position - p;
            const float distance = glm::length(delta * glm::vec3(1, 1, 2));
            if (distance < best_distance) {
                best = node;
                best_distance = distance;
            }
        }
    return best;
}

std::vector<uint32_t> Navigation::find_all_near(glm::vec3 p, float distance) const
{
    std::vector<uint32_t> found;
    const int reach = int(distance / step) + 1;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++)
            if (const auto column = by_column_.find(key_of(p + glm::vec3(x, y, 0) * step)); column != by_column_.end())
                for (const uint32_t node : column->second)
                    if (glm::distance(nodes_[node].position, p) <= distance)
                        found.push_back(node);
    return found;
}

uint32_t Navigation::add(glm::vec3 p, bool swims)
{
    const uint32_t number = uint32_t(nodes_.size());
    nodes_.push_back({ p, swims, false, {} });
    by_column_[key_of(p)].push_back(number);
    to_grow_.push_back(number);
    return number;
}

uint32_t Navigation::find_or_add(const Space& space, glm::vec3 p)
{
    if (const uint32_t node = find_at(p, same_place); node != none)
        return node;
    if (space.medium(p) == Space::Medium::water)
        return add(p, true);
    // Nodes stand on the lattice where that is as good.
    for (const glm::vec3 place : { to_lattice(p), p }) {
        if (space.move(p, place).fraction < 1)
            continue;
        const Space::Hit ground = space.move(place, place - up * (2 * stair));
        if (ground.starts_solid || ground.fraction == 1 || ground.normal.z < steepest_ground)
            continue;
        const uint32_t node = find_at(ground.end, same_place);
        return node != none ? node : add(ground.end, false);
    }
    return none;
}

void Navigation::link(uint32_t from, glm::vec3 to, Way way, float extra_cost, bool swims)
{
    uint32_t node = find_at(to, same_place);
    if (node == none && nodes_.size() < max_nodes)
        node = add(to, swims);
    if (node == none || node == from || find_edge(from, node))
        return;
    const float length = glm::distance(nodes_[from].position, nodes_[node].position);
    nodes_[from].edges.push_back({ node, way, length + extra_cost });
}

const Navigation::Edge* Navigation::find_edge(uint32_t from, uint32_t to) const
{
    for (const Edge& edge : nodes_[from].edges)
        if (edge.to == to)
            return &edge;
    return nullptr;
}

// From `above` down to ground or water.
std::optional<Navigation::Way> Navigation::land(
    const Space& space, uint32_t from, glm::vec3 above, Way way, float extra_cost)
{
    const float start = nodes_[from].position.z;
    const Space::Hit ground = space.move(above, above - up * (above.z - start + deepest_fall));
    if (ground.starts_solid || ground.fraction == 1 || ground.normal.z < steepest_ground)
        return std::nullopt;
    if (space.medium(ground.end) == Space::Medium::deadly
        || space.medium(ground.end - up * 20.0f) == Space::Medium::deadly)
        return std::nullopt;
    const float depth = start - ground.end.z;
    if (space.medium(ground.end) == Space::Medium::water) {
        // One swims where the water begins, not at its bottom.
        float z = std::min(above.z, start);
        while (z > ground.end.z && space.medium({ above.x, above.y, z }) != Space::Medium::water)
            z -= 8;
        way = depth > stair ? Way::fall : way;
        link(from, { above.x, above.y, z - std::min(8.0f, z - ground.end.z) }, way, 32, true);
        return way;
    }
    if (depth > stair) {
        way = Way::fall;
        extra_cost = 16 + (depth > harmless_fall ? 8 * (depth - harmless_fall) : 0);
    }
    link(from, ground.end, way, extra_cost);
    return way;
}

std::optional<Navigation::Way> Navigation::try_level(const Space& space, uint32_t node, glm::vec3 ahead)
{
    const glm::vec3 from = nodes_[node].position + up;
    if (space.move(from, ahead + up).fraction < 1)
        return std::nullopt;
    return land(space, node, ahead + up, Way::walk, 0);
}

bool Navigation::try_step(const Space& space, uint32_t node, glm::vec3 ahead, float height, Way way)
{
    const glm::vec3 from = nodes_[node].position, raised = from + up * height;
    if (space.move(from, raised).fraction < 1 || space.move(raised, ahead + up * height).fraction < 1)
        return false;
    const Space::Hit ground = space.move(ahead + up * height, ahead - up * stair);
    if (ground.fraction == 1 || ground.normal.z < steepest_ground
        || space.medium(ground.end - up * 20.0f) == Space::Medium::deadly)
        return false;
    link(node, ground.end, way, way == Way::jump ? 60.0f : 0.0f, space.medium(ground.end) == Space::Medium::water);
    return true;
}

// Over a gap: along the arc of a running jump, to ground that is not much lower or higher.
void Navigation::try_leap(const Space& space, uint32_t node, glm::vec3 direction)
{
    const glm::vec3 from = nodes_[node].position;
    for (const float length : leap_lengths) {
        const glm::vec3 top = from + direction * (length / 2) + up * jump_height;
        const glm::vec3 ahead = to_lattice(from + direction * length);
        if (space.move(from, from + up * (jump_height / 2)).fraction < 1
            || space.move(from + up * (jump_height / 2), top).fraction < 1
            || space.move(top, ahead + up * (jump_height / 2)).fraction < 1)
            return;
        const Space::Hit ground = space.move(ahead + up * (jump_height / 2), ahead - up * 40.0f);
        if (ground.fraction == 1 || ground.starts_solid || ground.normal.z < steepest_ground
            || space.medium(ground.end) != Space::Medium::air
            || space.medium(ground.end - up * 20.0f) == Space::Medium::deadly)
            continue;
        if (find_at(ground.end, same_place) == none || length > 100)
            link(node, ground.end, Way::jump, 200);
        return;
    }
}

void Navigation::try_direction(const Space& space, uint32_t node, glm::vec3 direction)
{
    const glm::vec3 ahead = nodes_[node].position + direction * step;
    const bool is_diagonal = direction.x != 0 && direction.y != 0;
    if (const std::optional<Way> way = try_level(space, node, ahead)) {
        if (*way == Way::fall && !is_diagonal)
            try_leap(space, node, direction);
        return;
    }
    if (!try_step(space, node, ahead, stair, Way::walk))
        try_step(space, node, ahead, jump_height, Way::jump);
}

void Navigation::try_swimming(const Space& space, uint32_t node)
{
    const glm::vec3 from = nodes_[node].position;
    for (int z = -1; z <= 1; z++)
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++) {
                if (std::abs(x) + std::abs(y) + std::abs(z) != 1 && z != 0)
                    continue;
                const glm::vec3 way = glm::vec3(x, y, z) * swim_step;
                if (way == glm::vec3(0) || space.move(from, from + way).fraction < 1)
                    continue;
                if (space.medium(from + way) == Space::Medium::water)
                    link(node, from + way, Way::swim, swim_step, true);
            }
    // Out of it: up, over the rim, and down.
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            if (x || y)
                for (const float height : { 18.0f, 40.0f, 56.0f })
                    if (space.medium(from + up * 40.0f) == Space::Medium::air
                        && try_step(space, node, from + glm::vec3(x, y, 0) * swim_step, height, Way::swim))
                        break;
}

void Navigation::try_lifts(const Space& space, uint32_t node)
{
    const glm::vec3 from = nodes_[node].position;
    for (const Lift& lift : lifts_) {
        const float feet = from.z - 24 - lift.maxs.z;
        if (from.x < lift.mins.x || from.x > lift.maxs.x || from.y < lift.mins.y || from.y > lift.maxs.y || feet < -8
            || feet > 8)
            continue;
        const glm::vec3 top = from + up * lift.travel;
        if (space.move(from + up, top).fraction < 1)
            continue;
        const float seconds = lift.travel / 200 + 2;
        link(node, top, Way::ride, seconds * full_speed);
    }
}

void Navigation::grow_node(const Space& space, uint32_t node)
{
    nodes_[node].is_grown = true;
    if (nodes_[node].swims)
        try_swimming(space, node);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            if (x || y)
                try_direction(space, node, glm::vec3(x, y, 0));
    if (!nodes_[node].swims)
        try_lifts(space, node);
}

bool Navigation::grow(const Space& space, int most)
{
    for (int i = 0; i < most && next_to_grow_ < to_grow_.size(); i++)
        grow_node(space, to_grow_[next_to_grow_++]);
    return next_to_grow_ < to_grow_.size();
}

void Navigation::note_passage(uint32_t from, uint32_t to)
{
    if (from == to || find_edge(from, to))
        return;
    nodes_[from].edges.push_back(
        { to, Way::thrown, glm::distance(nodes_[from].position, nodes_[to].position) + full_speed });
}

void Navigation::block(uint32_t from, uint32_t to, uint32_t until)
{
    for (Edge& edge : nodes_[from].edges)
        if (edge.to == to)
            edge.blocked_until = until;
}

bool Navigation::is_straight_walk(glm::vec3 a, glm::vec3 b) const
{
    const float length = level_distance(a, b);
    const int samples = std::max(1, int(std::ceil(length / (step / 2))));
    float z = a.z;
    for (int i = 1; i <= samples; i++) {
        glm::vec3 p = glm::mix(a, b, float(i) / float(samples));
        p.z = z;
        const uint32_t node = find_at(p, stair);
        if (node == none || nodes_[node].swims)
            return false;
        z = nodes_[node].position.z;
    }
    return std::abs(z - b.z) < stair;
}

} // namespace vkpt::game

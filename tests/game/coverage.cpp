// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/game/coverage.hpp"

#include "formats/entities.hpp"
#include "tests/map_compiler/tracer.hpp"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>

namespace vkpt::tests {

namespace {

using formats::Bsp;

constexpr float step = 16, jump = 56, deepest_fall = 480;
constexpr uint32_t deadly = formats::CONTENTS_LAVA | formats::CONTENTS_SLIME;

using Cell = std::array<int, 3>;

Cell cell_of(glm::vec3 p)
{
    return { int(std::lround(p.x / step)), int(std::lround(p.y / step)), int(std::lround(p.z / step)) };
}

class Flood {
public:
    explicit Flood(const Bsp& bsp)
        : bsp_(bsp)
    {
    }

    void start_at(glm::vec3 p)
    {
        open_.push_back(p);
        run();
    }

    std::set<size_t> leaves;

private:
    uint32_t contents(glm::vec3 p) const { return bsp_.leaves[bsp_.find_leaf(p, bsp_.models[0].head_node)].contents; }
    bool is_free(glm::vec3 from, glm::vec3 to) const
    {
        const TraceResult hit = trace_box(bsp_, player_box, from, to);
        return hit.fraction == 1 && !hit.starts_solid;
    }

    // How high above ground; infinity: deeper than one may fall.
    float height_above_ground(glm::vec3 p, glm::vec3& ground) const
    {
        const glm::vec3 below = p - glm::vec3(0, 0, deepest_fall);
        const TraceResult hit = trace_box(bsp_, player_box, p, below);
        ground = glm::mix(p, below, hit.fraction) + glm::vec3(0, 0, 0.25f);
        return hit.fraction == 1 || hit.normal.z < 0.7f ? INFINITY : p.z - ground.z;
    }

    void visit(glm::vec3 p)
    {
        const Cell cell = cell_of(p);
        if (!seen_.emplace(cell, true).second)
            return;
        glm::vec3 ground;
        const float height = height_above_ground(p, ground);
        const bool swims = (contents(p) & formats::CONTENTS_WATER) != 0;
        if ((contents(p) & deadly) || (std::isfinite(height) && (contents(ground - glm::vec3(0, 0, 20)) & deadly)))
            return;
        if (swims)
            add_touched_leaves(bsp_, p, leaves);
        if (std::isfinite(height))
            add_touched_leaves(bsp_, ground, leaves);
        const bool may_go_on = swims || height <= jump;
        for (const glm::vec3 way : { glm::vec3(step, 0, 0), glm::vec3(-step, 0, 0), glm::vec3(0, step, 0),
                 glm::vec3(0, -step, 0), glm::vec3(0, 0, step), glm::vec3(0, 0, -step) }) {
            if ((!may_go_on || (way.z > 0 && !swims && height + step > jump)) && way.z >= 0)
                continue;
            if (!std::isfinite(height) && !swims)
                continue;
            if (is_free(p, p + way))
                open_.push_back(p + way);
            else if (way.z < 0 && std::isfinite(height) && height > 0.5f)
                open_.push_back(ground);
        }
    }

    void run()
    {
        while (!open_.empty()) {
            const glm::vec3 p = open_.back();
            open_.pop_back();
            visit(p);
        }
    }

    const Bsp& bsp_;
    std::vector<glm::vec3> open_;
    std::map<Cell, bool> seen_;
};

void walk_tree(const Bsp& bsp, int32_t node, glm::vec3 mins, glm::vec3 maxs, std::set<size_t>& leaves)
{
    if (node < 0) {
        const size_t leaf = size_t(-(node + 1));
        if (!(bsp.leaves[leaf].contents & formats::CONTENTS_SOLID))
            leaves.insert(leaf);
        return;
    }
    const formats::BspPlane& plane = bsp.planes[size_t(bsp.nodes[size_t(node)].plane)];
    const glm::vec3 centre = (mins + maxs) * 0.5f, extent = (maxs - mins) * 0.5f;
    const float distance = glm::dot(plane.normal, centre) - plane.dist;
    const float reach = glm::dot(glm::abs(plane.normal), extent);
    if (distance > -reach)
        walk_tree(bsp, bsp.nodes[size_t(node)].children[0], mins, maxs, leaves);
    if (distance < reach)
        walk_tree(bsp, bsp.nodes[size_t(node)].children[1], mins, maxs, leaves);
}

} // namespace

void add_touched_leaves(const Bsp& bsp, glm::vec3 p, std::set<size_t>& leaves)
{
    walk_tree(bsp, bsp.models[0].head_node, p + player_box.mins, p + player_box.maxs, leaves);
}

std::set<size_t> find_reachable_leaves(const Bsp& bsp)
{
    Flood flood(bsp);
    for (const formats::EntityText& entity : formats::parse_entities(bsp.entity_text, bsp.name)) {
        const std::string_view name = entity.class_name();
        const auto origin = entity.vector("origin");
        if (origin
            && (name.starts_with("info_player_") || name.starts_with("item_") || name.starts_with("weapon_")
                || name.starts_with("ammo_"))
            && name != "info_player_intermission")
            for (const float height : { 1.0f, 10.0f, 25.0f })
                if (trace_box(bsp, player_box, *origin + glm::vec3(0, 0, height), *origin + glm::vec3(0, 0, height))
                        .starts_solid
                    == false) {
                    flood.start_at(*origin + glm::vec3(0, 0, height));
                    break;
                }
    }
    return flood.leaves;
}

std::set<size_t> find_seen_leaves(const Bsp& bsp, const std::vector<glm::vec3>& way)
{
    constexpr float farthest = 120; // in a frame; more is a teleporter or a new life
    constexpr int parts = 4;
    std::set<size_t> leaves;
    for (size_t i = 0; i < way.size(); i++) {
        const bool is_move = i > 0 && glm::distance(way[i - 1], way[i]) < farthest;
        for (int part = is_move ? 1 : parts; part <= parts; part++)
            add_touched_leaves(bsp, is_move ? glm::mix(way[i - 1], way[i], float(part) / parts) : way[i], leaves);
    }
    return leaves;
}

} // namespace vkpt::tests

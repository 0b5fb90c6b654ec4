// SPDX-License-Identifier: GPL-2.0-or-later
// Walks through portals: from the entities to find leaks and the outside, and between area portals.
#include "tools/map_compiler/tree.hpp"

#include <algorithm>
#include <deque>
#include <fmt/format.h>
#include <glm/vector_relational.hpp>

namespace vkpt::tools {

using namespace formats;

namespace {

class Flood {
public:
    Flood(Tree& tree, const SourceMap& world)
        : tree_(tree)
        , world_(world)
        , entity_(tree.nodes.size(), -1)
    {
    }

    FloodResult run()
    {
        FloodResult result;
        for (Node& node : tree_.nodes)
            node.reached = 0;
        for (size_t i = 1; i < world_.source.entities.size(); i++)
            result.any_entity_inside |= start_at(int(i));
        spread();
        if (tree_.nodes[size_t(tree_.outside)].reached)
            result.leaks.push_back(trace_back());
        else if (result.any_entity_inside)
            fill();
        return result;
    }

private:
    Node& node(int index) { return tree_.nodes[size_t(index)]; }

    bool start_at(int index)
    {
        const MapEntity& entity = world_.source.entities[size_t(index)];
        const auto origin = entity.vector("origin");
        if (!origin || !entity.brushes.empty())
            return false;
        const dvec3 p = *origin + dvec3(0, 0, 1); // things stand exactly on floors
        const bool in_world
            = glm::all(glm::greaterThan(p, tree_.bounds.mins)) && glm::all(glm::lessThan(p, tree_.bounds.maxs));
        const int leaf = in_world ? tree_.find_leaf(world_.planes, p) : tree_.outside;
        if (node(leaf).contents & CONTENTS_SOLID)
            return false;
        reach(leaf, 1, index);
        return true;
    }

    void reach(int leaf, int steps, int entity)
    {
        if (node(leaf).reached)
            return;
        node(leaf).reached = steps;
        entity_[size_t(leaf)] = entity;
        queue_.push_back(leaf);
    }

    void spread()
    {
        while (!queue_.empty()) {
            const int leaf = queue_.front();
            queue_.pop_front();
            for (const int p : node(leaf).portals) {
                const Portal& portal = tree_.portals[size_t(p)];
                const int other = portal.nodes[portal.nodes[0] == leaf];
                if (!(node(other).contents & CONTENTS_SOLID))
                    reach(other, node(leaf).reached + 1, entity_[size_t(leaf)]);
            }
        }
    }

    Leak trace_back()
    {
        Leak leak;
        int leaf = tree_.outside;
        leak.entity = entity_[size_t(leaf)];
        while (node(leaf).reached > 1) {
            int nearer = leaf;
            const Portal* way = nullptr;
            for (const int p : node(leaf).portals) {
                const Portal& portal = tree_.portals[size_t(p)];
                const int other = portal.nodes[portal.nodes[0] == leaf];
                if (node(other).reached && node(other).reached < node(nearer).reached) {
                    nearer = other;
                    way = &portal;
                }
            }
            if (!way)
                break;
            leak.points.push_back(winding_centre(way->winding));
            leaf = nearer;
        }
        leak.points.push_back(world_.source.entities[size_t(leak.entity)].vector("origin").value_or(dvec3(0)));
        return leak;
    }

    void fill()
    {
        for (Node& leaf : tree_.nodes)
            if (leaf.is_leaf() && !leaf.reached && !(leaf.contents & CONTENTS_SOLID))
                leaf.contents = CONTENTS_SOLID;
    }

    Tree& tree_;
    const SourceMap& world_;
    std::vector<int> entity_;
    std::deque<int> queue_;
};

class AreaFinder {
public:
    AreaFinder(Tree& tree, const SourceMap& world)
        : tree_(tree)
        , sides_(size_t(world.area_portal_count) + 1)
    {
        for (const Brush& brush : world.models[0].brushes)
            portal_of_brush_.push_back(brush.area_portal);
    }

    AreaRecords run(const SourceMap& world, const WarningSink& warn)
    {
        int count = 0;
        for (size_t i = 0; i < tree_.nodes.size(); i++)
            if (is_open(int(i)) && node(int(i)).area == 0 && !portal_number(int(i)))
                flood(int(i), ++count);
        for (size_t i = 0; i < tree_.nodes.size(); i++)
            if (const int number = is_open(int(i)) ? portal_number(int(i)) : 0)
                node(int(i)).area = sides_[size_t(number)].empty() ? 0 : sides_[size_t(number)][0];
        return make_records(count, world, warn);
    }

private:
    Node& node(int index) { return tree_.nodes[size_t(index)]; }
    bool is_open(int index)
    {
        return index != tree_.outside && node(index).is_leaf() && !(node(index).contents & CONTENTS_SOLID);
    }

    int portal_number(int index)
    {
        if (node(index).contents & CONTENTS_AREAPORTAL)
            for (const int brush : node(index).brushes)
                if (const int number = portal_of_brush_[size_t(brush)])
                    return number;
        return 0;
    }

    void flood(int start, int area)
    {
        std::vector<int> stack { start };
        node(start).area = area;
        while (!stack.empty()) {
            const int leaf = stack.back();
            stack.pop_back();
            for (const int p : node(leaf).portals) {
                const Portal& portal = tree_.portals[size_t(p)];
                const int other = portal.nodes[portal.nodes[0] == leaf];
                if (!is_open(other))
                    continue;
                if (const int number = portal_number(other)) {
                    auto& sides = sides_[size_t(number)];
                    if (std::ranges::find(sides, area) == sides.end())
                        sides.push_back(area);
                } else if (node(other).area == 0) {
                    node(other).area = area;
                    stack.push_back(other);
                }
            }
        }
    }

    AreaRecords make_records(int count, const SourceMap& world, const WarningSink& warn)
    {
        AreaRecords records;
        records.areas.resize(size_t(count) + 1); // the engine counts areas from 1
        records.portals.push_back({}); // and portals
        for (size_t number = 1; number < sides_.size(); number++)
            if (sides_[number].size() != 2)
                warn(fmt::format("{}: func_areaportal {} touches {} areas; it must separate exactly two to be of use",
                    world.source.file, number, sides_[number].size()));
        for (int area = 1; area <= count; area++) {
            BspArea& record = records.areas[size_t(area)];
            record.first_area_portal = int(records.portals.size());
            for (size_t number = 1; number < sides_.size(); number++)
                if (sides_[number].size() == 2 && (sides_[number][0] == area || sides_[number][1] == area))
                    records.portals.push_back({ int(number), sides_[number][sides_[number][0] == area] });
            record.area_portal_count = int(records.portals.size()) - record.first_area_portal;
        }
        return records;
    }

    Tree& tree_;
    std::vector<std::vector<int>> sides_; // per area portal: the areas it touches
    std::vector<int> portal_of_brush_;
};

} // namespace

FloodResult fill_outside(Tree& tree, const SourceMap& world) { return Flood(tree, world).run(); }

AreaRecords find_areas(Tree& tree, const SourceMap& world, const WarningSink& warn)
{
    return AreaFinder(tree, world).run(world, warn);
}

} // namespace vkpt::tools

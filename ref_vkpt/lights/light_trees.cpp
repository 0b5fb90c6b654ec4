// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/light_trees.hpp"

#include "ref_vkpt/lights/light_source.hpp"
#include "ref_vkpt/lights/sampler_tables.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace vkpt {

namespace {

using shared::Emitter;
using shared::LightTreeNode;

constexpr float pi = std::numbers::pi_v<float>;

// Directions up to an angle away from an axis.
struct Cone {
    glm::vec3 axis { 0, 0, 1 };
    float angle = 0;
};

// The smallest cone that holds both.
Cone unite(const Cone& a, const Cone& b)
{
    const Cone &wide = a.angle >= b.angle ? a : b, &narrow = a.angle >= b.angle ? b : a;
    const float between = std::acos(std::clamp(glm::dot(wide.axis, narrow.axis), -1.0f, 1.0f));
    if (std::min(between + narrow.angle, pi) <= wide.angle)
        return wide;
    const float angle = 0.5f * (wide.angle + between + narrow.angle);
    const glm::vec3 turn = glm::cross(wide.axis, narrow.axis);
    if (angle >= pi || !(glm::length(turn) > 0))
        return { wide.axis, pi };
    return { glm::normalize(glm::angleAxis(angle - wide.angle, glm::normalize(turn)) * wide.axis), angle };
}

// What a number of lights lie in, and send.
struct Bound {
    glm::vec3 mins { std::numeric_limits<float>::max() }, maxs { std::numeric_limits<float>::lowest() };
    Cone cone;
    float power = 0;
    bool is_empty = true;

    void add(const Bound& other)
    {
        mins = glm::min(mins, other.mins);
        maxs = glm::max(maxs, other.maxs);
        cone = is_empty ? other.cone : unite(cone, other.cone);
        power += other.power;
        is_empty = false;
    }
};

Bound bound_emitter(const Emitter& e)
{
    const LightSource source = make_light_source(e);
    Bound bound;
    bound.power = source.power;
    bound.is_empty = false;
    if (is_sphere(e)) {
        bound.mins = e.p0 - e.p1.x;
        bound.maxs = e.p0 + e.p1.x;
    } else {
        bound.mins = glm::min(e.p0, glm::min(e.p1, e.p2));
        bound.maxs = glm::max(e.p0, glm::max(e.p1, e.p2));
    }
    bound.cone = source.normal == glm::vec3(0) ? Cone { { 0, 0, 1 }, pi } : Cone { source.normal, 0 };
    return bound;
}

LightTreeNode make_node(const Bound& bound)
{
    // Rounding errors must not leave anything out.
    constexpr float slack = 1.0001f, slack_of_angle = 1e-3f;
    LightTreeNode node {};
    node.centre = 0.5f * (bound.mins + bound.maxs);
    node.radius = slack * 0.5f * glm::length(bound.maxs - bound.mins);
    node.axis = bound.cone.axis;
    node.cone_cosine = std::cos(std::min(bound.cone.angle + slack_of_angle, pi));
    node.power = bound.power;
    return node;
}

// For the heuristic by which a tree is divided: power times surface area. Directions would make it ten times as slow,
// and are in the nodes' bounds all the same.
struct Extent {
    glm::vec3 mins { std::numeric_limits<float>::max() }, maxs { std::numeric_limits<float>::lowest() };
    float power = 0;

    void add(const Bound& other)
    {
        mins = glm::min(mins, other.mins);
        maxs = glm::max(maxs, other.maxs);
        power += other.power;
    }
    float cost() const
    {
        const glm::vec3 size = maxs - mins;
        return power * (size.x * size.y + size.y * size.z + size.z * size.x);
    }
};

// Emitters by their rank in an order that halves space again and again, each time across its longest side.
std::vector<uint32_t> rank_in_space(const std::vector<Bound>& bounds)
{
    std::vector<uint32_t> order(bounds.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<std::span<uint32_t>> parts { order };
    while (!parts.empty()) {
        const std::span<uint32_t> part = parts.back();
        parts.pop_back();
        if (part.size() < 2)
            continue;
        const auto centre = [&](uint32_t i) { return bounds[i].mins + bounds[i].maxs; }; // twice
        glm::vec3 mins = centre(part[0]), maxs = mins;
        for (const uint32_t i : part) {
            mins = glm::min(mins, centre(i));
            maxs = glm::max(maxs, centre(i));
        }
        const glm::vec3 size = maxs - mins;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const size_t half = part.size() / 2;
        std::ranges::nth_element(
            part, part.begin() + std::ptrdiff_t(half), {}, [&](uint32_t i) { return centre(i)[axis]; });
        parts.push_back(part.subspan(0, half));
        parts.push_back(part.subspan(half));
    }
    std::vector<uint32_t> ranks(order.size());
    for (size_t i = 0; i < order.size(); i++)
        ranks[order[i]] = uint32_t(i);
    return ranks;
}

// Makes one tree after the other; `bounds` and `ranks` are those of all emitters.
class TreeBuilder {
public:
    TreeBuilder(LightTrees& trees, std::span<const Emitter> emitters)
        : trees_(trees)
    {
        for (const Emitter& emitter : emitters)
            bounds_.push_back(bound_emitter(emitter));
        ranks_ = rank_in_space(bounds_);
    }

    // Fills what belongs to the static indices from `first` on.
    void append(size_t first, std::span<const uint32_t> indices)
    {
        trees_.roots.push_back(uint32_t(trees_.nodes.size()));
        if (indices.empty())
            return;
        std::vector<uint32_t> order(indices.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::sort(order, {}, [&](uint32_t place) { return ranks_[indices[place]]; });
        lights_.clear();
        for (size_t i = 0; i < order.size(); i++) {
            trees_.lights[first + i] = indices[order[i]];
            trees_.places[first + order[i]] = uint32_t(i);
            lights_.push_back(&bounds_[indices[order[i]]]);
        }
        costs_.resize(lights_.size());
        append_node(0, lights_.size());
    }

private:
    Bound append_node(size_t first, size_t end)
    {
        const size_t place = trees_.nodes.size();
        trees_.nodes.emplace_back();
        LightTreeNode node {};
        Bound bound;
        if (end - first <= shared::LIGHT_TREE_LEAF) {
            for (size_t i = first; i < end; i++)
                bound.add(*lights_[i]);
            node = make_node(bound);
        } else {
            const size_t middle = find_split(first, end);
            bound = append_node(first, middle);
            const size_t second = trees_.nodes.size() - place;
            bound.add(append_node(middle, end));
            node = make_node(bound);
            node.second = uint32_t(second);
            node.first_count = uint32_t(middle - first);
        }
        trees_.nodes[place] = node;
        return bound;
    }

    // Where both parts' costs are least, but neither part has less than a quarter: no way is longer than a few dozen
    // nodes.
    size_t find_split(size_t first, size_t end)
    {
        const size_t least = (end - first) / 4;
        Extent behind;
        for (size_t i = end; i-- > first + least;) {
            behind.add(*lights_[i]);
            costs_[i] = behind.cost();
        }
        Extent before;
        size_t best = first + (end - first) / 2;
        float best_cost = std::numeric_limits<float>::max();
        for (size_t split = first + 1; split <= end - least; split++) {
            before.add(*lights_[split - 1]);
            if (split < first + least)
                continue;
            const float cost = before.cost() + costs_[split];
            if (cost < best_cost) {
                best = split;
                best_cost = cost;
            }
        }
        return best;
    }

    LightTrees& trees_;
    std::vector<Bound> bounds_;
    std::vector<uint32_t> ranks_;
    std::vector<const Bound*> lights_; // of the tree that is made
    std::vector<float> costs_; // of what lies from a place on
};

} // namespace

LightTrees make_light_trees(std::span<const shared::LightList> lists, std::span<const uint32_t> static_indices,
    std::span<const Emitter> static_emitters)
{
    LightTrees trees;
    trees.lights.resize(static_indices.size());
    trees.places.resize(static_indices.size());
    TreeBuilder builder(trees, static_emitters);
    for (const shared::LightList& list : lists)
        builder.append(list.first_static, static_indices.subspan(list.first_static, list.static_count));
    return trees;
}

void add_light_trees(const SamplerTableSource& source, SamplerTables& tables)
{
    LightTrees trees = make_light_trees(source.lists, source.static_indices, source.emitters);
    tables.tree_nodes = std::move(trees.nodes);
    tables.tree_roots = std::move(trees.roots);
    tables.tree_places = std::move(trees.places);
    tables.tree_lights = uint32_t(tables.indices.size());
    tables.indices.insert(tables.indices.end(), trees.lights.begin(), trees.lights.end());
}

} // namespace vkpt

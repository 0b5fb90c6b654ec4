// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/light_lists.hpp"

#include "ref_vkpt/lights/cluster_finder.hpp"
#include "ref_vkpt/lights/dynamic_lights.hpp"
#include "ref_vkpt/lights/media.hpp"
#include "ref_vkpt/lights/spot_cone.hpp"
#include "ref_vkpt/lights/work_limit.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <iterator>
#include <utility>

namespace vkpt {

namespace {

using formats::Bsp;
using formats::ClusterSet;
using shared::Emitter;

// How far off their face triangles are looked up, units: first just in front of it; farther where that is inside of a
// wall (faces that the map compiler left a little inside).
constexpr float lifts[] = { 0.125f, 1, 4 };
constexpr float bounds_tolerance = 2; // leaf bounds are rounded to integers, units
// Per megabyte of the map, of which large ones need a tenth.
constexpr uint64_t max_entries = 2'000'000, max_reach_steps = 200'000'000;
constexpr size_t bytes_per_step = 16; // when sets are merged

template <class Visit> void for_each_cluster(const ClusterSet& set, Visit visit)
{
    const std::vector<uint8_t>& bytes = set.bytes();
    for (size_t byte = 0; byte < bytes.size(); byte++)
        for (unsigned bits = bytes[byte]; bits != 0; bits &= bits - 1)
            visit(byte * 8 + size_t(std::countr_zero(bits)));
}

// Of eight sets from 8 * `row` on, the bits of the clusters 8 * `column` .. + 8: a byte each.
uint64_t gather_square(const std::vector<ClusterSet>& sets, size_t row, size_t column)
{
    uint64_t square = 0;
    const size_t end = std::min(row * 8 + 8, sets.size());
    for (size_t i = row * 8; i < end; i++)
        square |= uint64_t(sets[i].bytes()[column]) << (i % 8 * 8);
    return square;
}

void spread_square(std::vector<ClusterSet>& sets, size_t row, size_t column, uint64_t square)
{
    const size_t end = std::min(row * 8 + 8, sets.size());
    for (size_t i = row * 8; i < end; i++)
        sets[i].bytes()[column] = uint8_t(square >> (i % 8 * 8));
}

// Exchanges quarters, then quarters of those, then bits (Warren, "Hacker's Delight", 7-3).
uint64_t transpose_square(uint64_t x)
{
    const auto exchange = [&](uint64_t mask, int distance) {
        const uint64_t differing = (x ^ x >> distance) & mask;
        x ^= differing ^ differing << distance;
    };
    exchange(0x00aa00aa00aa00aaull, 7);
    exchange(0x0000cccc0000ccccull, 14);
    exchange(0x00000000f0f0f0f0ull, 28);
    return x;
}

// Of two squares that face each other across the diagonal: what either says, both say.
void unite_across_diagonal(std::vector<ClusterSet>& sets, size_t row, size_t column)
{
    const uint64_t here = gather_square(sets, row, column), there = gather_square(sets, column, row);
    if ((here | there) == 0)
        return;
    spread_square(sets, row, column, here | transpose_square(there));
    spread_square(sets, column, row, there | transpose_square(here));
}

int encode_leaf(const Bsp& bsp, int32_t child)
{
    const formats::BspLeaf& leaf = bsp.leaves[size_t(-1 - child)];
    const int cluster = leaf.cluster >= 0 && leaf.cluster < bsp.cluster_count ? leaf.cluster : -1;
    return -1 - (cluster + 1 + int(medium_of_contents(leaf.contents) << shared::TREE_MEDIUM_SHIFT));
}

// The world's tree, parents before children, without what only collision needs.
std::vector<shared::BspTreeNode> compact_tree(const Bsp& bsp)
{
    const int32_t root = find_world_root(bsp);
    if (root < 0) // a single leaf: a node whose sides are the same
        return { { glm::vec3(0, 0, 1), 0, encode_leaf(bsp, root), encode_leaf(bsp, root) } };
    std::vector<shared::BspTreeNode> tree(1);
    struct Pending {
        int32_t source;
        size_t target;
    };
    std::vector<Pending> pending { { root, 0 } };
    while (!pending.empty()) {
        const Pending here = pending.back();
        pending.pop_back();
        const formats::BspNode& node = bsp.nodes[size_t(here.source)];
        int children[2];
        for (int side = 0; side < 2; side++) {
            if (node.children[side] < 0) {
                children[side] = encode_leaf(bsp, node.children[side]);
                continue;
            }
            children[side] = int(tree.size());
            pending.push_back({ node.children[side], tree.size() });
            tree.emplace_back();
        }
        const formats::BspPlane& plane = bsp.planes[size_t(node.plane)];
        tree[here.target] = { plane.normal, plane.dist, children[0], children[1] };
    }
    return tree;
}

// Whether any of the box is in front of the triangle.
bool has_in_front(const Emitter& triangle, const Bounds& box)
{
    const glm::vec3 normal = glm::cross(triangle.p1 - triangle.p0, triangle.p2 - triangle.p0);
    const glm::vec3 foremost = glm::mix(box.mins, box.maxs, glm::greaterThan(normal, glm::vec3(0)));
    return glm::dot(normal, foremost - triangle.p0) > 0;
}

// Whether any of the box may be in the spot's cone: whether the cone meets the ball around the box.
bool has_in_cone(const Emitter& spot, const Bounds& box)
{
    const glm::vec3 to_centre = 0.5f * (box.mins + box.maxs) - spot.p0;
    const float distance = glm::length(to_centre), radius = 0.5f * glm::length(box.maxs - box.mins);
    if (distance <= radius)
        return true;
    constexpr float slack = 1e-3f;
    const float off_axis = std::acos(std::clamp(glm::dot(to_centre, spot.p2) / distance, -1.0f, 1.0f));
    return off_axis - std::asin(radius / distance) <= std::acos(std::clamp(outer_cosine(spot), -1.0f, 1.0f)) + slack;
}

// Whether the same clusters list both.
bool is_same_place(const Emitter& a, const Emitter& b)
{
    return a.p0 == b.p0 && a.p1 == b.p1 && a.p2 == b.p2 && a.type == b.type && a.reach == b.reach
        && is_dark(a) == is_dark(b);
}

} // namespace

void LightLists::build(const Bsp& bsp, std::span<const shared::Emitter> static_emitters)
{
    const auto fixed = std::make_shared<Fixed>();
    fixed->bsp = &bsp;
    fixed->cluster_count = size_t(std::max(bsp.cluster_count, 0));
    fixed->static_emitter_count = static_emitters.size();
    fixed->tree = compact_tree(bsp);
    fixed->build_visibility();
    fixed->build_cluster_bounds();
    lists_ = fixed->build_static_lists(static_emitters);
    fixed_ = fixed;
    placed_.clear();
    flatten();
    update({});
}

// A compiler's PVS is meant to be symmetric but is computed for each direction: what either says is seen is listed.
void LightLists::Fixed::build_visibility()
{
    for (size_t cluster = 0; cluster < cluster_count; cluster++)
        visible_from.push_back(bsp->pvs(int(cluster)));
    // In squares of eight clusters by eight, and in tiles of such, whose sets stay in the cache.
    constexpr size_t tile = 64;
    const size_t squares = (cluster_count + 7) / 8;
    for (size_t first_row = 0; first_row < squares; first_row += tile)
        for (size_t first_column = 0; first_column <= first_row; first_column += tile)
            for (size_t row = first_row; row < std::min(first_row + tile, squares); row++)
                for (size_t column = first_column; column <= std::min(first_column + tile - 1, row); column++)
                    unite_across_diagonal(visible_from, row, column);
}

void LightLists::Fixed::build_cluster_bounds()
{
    cluster_mins.assign(cluster_count, glm::vec3(1e30f));
    cluster_maxs.assign(cluster_count, glm::vec3(-1e30f));
    for (const formats::BspLeaf& leaf : bsp->leaves) {
        if (leaf.cluster < 0 || size_t(leaf.cluster) >= cluster_count)
            continue;
        glm::vec3& mins = cluster_mins[size_t(leaf.cluster)];
        glm::vec3& maxs = cluster_maxs[size_t(leaf.cluster)];
        mins = glm::min(mins, glm::vec3(leaf.mins[0], leaf.mins[1], leaf.mins[2]) - bounds_tolerance);
        maxs = glm::max(maxs, glm::vec3(leaf.maxs[0], leaf.maxs[1], leaf.maxs[2]) + bounds_tolerance);
    }
}

std::vector<shared::LightList> LightLists::Fixed::build_static_lists(std::span<const shared::Emitter> emitters)
{
    WorkLimit entries(*bsp, max_entries, "entries in its light lists"),
        work(*bsp, max_reach_steps, "steps to find what its lights can reach");
    sky_receivers = ClusterSet(cluster_count);
    std::vector<std::vector<uint32_t>> members(cluster_count);
    ClusterSet receivers;
    for (uint32_t i = 0; i < emitters.size(); i++) {
        uint64_t steps = 0, count = 0;
        const bool found = find_receivers(emitters[i], receivers, steps);
        work.spend(std::exchange(steps, 0), "emitter", i);
        if (!found) {
            unlisted_static_count += cluster_count > 0;
            continue;
        }
        if (emitters[i].type == shared::EMITTER_SKY)
            sky_receivers.merge(receivers);
        for_each_cluster(receivers, [&](size_t cluster) {
            steps++;
            if (!reaches(emitters[i], cluster))
                return;
            members[cluster].push_back(i);
            count++;
        });
        work.spend(steps, "emitter", i);
        entries.spend(count, "emitter", i);
    }

    std::vector<shared::LightList> lists(cluster_count + 1);
    for (size_t cluster = 0; cluster < cluster_count; cluster++) {
        lists[cluster].first_static = uint32_t(static_indices.size());
        lists[cluster].static_count = uint32_t(members[cluster].size());
        static_indices.insert(static_indices.end(), members[cluster].begin(), members[cluster].end());
    }
    lists.back().first_static = uint32_t(static_indices.size());
    lists.back().static_count = uint32_t(emitters.size());
    for (uint32_t i = 0; i < emitters.size(); i++)
        static_indices.push_back(i);
    return lists;
}

bool LightLists::Fixed::find_receivers(const shared::Emitter& emitter, ClusterSet& receivers, uint64_t& steps) const
{
    if (emitter.type == shared::EMITTER_SUN) {
        receivers = sky_receivers;
        return true;
    }
    receivers = ClusterSet(cluster_count);
    for (const float lift : lifts) {
        const std::vector<int> touched = find_touched_clusters(*bsp, emitter, lift, steps);
        for (const int cluster : touched)
            receivers.merge(visible_from[size_t(cluster)]);
        steps += (touched.size() + 1) * (receivers.bytes().size() / bytes_per_step + 1);
        if (!touched.empty())
            return true;
    }
    return false;
}

bool LightLists::Fixed::reaches(const shared::Emitter& emitter, size_t cluster) const
{
    if (emitter.reach > 0) {
        const glm::vec3 nearest = glm::clamp(emitter.p0, cluster_mins[cluster], cluster_maxs[cluster]);
        const glm::vec3 offset = nearest - emitter.p0;
        if (!(glm::dot(offset, offset) <= emitter.reach * emitter.reach))
            return false;
    }
    if (has_cone(emitter))
        return has_in_cone(emitter, cluster_bounds(cluster));
    return is_sphere(emitter) || has_in_front(emitter, cluster_bounds(cluster));
}

bool LightLists::Fixed::place(Placed& placed, const Emitter& emitter, size_t most) const
{
    placed.emitter = emitter;
    placed.clusters.clear();
    if (is_dark(emitter))
        return true;
    if (most == 0)
        return false;
    ClusterSet receivers;
    uint64_t steps = 0;
    // What moves may be inside a wall for a moment, or be an effect at a wall: then it may be seen from anywhere.
    if (!find_receivers(emitter, receivers, steps))
        for (size_t cluster = 0; cluster < cluster_count; cluster++)
            receivers.insert(int(cluster));
    for_each_cluster(receivers, [&](size_t cluster) {
        if (reaches(emitter, cluster))
            placed.clusters.push_back(uint32_t(cluster));
    });
    if (placed.clusters.size() <= most)
        return true;
    placed.clusters = {};
    return false;
}

void LightLists::update(std::span<const Emitter> dynamic_emitters)
{
    previous_lengths_.clear();
    for (const shared::LightList& list : lists_)
        previous_lengths_.push_back(list.static_count + list.dynamic_count);
    previous_dynamic_count_ = placed_.size();
    changed_ = placed_.size() != dynamic_emitters.size();
    placed_.resize(dynamic_emitters.size());
    size_t room = max_dynamic_entries;
    unlisted_dynamic_count_ = 0;
    for (size_t i = 0; i < dynamic_emitters.size(); i++) {
        Placed& placed = placed_[i];
        const bool stays = is_same_place(placed.emitter, dynamic_emitters[i]), was_left_out = placed.is_left_out;
        if (!stays || was_left_out || placed.clusters.size() > room) {
            placed.is_left_out = !fixed_->place(placed, dynamic_emitters[i], room);
            changed_ |= !stays || !was_left_out || !placed.is_left_out;
        }
        unlisted_dynamic_count_ += placed.is_left_out;
        room = placed.is_left_out ? 0 : room - placed.clusters.size();
    }
    if (!changed_)
        return;
    previous_lists_ = lists_;
    std::swap(previous_dynamic_indices_, dynamic_indices_);
    flatten();
}

LightLists::Repeated LightLists::repeat() const
{
    if (!changed_)
        return { lists_, dynamic_indices_, fixed_->static_emitter_count + placed_.size() };
    Repeated result;
    result.lists = lists_;
    result.emitter_count = fixed_->static_emitter_count + std::max(placed_.size(), previous_dynamic_count_);
    for (size_t i = 0; i < lists_.size(); i++) {
        const auto before = std::span(previous_dynamic_indices_)
                                .subspan(previous_lists_[i].first_dynamic, previous_lists_[i].dynamic_count);
        const auto now = std::span(dynamic_indices_).subspan(lists_[i].first_dynamic, lists_[i].dynamic_count);
        const size_t first = result.dynamic_indices.size();
        result.dynamic_indices.insert(result.dynamic_indices.end(), before.begin(), before.end());
        std::ranges::set_difference(now, before, std::back_inserter(result.dynamic_indices));
        result.lists[i].first_dynamic = uint32_t(first);
        result.lists[i].dynamic_count = uint32_t(result.dynamic_indices.size() - first);
    }
    return result;
}

void LightLists::flatten()
{
    const uint32_t outside = uint32_t(lists_.size() - 1);
    const auto for_each_entry = [&](auto visit) {
        for (uint32_t i = 0; i < placed_.size(); i++) {
            for (const uint32_t cluster : placed_[i].clusters)
                visit(lists_[cluster], i);
            if (!is_dark(placed_[i].emitter))
                visit(lists_[outside], i);
        }
    };
    for (shared::LightList& list : lists_)
        list.dynamic_count = 0;
    for_each_entry([](shared::LightList& list, uint32_t) { list.dynamic_count++; });
    uint32_t first = 0;
    for (shared::LightList& list : lists_) {
        list.first_dynamic = first;
        first += list.dynamic_count;
        list.dynamic_count = 0; // counted again while filling
    }
    dynamic_indices_.resize(first);
    for_each_entry([&](shared::LightList& list, uint32_t i) {
        dynamic_indices_[list.first_dynamic + list.dynamic_count++] = uint32_t(fixed_->static_emitter_count + i);
    });
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/rays/binary_tree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

namespace vkpt {
namespace {

int widest_axis(glm::vec3 extent)
{
    if (extent.x >= extent.y && extent.x >= extent.z)
        return 0;
    return extent.y >= extent.z ? 1 : 2;
}

// Cost of visiting a node relative to testing one triangle.
constexpr float visit_cost = 0.3f;
constexpr int bin_count = 32;
// Trees of maps are some 40 deep. Below this, halves of equal count: boxes that shrink geometrically are split off one
// by one otherwise, which is quadratic.
constexpr uint32_t max_depth_by_area = 128;

struct Split {
    float cost = std::numeric_limits<float>::max(); // sum of half area x count over both sides
    int axis = -1;
    int last_left_bin = 0;
};

class AreaBuilder {
public:
    AreaBuilder(std::span<const Box> boxes, uint32_t max_leaf, BinaryTree& tree)
        : boxes_(boxes)
        , max_leaf_(max_leaf)
        , tree_(tree)
    {
    }

    uint32_t build(uint32_t first, uint32_t count, uint32_t depth)
    {
        Box box, centres;
        for (uint32_t i = first; i < first + count; i++) {
            const Box& one = boxes_[tree_.order[i]];
            box.add(one);
            centres.add(one.centre());
        }
        uint32_t id = uint32_t(tree_.nodes.size());
        tree_.nodes.push_back({ box, first, count });
        Split split = count > 1 && depth < max_depth_by_area ? find_split(first, count, centres) : Split {};
        float area = std::max(box.half_area(), 1e-12f);
        bool splitting_pays = split.axis >= 0 && visit_cost + split.cost / area < float(count);
        if (count <= max_leaf_ && !splitting_pays)
            return id;
        uint32_t left_count = split.axis >= 0 ? partition(first, count, centres, split) : count / 2;
        uint32_t left = build(first, left_count, depth + 1);
        uint32_t right = build(first + left_count, count - left_count, depth + 1);
        tree_.nodes[id].left = left;
        tree_.nodes[id].right = right;
        return id;
    }

private:
    struct Bin {
        Box box;
        uint32_t count = 0;
    };
    using Bins = std::array<Bin, bin_count>;

    static float bins_per_unit(const Box& centres, int axis)
    {
        return bin_count * 0.9999f / (centres.high[axis] - centres.low[axis]);
    }

    Split find_split(uint32_t first, uint32_t count, const Box& centres) const
    {
        Split best;
        for (int axis = 0; axis < 3; axis++) {
            float scale = bins_per_unit(centres, axis);
            if (!(scale < 1e30f)) // all centres on one spot
                continue;
            Bins bins;
            for (uint32_t i = first; i < first + count; i++) {
                const Box& box = boxes_[tree_.order[i]];
                Bin& bin = bins[size_t((box.centre()[axis] - centres.low[axis]) * scale)];
                bin.box.add(box);
                bin.count++;
            }
            keep_best_plane(bins, axis, best);
        }
        return best;
    }

    static void keep_best_plane(const Bins& bins, int axis, Split& best)
    {
        std::array<float, bin_count> right_cost {}; // of bins [i ..]; 0: no box there
        Box box;
        uint32_t count = 0;
        for (int i = bin_count - 1; i > 0; i--) {
            if (bins[size_t(i)].count) {
                box.add(bins[size_t(i)].box);
                count += bins[size_t(i)].count;
            }
            right_cost[size_t(i)] = count ? box.half_area() * float(count) : -1.0f;
        }
        box = {};
        count = 0;
        for (int i = 0; i + 1 < bin_count; i++) {
            if (!bins[size_t(i)].count)
                continue;
            box.add(bins[size_t(i)].box);
            count += bins[size_t(i)].count;
            float right = right_cost[size_t(i) + 1];
            float cost = box.half_area() * float(count) + right;
            if (right >= 0.0f && cost < best.cost)
                best = { cost, axis, i };
        }
    }

    uint32_t partition(uint32_t first, uint32_t count, const Box& centres, const Split& split)
    {
        float low = centres.low[split.axis], scale = bins_per_unit(centres, split.axis);
        auto begin = tree_.order.begin() + first;
        auto middle = std::partition(begin, begin + count,
            [&](uint32_t i) { return int((boxes_[i].centre()[split.axis] - low) * scale) <= split.last_left_bin; });
        return uint32_t(middle - begin);
    }

    std::span<const Box> boxes_;
    uint32_t max_leaf_;
    BinaryTree& tree_;
};

struct MortonKey {
    uint64_t code;
    uint32_t box;
};
// 16 bits an axis: over a map's 4096 units a sixteenth of a unit, so that single models still have their own order.
constexpr int morton_bits = 16;

// Spreads the low 16 bits so that two zeros follow each.
uint64_t spread_bits(uint32_t value)
{
    uint64_t x = value & 0xffffu;
    x = (x | x << 32) & 0x00ff00000000ffffull;
    x = (x | x << 16) & 0x00ff0000ff0000ffull;
    x = (x | x << 8) & 0xf00f00f00f00f00full;
    x = (x | x << 4) & 0x30c30c30c30c30c3ull;
    return (x | x << 2) & 0x9249249249249249ull;
}

void sort_by_code(std::vector<MortonKey>& keys)
{
    constexpr int digit_bits = 8, digits = morton_bits * 3 / digit_bits;
    std::array<std::array<uint32_t, 1 << digit_bits>, digits> places {};
    for (const MortonKey& key : keys)
        for (int d = 0; d < digits; d++)
            places[size_t(d)][key.code >> (d * digit_bits) & 0xff]++;
    std::vector<MortonKey> sorted(keys.size());
    for (int d = 0; d < digits; d++) {
        auto& place = places[size_t(d)];
        std::exclusive_scan(place.begin(), place.end(), place.begin(), 0u);
        for (const MortonKey& key : keys)
            sorted[place[key.code >> (d * digit_bits) & 0xff]++] = key;
        keys.swap(sorted);
    }
}

std::vector<MortonKey> morton_keys(std::span<const Box> boxes)
{
    Box centres;
    for (const Box& box : boxes)
        centres.add(box.centre());
    glm::vec3 extent = centres.high - centres.low;
    float scale = float((1 << morton_bits) - 1) / std::max({ extent.x, extent.y, extent.z, 1e-20f });
    std::vector<MortonKey> keys(boxes.size());
    for (size_t i = 0; i < boxes.size(); i++) {
        glm::vec3 cell = (boxes[i].centre() - centres.low) * scale;
        uint64_t code
            = spread_bits(uint32_t(cell.x)) << 2 | spread_bits(uint32_t(cell.y)) << 1 | spread_bits(uint32_t(cell.z));
        keys[i] = { code, uint32_t(i) };
    }
    sort_by_code(keys);
    return keys;
}

class MortonBuilder {
public:
    MortonBuilder(std::span<const Box> boxes, uint32_t max_leaf, const std::vector<MortonKey>& keys, BinaryTree& tree)
        : boxes_(boxes)
        , max_leaf_(max_leaf)
        , keys_(keys)
        , tree_(tree)
    {
    }

    uint32_t build(uint32_t first, uint32_t count)
    {
        uint32_t id = uint32_t(tree_.nodes.size());
        tree_.nodes.push_back({ {}, first, count });
        if (count <= max_leaf_) {
            for (uint32_t i = first; i < first + count; i++)
                tree_.nodes[id].box.add(boxes_[keys_[i].box]);
            return id;
        }
        uint32_t left_count = find_split(first, count);
        uint32_t left = build(first, left_count);
        uint32_t right = build(first + left_count, count - left_count);
        BinaryNode& node = tree_.nodes[id];
        node.left = left;
        node.right = right;
        node.box = tree_.nodes[left].box;
        node.box.add(tree_.nodes[right].box);
        return id;
    }

private:
    uint32_t find_split(uint32_t first, uint32_t count) const
    {
        uint64_t differing = keys_[first].code ^ keys_[first + count - 1].code;
        if (!differing)
            return count / 2;
        uint64_t bit = std::bit_floor(differing);
        auto begin = keys_.begin() + first;
        auto middle
            = std::partition_point(begin, begin + count, [&](const MortonKey& key) { return !(key.code & bit); });
        return uint32_t(middle - begin);
    }

    std::span<const Box> boxes_;
    uint32_t max_leaf_;
    const std::vector<MortonKey>& keys_;
    BinaryTree& tree_;
};

} // namespace

BinaryTree build_sah(std::span<const Box> boxes, uint32_t max_leaf)
{
    BinaryTree tree;
    if (boxes.empty())
        return tree;
    tree.order.resize(boxes.size());
    std::iota(tree.order.begin(), tree.order.end(), 0u);
    tree.nodes.reserve(boxes.size() * 2);
    AreaBuilder(boxes, max_leaf, tree).build(0, uint32_t(boxes.size()), 0);
    return tree;
}

BinaryTree build_lbvh(std::span<const Box> boxes, uint32_t max_leaf)
{
    BinaryTree tree;
    if (boxes.empty())
        return tree;
    std::vector<MortonKey> keys = morton_keys(boxes);
    tree.order.resize(boxes.size());
    std::transform(keys.begin(), keys.end(), tree.order.begin(), [](const MortonKey& key) { return key.box; });
    tree.nodes.reserve(boxes.size() * 2);
    MortonBuilder(boxes, max_leaf, keys, tree).build(0, uint32_t(boxes.size()));
    return tree;
}

void rebuild_balanced(BinaryTree& tree, uint32_t node, std::span<const Box> boxes, uint32_t max_leaf)
{
    tree.nodes[node].left = tree.nodes[node].right = 0;
    uint32_t first = tree.nodes[node].first, count = tree.nodes[node].count;
    if (count <= max_leaf)
        return;
    Box centres;
    for (uint32_t i = first; i < first + count; i++)
        centres.add(boxes[tree.order[i]].centre());
    int axis = widest_axis(centres.high - centres.low);
    auto begin = tree.order.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count,
        [&](uint32_t a, uint32_t b) { return boxes[a].centre()[axis] < boxes[b].centre()[axis]; });
    auto add_half = [&](uint32_t half_first, uint32_t half_count) {
        Box box;
        for (uint32_t i = half_first; i < half_first + half_count; i++)
            box.add(boxes[tree.order[i]]);
        uint32_t id = uint32_t(tree.nodes.size());
        tree.nodes.push_back({ box, half_first, half_count });
        return id;
    };
    uint32_t left = add_half(first, count / 2);
    uint32_t right = add_half(first + count / 2, count - count / 2);
    tree.nodes[node].left = left;
    tree.nodes[node].right = right;
    rebuild_balanced(tree, left, boxes, max_leaf);
    rebuild_balanced(tree, right, boxes, max_leaf);
}

} // namespace vkpt

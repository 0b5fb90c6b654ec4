// SPDX-License-Identifier: GPL-2.0-or-later
// Sources: Bittner, Hapala and Havran, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies", 2013; the
// search for a place with its bound: Meister and Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy
// Optimization", 2018.
#include "ref_vkpt/rays/reinsertion.hpp"

#include <algorithm>
#include <numeric>

namespace vkpt {
namespace {

// More passes gain nothing worth their time; nor do the smallest nodes, which are many.
constexpr int passes = 3;
constexpr float share_of_nodes = 0.7f;
constexpr size_t max_per_pass = 50'000; // a bound to the time for huge scenes
// Gains below this share of the parent's area are not worth a move.
constexpr float min_gain = 1e-4f;
// Nodes looked at, for each of the tree: maps need 50 to 100, slowly growing with their size. Where boxes lie in one
// another nothing prunes the search for a place, so that time would grow with the square of their number.
constexpr uint64_t max_visits_per_node = 500, min_visits = 1'000'000, max_visits = 100'000'000;
constexpr uint32_t stays = 0; // the root: nothing is put beside it

class Reinsertion {
public:
    explicit Reinsertion(BinaryTree& tree)
        : tree_(tree)
        , parents_(tree.nodes.size())
        , areas_(tree.nodes.size())
        , visits_left_(std::clamp(tree.nodes.size() * max_visits_per_node, min_visits, max_visits))
    {
        for (uint32_t node = 0; node < tree.nodes.size(); node++) {
            const BinaryNode& n = tree.nodes[node];
            areas_[node] = n.box.half_area();
            if (!n.is_leaf())
                parents_[n.left] = parents_[n.right] = node;
        }
    }

    // Largest first: what they gain, all below them gains.
    void pass()
    {
        std::vector<uint32_t> candidates(tree_.nodes.size());
        std::iota(candidates.begin(), candidates.end(), 0u);
        const size_t count = std::min(size_t(float(candidates.size()) * share_of_nodes), max_per_pass);
        const auto end = candidates.begin() + std::ptrdiff_t(count);
        std::partial_sort(candidates.begin(), end, candidates.end(), [&](uint32_t a, uint32_t b) {
            return areas_[a] != areas_[b] ? areas_[a] > areas_[b] : a < b; // a total order: runs are alike
        });
        candidates.erase(end, candidates.end());
        for (const uint32_t node : candidates)
            if (node != 0 && parents_[node] != 0 && visits_left_ > 0)
                if (const uint32_t place = find_place(node); place != stays && visits_left_ > 0)
                    move(node, place);
    }

    // The nodes anew, parents before children and the boxes of every subtree in a row.
    BinaryTree result() const
    {
        BinaryTree result;
        result.nodes.reserve(tree_.nodes.size());
        result.order.reserve(tree_.order.size());
        struct Pending {
            uint32_t node, parent; // the parent in the result
            bool is_right;
        };
        std::vector<Pending> pending { { 0, 0, false } }; // no recursion: the tree may have become deep
        while (!pending.empty()) {
            const auto [node, parent, is_right] = pending.back();
            pending.pop_back();
            const BinaryNode& from = tree_.nodes[node];
            const uint32_t id = uint32_t(result.nodes.size()), first = uint32_t(result.order.size());
            result.nodes.push_back({ from.box, first, 0 });
            if (id != 0)
                (is_right ? result.nodes[parent].right : result.nodes[parent].left) = id;
            if (from.is_leaf()) {
                const auto boxes = tree_.order.begin() + from.first;
                result.order.insert(result.order.end(), boxes, boxes + from.count);
                result.nodes[id].count = from.count;
            } else {
                pending.push_back({ from.right, id, true });
                pending.push_back({ from.left, id, false });
            }
        }
        for (size_t id = result.nodes.size(); id-- > 0;) // children stand behind their parents
            if (BinaryNode& node = result.nodes[id]; !node.is_leaf())
                node.count = result.nodes[node.left].count + result.nodes[node.right].count;
        return result;
    }

private:
    uint32_t sibling(uint32_t node) const
    {
        const BinaryNode& parent = tree_.nodes[parents_[node]];
        return parent.left == node ? parent.right : parent.left;
    }

    // The node that would be the best sibling.
    uint32_t find_place(uint32_t node)
    {
        const Box& box = tree_.nodes[node].box;
        const uint32_t parent = parents_[node], old_sibling = sibling(node);
        Best best { stays, areas_[parent] * min_gain };
        // Up from the parent, into each subtree that the way passes. `gain`: area that is saved above that subtree once
        // the node has left.
        float gain = areas_[parent];
        uint32_t subtree = old_sibling;
        Box without = tree_.nodes[old_sibling].box; // what is below `pivot` but for the node
        for (uint32_t pivot = parent;; pivot = parents_[pivot]) {
            search(subtree, gain, box, areas_[node], old_sibling, best);
            if (pivot == 0 || visits_left_ == 0)
                return best.place;
            if (pivot != parent) { // the parent itself vanishes
                without.add(tree_.nodes[subtree].box);
                gain += areas_[pivot] - without.half_area();
            }
            subtree = sibling(pivot);
        }
    }

    struct Best {
        uint32_t place;
        float gain;
    };
    // For a node with this box and area in the tree below `subtree`.
    void search(uint32_t subtree, float gain, const Box& box, float area, uint32_t old_sibling, Best& best)
    {
        stack_.push_back({ subtree, gain });
        while (!stack_.empty()) {
            const Visit visit = stack_.back();
            stack_.pop_back();
            count_visit();
            if (visit.gain - area <= best.gain) // a parent is at least as large as the node
                continue;
            const BinaryNode& place = tree_.nodes[visit.node];
            Box both = place.box;
            both.add(box);
            const float gain_here = visit.gain - both.half_area();
            if (gain_here > best.gain && visit.node != old_sibling)
                best = { visit.node, gain_here };
            if (place.is_leaf())
                continue;
            const float gain_below = gain_here + areas_[visit.node]; // this one would grow to `both`
            stack_.push_back({ place.left, gain_below });
            stack_.push_back({ place.right, gain_below });
        }
    }

    // Its parent goes along, to stand for both.
    void move(uint32_t node, uint32_t place)
    {
        const uint32_t parent = parents_[node];
        const uint32_t above = parents_[parent];
        replace_child(above, parent, sibling(node));
        fit_boxes(above);
        replace_child(parents_[place], place, parent);
        tree_.nodes[parent].left = node;
        tree_.nodes[parent].right = place;
        parents_[place] = parent;
        fit_boxes(parent);
    }

    void replace_child(uint32_t parent, uint32_t child, uint32_t by)
    {
        BinaryNode& node = tree_.nodes[parent];
        (node.left == child ? node.left : node.right) = by;
        parents_[by] = parent;
    }

    void count_visit() { visits_left_ -= visits_left_ > 0; }

    // From `node` up to the root.
    void fit_boxes(uint32_t node)
    {
        for (;; node = parents_[node]) {
            count_visit();
            BinaryNode& n = tree_.nodes[node];
            n.box = tree_.nodes[n.left].box;
            n.box.add(tree_.nodes[n.right].box);
            areas_[node] = n.box.half_area();
            if (node == 0)
                return;
        }
    }

    struct Visit {
        uint32_t node;
        float gain;
    };
    BinaryTree& tree_; // while subtrees move, `first` and `count` are true of leaves only
    std::vector<uint32_t> parents_;
    std::vector<float> areas_; // half ones
    std::vector<Visit> stack_;
    uint64_t visits_left_;
};

} // namespace

void reinsert_subtrees(BinaryTree& tree)
{
    if (tree.nodes.empty())
        return;
    Reinsertion work(tree);
    for (int pass = 0; pass < passes; pass++)
        work.pass();
    tree = work.result();
}

} // namespace vkpt

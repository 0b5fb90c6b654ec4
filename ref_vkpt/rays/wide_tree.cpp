// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/rays/wide_tree.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <glm/common.hpp>
#include <limits>
#include <utility>

namespace vkpt {
namespace {

using namespace shared;

// Stack entries that a balanced tree over `count` boxes can need: every wide level leaves seven children behind and an
// eighth of the boxes before it.
uint32_t balanced_stack_need(uint32_t count, uint32_t max_leaf)
{
    uint32_t leaves = (count + max_leaf - 1) / max_leaf;
    uint32_t binary_levels = leaves > 1 ? uint32_t(std::bit_width(leaves - 1)) : 0;
    return (binary_levels + 2) / 3 * (BVH_WIDTH - 1);
}

struct Children {
    std::array<uint32_t, BVH_WIDTH> nodes {};
    uint32_t count = 0;
    void add(uint32_t node) { nodes[count++] = node; }
};

// What a ray pays for a wide node and for a triangle, by their loads (lib/trace_software.glsl).
constexpr float node_cost = 2.0f, triangle_cost = 1.0f;

// The cheapest way to stand for each binary subtree by at most k children of a wide node, by the surface-area heuristic
// (Ylitie et al., "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017, section 3.1).
class Collapse {
public:
    Collapse(const BinaryTree& tree, uint32_t max_leaf)
        : tree_(tree)
        , max_leaf_(max_leaf)
        , forests_(tree.nodes.size())
    {
        for (size_t node = tree.nodes.size(); node-- > 0;) // children stand behind their parents
            solve(node);
    }

    bool is_leaf(uint32_t node) const { return forests_[node].leaf; }

    Children children(uint32_t node) const
    {
        Children result;
        if (is_leaf(node))
            result.add(node);
        else
            open(node, BVH_WIDTH, result);
        return result;
    }

private:
    struct Forest {
        std::array<float, BVH_WIDTH - 1> cost {}; // [k - 1]: by at most k roots
        std::array<uint8_t, BVH_WIDTH> left {}; // [k - 1]: how many of k roots the left child gets
        bool leaf = false; // what one root is
    };

    // The best way to share `roots` between the two children.
    std::pair<float, uint8_t> share(const BinaryNode& node, uint32_t roots) const
    {
        std::pair<float, uint8_t> best { std::numeric_limits<float>::max(), uint8_t(1) };
        for (uint32_t left = 1; left < roots; left++) {
            const float cost = forests_[node.left].cost[left - 1] + forests_[node.right].cost[roots - left - 1];
            if (cost < best.first)
                best = { cost, uint8_t(left) };
        }
        return best;
    }

    void solve(size_t index)
    {
        const BinaryNode& node = tree_.nodes[index];
        Forest& forest = forests_[index];
        const float area = node.box.half_area();
        const float as_leaf = area * triangle_cost * float(node.count);
        if (node.is_leaf()) {
            forest.cost.fill(as_leaf);
            forest.leaf = true;
            return;
        }
        const auto [opened, left] = share(node, BVH_WIDTH);
        forest.left[BVH_WIDTH - 1] = left;
        const float as_node = area * node_cost + opened;
        forest.leaf = node.count <= max_leaf_ && as_leaf <= as_node;
        forest.cost[0] = forest.leaf ? as_leaf : as_node;
        for (uint32_t roots = 2; roots < BVH_WIDTH; roots++) {
            const auto [cost, split] = share(node, roots);
            forest.cost[roots - 1] = std::min(cost, forest.cost[roots - 2]);
            forest.left[roots - 1] = split;
        }
    }

    // Adds up to `roots` children that stand for what is below `node`.
    void open(uint32_t node, uint32_t roots, Children& result) const
    {
        const Forest& forest = forests_[node];
        while (roots > 1 && roots < BVH_WIDTH && forest.cost[roots - 1] == forest.cost[roots - 2])
            roots--; // as good with fewer
        if (roots == 1) {
            result.add(node);
            return;
        }
        const uint32_t left = forest.left[roots - 1];
        open(tree_.nodes[node].left, left, result);
        open(tree_.nodes[node].right, roots - left, result);
    }

    const BinaryTree& tree_;
    uint32_t max_leaf_;
    std::vector<Forest> forests_;
};

// Adds wide nodes in depth-first order.
class WideMaker {
public:
    WideMaker(BinaryTree& tree, std::span<const Box> boxes, uint32_t max_leaf)
        : tree_(tree)
        , boxes_(boxes)
        , max_leaf_(max_leaf)
        , collapse_(tree, max_leaf)
    {
    }

    WideTree make(uint32_t stack_budget)
    {
        if (tree_.nodes.empty())
            wide_.nodes.emplace_back();
        else {
            wide_.nodes.reserve(tree_.nodes.size() / 8 + 1);
            wide_.stack_need = add_node(0, stack_budget, 1, false);
        }
        return std::move(wide_);
    }

private:
    // Returns the stack entries that the node needs. `stack_left`: those that are free when a ray enters it.
    // `balanced`: it is from rebuild_balanced().
    uint32_t add_node(uint32_t node, uint32_t stack_left, uint32_t depth, bool balanced)
    {
        Children children = balanced ? open_levels(node) : collapse_.children(node);
        if (!balanced && !fits_stack(children, stack_left)) {
            balanced = true;
            rebuild_balanced(tree_, node, boxes_, max_leaf_);
            children = open_levels(node);
        }
        wide_.max_depth = std::max(wide_.max_depth, depth);
        const size_t index = wide_.nodes.size();
        wide_.nodes.emplace_back().child_count = children.count;
        uint32_t need = 0;
        for (uint32_t slot = 0; slot < children.count; slot++) {
            const BinaryNode child = tree_.nodes[children.nodes[slot]]; // a copy: adding children may move the nodes
            uint32_t word = BVH_LEAF | (child.count - 1) << BVH_LEAF_COUNT_SHIFT | child.first;
            if (balanced ? !child.is_leaf() : !collapse_.is_leaf(children.nodes[slot])) {
                word = uint32_t(wide_.nodes.size());
                need = std::max(
                    need, add_node(children.nodes[slot], stack_left - (children.count - 1), depth + 1, balanced));
            }
            wide_.nodes[index].boxes[slot] = child.box;
            wide_.nodes[index].words[slot] = word;
        }
        return need + children.count - 1;
    }

    // In a balanced tree: replaces the inner node of the most boxes by its two children until eight are there, so that
    // all of one level come before those of the next.
    Children open_levels(uint32_t node) const
    {
        Children children;
        children.add(node);
        while (children.count < BVH_WIDTH) {
            uint32_t best = BVH_WIDTH;
            uint32_t most = 0;
            for (uint32_t i = 0; i < children.count; i++) {
                const BinaryNode& child = tree_.nodes[children.nodes[i]];
                if (!child.is_leaf() && child.count > most) {
                    best = i;
                    most = child.count;
                }
            }
            if (best == BVH_WIDTH)
                break;
            const BinaryNode& opened = tree_.nodes[children.nodes[best]];
            children.nodes[best] = opened.left;
            children.add(opened.right);
        }
        return children;
    }

    // Whether below each child at least a balanced tree can still be walked. Holds for the root by max_boxes_within(),
    // so that wherever it fails first, a balanced tree can stand in.
    bool fits_stack(const Children& children, uint32_t stack_left) const
    {
        return std::all_of(children.nodes.begin(), children.nodes.begin() + children.count, [&](uint32_t node) {
            return balanced_stack_need(tree_.nodes[node].count, max_leaf_) + children.count - 1 <= stack_left;
        });
    }

    BinaryTree& tree_;
    std::span<const Box> boxes_;
    uint32_t max_leaf_;
    Collapse collapse_;
    WideTree wide_;
};

struct NodeBytes {
    uint8_t planes[3][2][BVH_WIDTH]; // by axis, then low and high
    float corner[3];
    uint32_t steps;
    uint32_t words[BVH_WIDTH];
};
static_assert(offsetof(NodeBytes, corner) == BVH_FRAME_OFFSET && offsetof(NodeBytes, words) == BVH_CHILD_WORDS_OFFSET);
static_assert(sizeof(NodeBytes) == BVH_NODE_BYTES);

// Where a node's 8-bit planes lie.
struct NodeFrame {
    Float4 corner;
    Float4 step; // between planes
    Int4 steps; // as nodes hold them, see BVH_STEP_BITS

    NodeFrame(Float4 at, Float4 min_step)
        : corner(at)
        , steps((std::bit_cast<Int4>(min_step) + ((1 << BVH_STEP_SHIFT) - 1)) >> BVH_STEP_SHIFT)
    {
        step = std::bit_cast<Float4>(steps << BVH_STEP_SHIFT);
    }
};

// A frame that holds the boxes with their margin.
NodeFrame make_frame(float margin, const Box4* boxes, uint32_t count)
{
    Box4 all;
    for (uint32_t slot = 0; slot < count; slot++)
        all.add(boxes[slot]);
    // A little more, so that rounding leaves the last plane in its place.
    constexpr float whole_step = 1.00001f / 255.0f;
    const Float4 corner = all.low - margin;
    return { corner, (all.high + margin - corner) * whole_step };
}

} // namespace

float box_margin(const Box& bounds)
{
    constexpr float least = 1.0f / 32.0f, relative = 1.0f / (1 << 18);
    if (!(bounds.low.x <= bounds.high.x))
        return least;
    const glm::vec3 reach = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    return std::max({ least, reach.x * relative, reach.y * relative, reach.z * relative });
}

uint32_t max_boxes_within(uint32_t stack_budget, uint32_t max_leaf)
{
    const uint32_t binary_levels = std::min(stack_budget / (BVH_WIDTH - 1) * 3, 24u);
    return max_leaf << binary_levels;
}

WideTree make_wide(BinaryTree& tree, std::span<const Box> boxes, uint32_t max_leaf, uint32_t stack_budget)
{
    return WideMaker(tree, boxes, max_leaf).make(stack_budget);
}

void write_node(float margin, const Box4* boxes, const uint32_t* words, uint32_t child_count, uint32_t* node)
{
    // Inverted planes, and BVH_NO_CHILD, for children that are not there.
    static constexpr NodeBytes empty = [] {
        NodeBytes bytes {};
        for (auto& axis : bytes.planes)
            std::fill_n(axis[0], BVH_WIDTH, uint8_t(0xff));
        std::fill_n(bytes.words, BVH_WIDTH, BVH_NO_CHILD);
        return bytes;
    }();
    NodeBytes bytes = empty;
    const NodeFrame frame
        = child_count > 0 ? make_frame(margin, boxes, child_count) : NodeFrame(splat(0.0f), splat(1.0f));
    const Float4 inverse_step = splat(1.0f) / frame.step;
    for (int axis = 0; axis < 3; axis++) {
        bytes.corner[axis] = frame.corner[axis];
        bytes.steps |= uint32_t(frame.steps[axis]) << (uint32_t(axis) * BVH_STEP_BITS);
    }
    for (uint32_t slot = 0; slot < child_count; slot++) {
        const Float4 low = (boxes[slot].low - margin - frame.corner) * inverse_step;
        const Float4 high = (boxes[slot].high + margin - frame.corner) * inverse_step;
        const Int4 low_planes = __builtin_convertvector(low, Int4);
        Int4 high_planes = __builtin_convertvector(high, Int4);
        high_planes -= __builtin_convertvector(high_planes, Float4) < high; // upwards: true is -1
        for (int axis = 0; axis < 3; axis++) {
            bytes.planes[axis][0][slot] = uint8_t(low_planes[axis]);
            bytes.planes[axis][1][slot] = uint8_t(high_planes[axis]);
        }
        bytes.words[slot] = words[slot];
    }
    std::memcpy(node, &bytes, sizeof bytes);
}

void write_node(float margin, const WideNode& wide, uint32_t* node)
{
    std::array<Box4, BVH_WIDTH> boxes;
    for (uint32_t slot = 0; slot < wide.child_count; slot++)
        boxes[slot] = to_box4(wide.boxes[slot]);
    write_node(margin, boxes.data(), wide.words.data(), wide.child_count, node);
}

void place_nodes(std::span<uint32_t> nodes, const TreePlace& place)
{
    constexpr size_t first_word = BVH_CHILD_WORDS_OFFSET / sizeof(uint32_t);
    for (size_t node = 0; node < nodes.size(); node += bvh_node_words)
        for (uint32_t& word : nodes.subspan(node + first_word, BVH_WIDTH))
            word = place.placed(word);
}

} // namespace vkpt

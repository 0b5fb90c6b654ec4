// SPDX-License-Identifier: GPL-2.0-or-later
// The method is Seth Teller's ("Visibility Computations in Densely Occluded Polyhedral Environments", 1992) as Quake's
// tools made it known: a beam starts at one portal and is narrowed at every further one by the planes that touch both.
#include "tools/map_compiler/visibility.hpp"

#include "common/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <optional>

namespace vkpt::tools {

using namespace formats;

namespace {

// What a cluster is for sight. It may hold solid detail and still be seen into.
uint32_t cluster_contents(const Tree& tree, int index)
{
    const Node& node = tree.nodes[size_t(index)];
    if (node.is_leaf())
        return node.contents;
    const uint32_t a = cluster_contents(tree, node.children[0]), b = cluster_contents(tree, node.children[1]);
    return (a | b) & ~(a & b & CONTENTS_SOLID ? 0u : uint32_t(CONTENTS_SOLID));
}

void number_leaves(Tree& tree, int index, int cluster)
{
    Node& node = tree.nodes[size_t(index)];
    if (node.is_leaf()) {
        node.cluster = node.contents & CONTENTS_SOLID ? -1 : cluster;
        return;
    }
    number_leaves(tree, node.children[0], cluster);
    number_leaves(tree, node.children[1], cluster);
}

bool is_see_through(uint32_t a, uint32_t b)
{
    for (uint32_t* contents : { &a, &b })
        if (*contents & (CONTENTS_TRANSLUCENT | CONTENTS_DETAIL))
            *contents = 0;
    if ((a | b) & CONTENTS_SOLID)
        return false;
    return visible_contents(a ^ b) == 0;
}

// Bit set over directed portals.
class Bits {
public:
    explicit Bits(size_t count = 0)
        : words_((count + 63) / 64)
    {
    }
    bool test(size_t i) const { return words_[i / 64] >> (i % 64) & 1; }
    void set(size_t i) { words_[i / 64] |= uint64_t(1) << (i % 64); }
    std::vector<uint64_t>& words() { return words_; }
    const std::vector<uint64_t>& words() const { return words_; }

private:
    std::vector<uint64_t> words_;
};

// A portal as it is passed in one direction.
struct Passage {
    int to = 0;
    Plane plane; // looks into `to`
    Winding winding;
    Bits might_see, sees;
    std::atomic<bool> done { false };
};

class VisibilityFlow {
public:
    explicit VisibilityFlow(const ClusterGraph& graph)
        : count_(graph.portals.size() * 2)
        , passages_(count_)
        , leaving_(size_t(graph.cluster_count))
    {
        for (size_t i = 0; i < count_; i++) {
            const ClusterPortal& portal = graph.portals[i / 2];
            const bool to_front = i % 2;
            Passage& passage = passages_[i];
            passage.to = portal.clusters[to_front ? 0 : 1];
            passage.winding = portal.winding;
            passage.plane = winding_plane(portal.winding);
            if (!to_front)
                passage.plane = passage.plane.flipped();
            passage.might_see = Bits(count_);
            passage.sees = Bits(count_);
            leaving_[size_t(portal.clusters[to_front ? 1 : 0])].push_back(i);
        }
    }

    void find_possible(unsigned threads)
    {
        parallel_for(count_, threads, [&](size_t i) { flood_possible(i); });
    }

    // Narrow passages first: their finished result narrows the search of the others.
    void flow(unsigned threads)
    {
        std::vector<std::pair<size_t, size_t>> order;
        for (size_t i = 0; i < count_; i++) {
            size_t complexity = 0;
            for (const uint64_t word : passages_[i].might_see.words())
                complexity += size_t(std::popcount(word));
            order.emplace_back(complexity, i);
        }
        std::ranges::sort(order);
        parallel_for(count_, threads, [&](size_t i) { flow_from(order[i].second); });
    }

    ClusterSet cluster_row(int cluster, bool flowed) const
    {
        ClusterSet row(leaving_.size());
        row.insert(cluster);
        for (const size_t p : leaving_[size_t(cluster)]) {
            row.insert(passages_[p].to);
            const Bits& bits = flowed ? passages_[p].sees : passages_[p].might_see;
            for (size_t i = 0; i < count_; i++)
                if (bits.test(i))
                    row.insert(passages_[i].to);
        }
        return row;
    }

private:
    static constexpr double epsilon = 0.02;

    // b is ahead of a, and a behind b.
    bool faces(const Passage& a, const Passage& b) const
    {
        const bool ahead
            = std::ranges::any_of(b.winding, [&](const dvec3& p) { return a.plane.distance(p) > epsilon; });
        return ahead && std::ranges::any_of(a.winding, [&](const dvec3& p) { return b.plane.distance(p) < -epsilon; });
    }

    void flood_possible(size_t start)
    {
        Passage& from = passages_[start];
        std::vector<int> stack { from.to };
        std::vector<bool> entered(leaving_.size());
        while (!stack.empty()) {
            const int cluster = stack.back();
            stack.pop_back();
            if (entered[size_t(cluster)])
                continue;
            entered[size_t(cluster)] = true;
            for (const size_t p : leaving_[size_t(cluster)])
                if (p != start && faces(from, passages_[p])) {
                    from.might_see.set(p);
                    stack.push_back(passages_[p].to);
                }
        }
    }

    struct Step {
        const Step* before = nullptr;
        Bits might; // portals still possible from here
        Winding source; // the part of the first portal that sees here
        Winding pass; // the last portal's part that is seen; empty at the first
        Plane plane;
    };

    void flow_from(size_t start)
    {
        Passage& base = passages_[start];
        Step first;
        first.might = base.might_see;
        first.source = base.winding;
        first.plane = base.plane;
        recurse(base, base.to, first);
        base.done = true;
    }

    void recurse(Passage& base, int cluster, const Step& previous)
    {
        for (const size_t p : leaving_[size_t(cluster)]) {
            if (!previous.might.test(p))
                continue;
            const Passage& passage = passages_[p];
            Step step;
            step.before = &previous;
            const Bits& reach = passage.done ? passage.sees : passage.might_see;
            step.might = previous.might;
            bool more = !base.sees.test(p);
            for (size_t w = 0; w < step.might.words().size(); w++) {
                step.might.words()[w] &= reach.words()[w];
                more |= (step.might.words()[w] & ~base.sees.words()[w]) != 0;
            }
            if (!more || !narrow(base, passage, previous, step))
                continue;
            base.sees.set(p);
            recurse(base, passage.to, step);
        }
    }

    // Cuts source and portal down to the parts that see each other. False: none.
    bool narrow(const Passage& base, const Passage& passage, const Step& previous, Step& step) const
    {
        step.plane = passage.plane;
        step.pass = clip_winding(passage.winding, base.plane, epsilon);
        if (step.pass.empty())
            return false;
        step.source = clip_winding(previous.source, passage.plane.flipped(), epsilon);
        if (step.source.empty())
            return false;
        if (previous.pass.empty())
            return true; // the second portal is hidden only when coplanar
        step.pass = clip_to_separators(step.source, previous.pass, std::move(step.pass), false);
        if (!step.pass.empty())
            step.pass = clip_to_separators(previous.pass, step.source, std::move(step.pass), true);
        return !step.pass.empty();
    }

    // A plane through an edge of `source` and a corner of `pass` that has the two on different sides bounds what can be
    // seen through `pass`. flip: source and pass are exchanged, and the visible part lies on the other side.
    static Winding clip_to_separators(const Winding& source, const Winding& pass, Winding target, bool flip)
    {
        for (size_t i = 0; i < source.size(); i++)
            for (size_t k = 0; k < pass.size(); k++) {
                const auto plane = make_separator(source, i, pass, k);
                if (!plane)
                    continue;
                target = clip_winding(target, flip ? plane->flipped() : *plane, epsilon);
                if (target.empty())
                    return target;
                break; // the other corners of `pass` give no better plane through this edge
            }
        return target;
    }

    static std::optional<Plane> make_separator(const Winding& source, size_t i, const Winding& pass, size_t k)
    {
        const size_t next = (i + 1) % source.size();
        const dvec3 cross = glm::cross(source[next] - source[i], pass[k] - source[i]);
        const double length = glm::length(cross);
        if (length < 0.1)
            return {};
        Plane plane { cross / length, 0, 3 };
        plane.dist = glm::dot(pass[k], plane.normal);
        int source_side = 0;
        for (size_t m = 0; m < source.size() && source_side == 0; m++)
            if (m != i && m != next) {
                const double d = plane.distance(source[m]);
                source_side = d > epsilon ? 1 : d < -epsilon ? -1 : 0;
            }
        if (source_side == 0)
            return {}; // source and corner in one plane
        if (source_side > 0)
            plane = plane.flipped();
        bool in_front = false;
        for (size_t m = 0; m < pass.size(); m++) {
            if (m == k)
                continue;
            const double d = plane.distance(pass[m]);
            if (d < -epsilon)
                return {};
            in_front |= d > epsilon;
        }
        return in_front ? std::optional(plane) : std::nullopt;
    }

    size_t count_;
    std::vector<Passage> passages_;
    std::vector<std::vector<size_t>> leaving_; // per cluster
};

void compress(const std::vector<uint8_t>& row, std::vector<uint8_t>& lump)
{
    for (size_t i = 0; i < row.size();) {
        lump.push_back(row[i]);
        if (row[i++] != 0)
            continue;
        uint8_t zeros = 1;
        while (i < row.size() && row[i] == 0 && zeros < 255) {
            i++;
            zeros++;
        }
        lump.push_back(zeros);
    }
}

} // namespace

ClusterGraph make_clusters(Tree& tree, const PlaneSet& planes)
{
    make_portals(tree, planes, PortalScope::clusters);
    ClusterGraph graph;
    std::vector<int> cluster_of(tree.nodes.size(), -1);
    std::vector<uint32_t> contents(tree.nodes.size());
    std::vector<int> stack { 0 };
    while (!stack.empty()) {
        const int index = stack.back();
        stack.pop_back();
        const Node& node = tree.nodes[size_t(index)];
        if (!node.is_leaf() && !node.detail) {
            stack.insert(stack.end(), { node.children[1], node.children[0] });
            continue;
        }
        contents[size_t(index)] = cluster_contents(tree, index);
        if (!(contents[size_t(index)] & CONTENTS_SOLID))
            cluster_of[size_t(index)] = graph.cluster_count++;
        number_leaves(tree, index, cluster_of[size_t(index)]);
    }
    for (const Portal& portal : tree.portals) {
        const int a = cluster_of[size_t(portal.nodes[0])], b = cluster_of[size_t(portal.nodes[1])];
        if (portal.winding.empty() || a < 0 || b < 0)
            continue;
        if (is_see_through(contents[size_t(portal.nodes[0])], contents[size_t(portal.nodes[1])]))
            graph.portals.push_back({ { a, b }, portal.winding });
    }
    return graph;
}

std::vector<ClusterSet> compute_visibility(const ClusterGraph& graph, const VisibilityOptions& options)
{
    VisibilityFlow flow(graph);
    flow.find_possible(options.threads);
    const bool flowed = graph.portals.size() <= options.max_flow_portals;
    if (flowed)
        flow.flow(options.threads);
    std::vector<ClusterSet> rows;
    for (int cluster = 0; cluster < graph.cluster_count; cluster++)
        rows.push_back(flow.cluster_row(cluster, flowed));
    for (int a = 0; a < graph.cluster_count; a++) // tolerances differ by direction: sight does not
        for (int b = 0; b < a; b++)
            if (rows[size_t(a)].contains(b) || rows[size_t(b)].contains(a)) {
                rows[size_t(a)].insert(b);
                rows[size_t(b)].insert(a);
            }
    return rows;
}

std::vector<uint8_t> pack_visibility(std::span<const ClusterSet> rows)
{
    const size_t count = rows.size();
    std::vector<uint8_t> lump(4 + count * 8);
    const auto store = [&](size_t offset, size_t value) {
        for (size_t i = 0; i < 4; i++)
            lump[offset + i] = uint8_t(value >> (8 * i));
    };
    store(0, count);
    for (size_t i = 0; i < count; i++) {
        store(4 + i * 8, lump.size());
        compress(rows[i].bytes(), lump);
        ClusterSet heard = rows[i];
        for (size_t k = 0; k < count; k++)
            if (rows[i].contains(int(k)))
                heard.merge(rows[k]);
        store(8 + i * 8, lump.size());
        compress(heard.bytes(), lump);
    }
    return lump;
}

} // namespace vkpt::tools

// SPDX-License-Identifier: GPL-2.0-or-later
// The templates of navigation.hpp: Dijkstra's algorithm.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace vkpt::game {

template <typename Visit>
uint32_t Navigation::search(uint32_t start, uint32_t now, Search& state, const Visit& visit) const
{
    state.came_from.assign(nodes_.size(), none);
    state.costs.assign(nodes_.size(), std::numeric_limits<float>::infinity());
    // Equal costs in the order of the nodes' numbers: the same way in every run.
    using Entry = std::pair<float, uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    state.costs[start] = 0;
    open.push({ 0, start });
    while (!open.empty()) {
        const auto [cost, node] = open.top();
        open.pop();
        if (cost > state.costs[node])
            continue;
        if (visit(node))
            return node;
        for (const Edge& edge : nodes_[node].edges) {
            if (edge.blocked_until > now || cost + edge.cost >= state.costs[edge.to])
                continue;
            state.costs[edge.to] = cost + edge.cost;
            state.came_from[edge.to] = node;
            open.push({ cost + edge.cost, edge.to });
        }
    }
    return none;
}

template <typename Wanted>
std::vector<uint32_t> Navigation::find_path(uint32_t start, uint32_t now, const Wanted& is_wanted) const
{
    Search state;
    const uint32_t found = search(start, now, state, [&](uint32_t node) { return node != start && is_wanted(node); });
    std::vector<uint32_t> path;
    for (uint32_t node = found; node != none && node != start; node = state.came_from[node])
        path.push_back(node);
    std::ranges::reverse(path);
    return path;
}

} // namespace vkpt::game

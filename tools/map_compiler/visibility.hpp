// SPDX-License-Identifier: GPL-2.0-or-later
// Which clusters can see which: flow through the portals between clusters, clipped by separating planes.
#pragma once

#include "tools/map_compiler/tree.hpp"

#include <cstdint>
#include <span>

namespace vkpt::tools {

// A portal of the cluster graph; passable by sight.
struct ClusterPortal {
    int clusters[2] = { 0, 0 }; // clusters[0] lies in front of the winding's plane
    Winding winding;
};

struct ClusterGraph {
    int cluster_count = 0;
    std::vector<ClusterPortal> portals;
};

// Numbers the clusters of a tree (solid leaves get -1) and finds the portals between them. Replaces the tree's portals.
ClusterGraph make_clusters(Tree& tree, const PlaneSet& planes);

struct VisibilityOptions {
    unsigned threads = 1;
    // Above this many portals only the cheap, larger set (what the portals' planes allow) is made.
    size_t max_flow_portals = 4000;
};
// Row per cluster; symmetric; every cluster sees itself.
std::vector<formats::ClusterSet> compute_visibility(const ClusterGraph& graph, const VisibilityOptions& options);

// The BSP file's lump: count, offsets, run-length compressed rows of what is seen (PVS) and heard (PHS: seen by seen).
std::vector<uint8_t> pack_visibility(std::span<const formats::ClusterSet> rows);

} // namespace vkpt::tools

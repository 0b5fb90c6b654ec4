// SPDX-License-Identifier: GPL-2.0-or-later
// Per PVS cluster, the emitters that can light it: sorted ascending by emitter index, free of duplicates.
#pragma once

#include "formats/bsp.hpp"
#include "shaders/shared/scene.h"

#include <span>
#include <vector>

namespace vkpt {

class LightLists {
public:
    // At map load. An emitter lists in every cluster that the PVS lets see any cluster which it touches. The map must
    // live as long as update() is called.
    void build(const formats::Bsp& bsp, std::span<const shared::Emitter> static_emitters);
    // Each frame: dynamic emitters get indices static_count + i. Emitters with a reach list only where it extends to.
    void update(std::span<const shared::Emitter> dynamic_emitters);

    // Index = cluster; one more entry at the end, for points outside every cluster: it holds all emitters.
    const std::vector<shared::LightList>& lists() const { return lists_; }
    // Changed by build only: upload once.
    const std::vector<uint32_t>& static_indices() const { return static_indices_; }
    const std::vector<uint32_t>& dynamic_indices() const { return dynamic_indices_; }
    size_t static_emitter_count() const { return static_emitter_count_; }
    // Static emitters that touch no cluster (they lie in solid): only the list for outside holds them.
    size_t unlisted_static_count() const { return unlisted_static_count_; }
    // The tree that shaders descend to find a point's cluster. Node 0 is the root.
    const std::vector<shared::BspTreeNode>& tree() const { return tree_; }

private:
    void build_visibility(const formats::Bsp& bsp);
    void build_cluster_bounds(const formats::Bsp& bsp);
    void build_static_lists(std::span<const shared::Emitter> emitters);
    // The clusters from which `emitter` can be seen. False: it touches no cluster; then the set is empty.
    bool find_receivers(const shared::Emitter& emitter, formats::ClusterSet& receivers) const;
    void append_receivers_in_reach(const shared::Emitter& emitter, const formats::ClusterSet& receivers);
    bool reaches(const shared::Emitter& emitter, size_t cluster) const;

    const formats::Bsp* bsp_ = nullptr;
    size_t cluster_count_ = 0;
    size_t static_emitter_count_ = 0;
    size_t unlisted_static_count_ = 0;
    std::vector<shared::LightList> lists_;
    std::vector<uint32_t> static_indices_, dynamic_indices_;
    std::vector<shared::BspTreeNode> tree_;
    std::vector<formats::ClusterSet> visible_from_; // PVS rows, kept decompressed and made symmetric
    std::vector<glm::vec3> cluster_mins_, cluster_maxs_;
    // update()'s scratch memory: the clusters of all dynamic emitters one after the other, and where each one's end.
    std::vector<uint32_t> receiver_clusters_;
    std::vector<size_t> receiver_ends_;
};

} // namespace vkpt

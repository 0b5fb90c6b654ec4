// SPDX-License-Identifier: GPL-2.0-or-later
// Per PVS cluster, the emitters that can light it: sorted ascending by emitter index, free of duplicates. A map has its
// lists of static emitters; a view goes on with a copy, which shares what never changes and adds the view's own lights.
#pragma once

#include "formats/bsp.hpp"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace vkpt {

struct Bounds {
    glm::vec3 mins, maxs;
};

class LightLists {
public:
    // At map load. An emitter lists in every cluster that the PVS lets see any cluster which it touches, unless all of
    // it is behind the emitter. The map must live as long as update() is called. Throws formats::FormatError where the
    // lists would be far longer than a map of its size may make them.
    void build(const formats::Bsp& bsp, std::span<const shared::Emitter> static_emitters);
    // Each frame: dynamic emitters get indices static_count + i. Emitters with a reach list only where it extends to,
    // dark ones (radiance 0) nowhere. Where in the map an emitter can be seen is looked up again only if it has moved;
    // nothing is done where all stand still. Once there would be more than `max_dynamic_entries` in all clusters'
    // lists, the further emitters list in none.
    void update(std::span<const shared::Emitter> dynamic_emitters);

    // Index = cluster; one more entry at the end, for points outside every cluster: it holds all emitters.
    const std::vector<shared::LightList>& lists() const { return lists_; }
    // Changed by build only: upload once.
    const std::vector<uint32_t>& static_indices() const { return fixed_->static_indices; }
    const std::vector<uint32_t>& dynamic_indices() const { return dynamic_indices_; }
    // Length of every list before the last update: a list that grows or shrinks changes the strides of subset samplers,
    // and who replays last frame's choices needs the length that they were made with.
    const std::vector<uint32_t>& previous_lengths() const { return previous_lengths_; }
    // Whether the last update changed any list.
    bool has_changed() const { return changed_; }

    // The lists as the random numbers of the last frame must walk them to meet the same lights at the same places. In
    // each, what was in it before the last update comes first, at its old place (previous_lengths of them), though the
    // light may have gone; then what has come. Gone ones are dark, or past the end of this frame's emitters, which is
    // below `emitter_count` then.
    struct Repeated {
        std::vector<shared::LightList> lists;
        std::vector<uint32_t> dynamic_indices;
        size_t emitter_count = 0; // static and dynamic, before or after the update
    };
    Repeated repeat() const;
    size_t static_emitter_count() const { return fixed_->static_emitter_count; }
    // Holds all points of the cluster.
    Bounds cluster_bounds(size_t cluster) const { return fixed_->cluster_bounds(cluster); }
    // The clusters that can be seen from it, and that see it.
    const formats::ClusterSet& visible_from(size_t cluster) const { return fixed_->visible_from[cluster]; }
    size_t cluster_count() const { return fixed_->cluster_count; }
    // Static emitters that touch no cluster (they lie in solid): only the list for outside holds them.
    size_t unlisted_static_count() const { return fixed_->unlisted_static_count; }
    // Dynamic emitters that found no more room in the last update.
    size_t unlisted_dynamic_count() const { return unlisted_dynamic_count_; }
    // The busiest of a hundred maps need some 50,000. What moves may be thousands of lights in thousands of clusters,
    // every frame.
    static constexpr size_t max_dynamic_entries = 1 << 21;
    // The tree that shaders descend to find a point's cluster. Node 0 is the root.
    const std::vector<shared::BspTreeNode>& tree() const { return fixed_->tree; }

private:
    // One dynamic emitter as of the last update, and the clusters that list it, ascending.
    struct Placed {
        shared::Emitter emitter {};
        std::vector<uint32_t> clusters;
        bool is_left_out = false;
    };
    // What build() finds out.
    struct Fixed {
        const formats::Bsp* bsp = nullptr;
        size_t cluster_count = 0;
        size_t static_emitter_count = 0;
        size_t unlisted_static_count = 0;
        std::vector<uint32_t> static_indices;
        std::vector<shared::BspTreeNode> tree;
        std::vector<formats::ClusterSet> visible_from; // PVS rows, kept decompressed and made symmetric
        formats::ClusterSet sky_receivers; // clusters from which sky faces may be seen: what a sun can light
        std::vector<glm::vec3> cluster_mins, cluster_maxs;

        void build_visibility();
        void build_cluster_bounds();
        std::vector<shared::LightList> build_static_lists(std::span<const shared::Emitter> emitters);
        // The clusters from which `emitter` can be seen. False: it touches no cluster; then the set is empty. `steps`
        // grows by what that took.
        bool find_receivers(const shared::Emitter& emitter, formats::ClusterSet& receivers, uint64_t& steps) const;
        // False: the clusters are more than `most`, and not kept.
        bool place(Placed& placed, const shared::Emitter& emitter, size_t most) const;
        // Whether light of the emitter can arrive anywhere in the cluster, were nothing in between.
        bool reaches(const shared::Emitter& emitter, size_t cluster) const;
        Bounds cluster_bounds(size_t cluster) const { return { cluster_mins[cluster], cluster_maxs[cluster] }; }
    };
    void flatten();

    std::shared_ptr<const Fixed> fixed_ = std::make_shared<Fixed>();
    std::vector<shared::LightList> lists_;
    std::vector<uint32_t> dynamic_indices_;
    size_t unlisted_dynamic_count_ = 0;
    std::vector<Placed> placed_; // by dynamic index
    std::vector<uint32_t> previous_lengths_;
    std::vector<shared::LightList> previous_lists_;
    std::vector<uint32_t> previous_dynamic_indices_;
    size_t previous_dynamic_count_ = 0;
    bool changed_ = false;
};

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// A light BVH (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018; Moreau
// and Clarberg, "Importance Sampling of Many Lights on the GPU", Ray Tracing Gems, chapter 18): one random descent, at
// each node to the child that is likely to send more, then one of the leaf's few lights by predicted contribution. Each
// cluster has a tree of its own, over the static lights of its list alone, so that no descent ends at what the cluster
// cannot see.
#ifndef VKPT_LIGHT_SAMPLER_LIGHT_TREE
#define VKPT_LIGHT_SAMPLER_LIGHT_TREE

#include "../lib/light_trees.glsl"

const uint light_sampler_traits = SAMPLER_USES_SUBSET | SAMPLER_NEEDS_TREES;

// A leaf of the static lights, and a subset of the dynamic ones with one light of each stride. With probability p of
// the leaf, T strides, and sums of weights W and V, a light of weight w is picked with probability w / (W / p + T V),
// whichever part it is from: as in sample_subsets_of_parts, 1 / p standing for the static part's strides.
LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    if (light_count(list) == 0u)
        return no_light();
    LightListView moving = dynamic_lights(list);
    SubsetChoice of_dynamic = choose_subset(moving, random.light, options.subset_length);
    LightPredictor predictor = make_predictor(s, options);
    TreeLeaf leaf = make_tree_leaf(of_dynamic.rest);
    if (list.range.static_count > 0u)
        leaf = descend_tree(list, predictor.s, of_dynamic.rest, -1);
    Reservoir others = make_reservoir(0.0f);
    if (light_count(moving) > 0u) {
        uint state = start_fast_random(random.more);
        others = sweep_subset(moving, predictor, of_dynamic, next_fast_random(state));
        others.total *= float(of_dynamic.stride) * leaf.probability;
    }
    SubsetChoice all_of_leaf = choose_subset(leaf.count, leaf.rest, LIGHT_TREE_LEAF);
    LightSample result
        = sample_subset_in_two_sweeps(lights_of_leaf(list, leaf), predictor, all_of_leaf, others, random);
    result.probability *= leaf.probability;
    return result;
}

// A static light is in one leaf, and a dynamic one in one subset; the other part is as `random` has it.
float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    int place = find_light(list, emitter);
    if (place < 0)
        return 0.0f;
    LightListView moving = dynamic_lights(list);
    SubsetChoice of_dynamic = choose_subset(moving, random.light, options.subset_length);
    LightPredictor predictor = make_predictor(s, options);
    uint static_count = list.range.static_count;
    bool is_static = uint(place) < static_count;
    if (!is_static)
        of_dynamic.offset = remainder_whole(uint(place) - static_count, of_dynamic.stride);
    float total = float(of_dynamic.stride) * weigh_lights(moving, predictor, of_dynamic.offset, of_dynamic.stride);
    if (static_count > 0u) {
        int place_in_tree = is_static ? int(list.tables.tree_places.v[list.range.first_static + uint(place)]) : -1;
        TreeLeaf leaf = descend_tree(list, predictor.s, of_dynamic.rest, place_in_tree);
        total += weigh_lights(lights_of_leaf(list, leaf), predictor, 0u, 1u) / leaf.probability;
    }
    float weight = weigh_emitter(list, predictor, emitter);
    return weight > 0.0f ? weight / total : 0.0f;
}

#endif

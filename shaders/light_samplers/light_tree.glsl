// SPDX-License-Identifier: GPL-2.0-or-later
// A light BVH (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018; Moreau and Clarberg,
// "Importance Sampling of Many Lights on the GPU", Ray Tracing Gems, chapter 18): one random descent, at each node to the child that is
// likely to send more, then one of the leaf's few lights by predicted contribution. Each cluster has a tree of its own, over the
// static lights of its list alone, so that no descent ends at what the cluster cannot see.
#ifndef VKPT_LIGHT_SAMPLER_LIGHT_TREE
#define VKPT_LIGHT_SAMPLER_LIGHT_TREE

#include "../lib/light_trees.glsl"

const bool light_sampler_mis = false;

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    return sample_tree(list, s, random, options);
}

float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    return tree_probability(list, s, emitter, random, options);
}

#endif

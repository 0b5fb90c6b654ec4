// SPDX-License-Identifier: GPL-2.0-or-later
// Trees of a list's static lights (ref_vkpt/lights/light_trees.hpp): the descent to a leaf.
#ifndef VKPT_LIB_LIGHT_TREES
#define VKPT_LIB_LIGHT_TREES

#include "light_subsets.glsl"

// Where the bounds say that no light can be sent, or arrive, they may err by rounding: then it counts as this much.
const float min_tree_cosine = 0.01f;
// What tells best among a node's lights is neither what it may send at most, by its bounds, nor what its centre would,
// but a mixture; and near or inside of the sphere, some of the lights are nearer than the centre. Chosen by the error
// in five maps (tests/lights/real_maps_test.cpp).
const float share_of_bound = 0.3f, nearest_square = 0.4f;

// The root of x >= 0, to 0.09 %.
float quick_root(float x) { return x * quick_inversesqrt(quick_max(x, 1e-20f)); }

// The cosine of an angle less another one, both in [0, pi], or 1 where that is below 0.
float cosine_of_difference(float cosine, float less_cosine, float less_sine)
{
    float sine = quick_root(quick_max(1.0f - cosine * cosine, 0.0f));
    return cosine >= less_cosine ? 1.0f : cosine * less_cosine + sine * less_sine;
}

// Of directions up to some angle off the one to the centre. `spread`: 0 they are all that one, 1 they are everywhere.
float likely_cosine(float at_centre, float at_most, float spread)
{
    const float mean_of_all = 0.25f; // of the cosine, where it is above 0, over all directions
    float likely = mix(quick_max(at_centre, 0.0f), mean_of_all, spread);
    return mix(likely, quick_max(at_most, min_tree_cosine), share_of_bound);
}

// What the node's lights are likely to send to the surface, were nothing in between, by the node's own bounds: power,
// cosines at the lights and at the surface, over the square of the distance.
float weigh_tree_bounds(LightTreeNode node, Surface s)
{
    vec3 to_centre = node.centre - s.position;
    float distance2 = quick_max(dot(to_centre, to_centre), 1e-12f), inverse = quick_inversesqrt(distance2);
    // Half the angle that the sphere takes up; inside of it a right one.
    float sine = quick_min(node.radius * inverse, 1.0f), cosine = quick_root(quick_max(1.0f - sine * sine, 0.0f));
    float at_surface = dot(s.normal, to_centre) * inverse, at_lights = -dot(node.axis, to_centre) * inverse;
    // Added to the cone's: past pi its sine is below 0, and everything is possible.
    float cone_sine = quick_root(quick_max(1.0f - node.cone_cosine * node.cone_cosine, 0.0f));
    float open_sine = cone_sine * cosine + node.cone_cosine * sine,
          open_cosine = node.cone_cosine * cosine - cone_sine * sine;
    bool is_open = open_sine <= 0.0f;
    float arriving = likely_cosine(at_surface, cosine_of_difference(at_surface, cosine, sine), sine * sine);
    float sent = likely_cosine(at_lights, is_open ? 1.0f : cosine_of_difference(at_lights, open_cosine, open_sine),
        is_open ? 1.0f : 0.5f - 0.5f * open_cosine);
    return node.power * arriving * sent / quick_max(distance2, nearest_square * node.radius * node.radius);
}

LightTreeNode load_tree_node(LightListView list, uint number)
{
    return VKPT_FETCH(LightTreeNode, list.tables.tree_nodes, number);
}

// Where the surface is inside of the node's sphere, its children's bounds tell more than its own. A leaf's lights are
// weighed one by one later.
float weigh_tree_node(LightListView list, LightTreeNode node, uint number, Surface s)
{
    vec3 to_centre = node.centre - s.position;
    if (node.second == 0u || dot(to_centre, to_centre) > node.radius * node.radius)
        return weigh_tree_bounds(node, s);
    return weigh_tree_bounds(load_tree_node(list, number + 1u), s)
        + weigh_tree_bounds(load_tree_node(list, number + node.second), s);
}

// A run of the list's static lights, in the tree's order.
struct TreeLeaf {
    uint first;
    uint count;
    float probability;
    float rest; // of the random number
};

// Before the descent: no lights, which is what a list without static ones has.
TreeLeaf make_tree_leaf(float xi)
{
    TreeLeaf leaf;
    leaf.first = 0u;
    leaf.count = 0u;
    leaf.probability = 1.0f;
    leaf.rest = xi;
    return leaf;
}

// The leaf that `xi` leads to; with `place` >= 0, the one that holds that place of the tree's order. The list has
// static lights.
TreeLeaf descend_tree(LightListView list, Surface s, float xi, int place)
{
    uint number = list.tables.tree_roots.v[list.index];
    TreeLeaf leaf = make_tree_leaf(xi);
    leaf.count = list.range.static_count;
    uint second = 0u, first_count = 0u;
    if (leaf.count > LIGHT_TREE_LEAF) {
        LightTreeNode root = load_tree_node(list, number);
        second = root.second;
        first_count = root.first_count;
    }
    while (second != 0u) {
        LightTreeNode a = load_tree_node(list, number + 1u), b = load_tree_node(list, number + second);
        float weight_a = weigh_tree_node(list, a, number + 1u, s);
        float total = weight_a + weigh_tree_node(list, b, number + second, s);
        float share = total > 0.0f ? weight_a / total : 0.5f;
        bool takes_b = place >= 0 ? uint(place) >= leaf.first + first_count : leaf.rest >= share;
        float chance = takes_b ? 1.0f - share : share;
        leaf.probability *= chance;
        leaf.rest = quick_clamp((takes_b ? leaf.rest - share : leaf.rest) / chance, 0.0f, max_below_one);
        leaf.first += takes_b ? first_count : 0u;
        leaf.count = takes_b ? leaf.count - first_count : first_count;
        number += takes_b ? second : 1u;
        second = takes_b ? b.second : a.second;
        first_count = takes_b ? b.first_count : a.first_count;
    }
    return leaf;
}

LightListView lights_of_leaf(LightListView list, TreeLeaf leaf)
{
    return static_run(list, list.tables.tree_lights + leaf.first, leaf.count);
}

#endif

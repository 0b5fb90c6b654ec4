// SPDX-License-Identifier: GPL-2.0-or-later
// The light lists on the GPU: which emitters can light a point. See ref_vkpt/lights/light_lists.hpp.
#ifndef VKPT_LIB_LIGHT_LISTS
#define VKPT_LIB_LIGHT_LISTS

#include "../shared/functions.h"
#include "../shared/scene.h"
#include "device/whole_numbers.glsl"
#include "device/wide_loads.glsl"

VKPT_BUFFER(EmitterBuffer, Emitter, 16);
VKPT_BUFFER(PackedLightBuffer, PackedLight, 8);
VKPT_BUFFER(LightListBuffer, LightList, 16);
VKPT_BUFFER(LightIndexBuffer, uint, 4);
VKPT_BUFFER(LightstyleBuffer, float, 4);
VKPT_BUFFER(BspTreeBuffer, BspTreeNode, 8);
#define VKPT_SAMPLER_TABLE(name, type, alignment) VKPT_BUFFER(SamplerTable_##name, type, alignment);
#include "../shared/sampler_tables.def"

// Addresses of all tables, and the counts.
struct LightTables {
    EmitterBuffer emitters;
    PackedLightBuffer packed_lights;
    LightListBuffer lists; // one per cluster, then the one for points outside every cluster
    LightIndexBuffer static_indices;
    LightIndexBuffer dynamic_indices;
#define VKPT_SAMPLER_TABLE(name, type, alignment) SamplerTable_##name name;
#include "../shared/sampler_tables.def"
    LightstyleBuffer lightstyles; // one scale per lightstyle
    BspTreeBuffer tree;
    uint list_count;
    uint tree_lights; // so many static indices behind a list's lights they are once more, in its tree's order
};

// One list, ready to be read.
struct LightListView {
    LightTables tables;
    uint index; // of the list
    LightList range;
    // Lights that random numbers are spread over. Fewer than light_count() where an older sample is repeated: behind
    // the lights that its list held, each at its old place, come those that were not there yet.
    uint counted;
};

// The PVS cluster of a point, -1 in solid.
// Of a point's leaf: cluster + 1, and MEDIUM_* above (TREE_MEDIUM_SHIFT).
uint find_leaf(BspTreeBuffer tree, vec3 point)
{
    int child = 0;
    while (child >= 0) {
        BspTreeNode node = VKPT_FETCH(BspTreeNode, tree, uint(child));
        child = dot(point, node.normal) - node.dist >= 0.0f ? node.front : node.back;
    }
    return uint(-1 - child);
}

int find_cluster(BspTreeBuffer tree, vec3 point)
{
    return int(find_leaf(tree, point) & ((1u << TREE_MEDIUM_SHIFT) - 1u)) - 1;
}

uint find_medium(BspTreeBuffer tree, vec3 point) { return find_leaf(tree, point) >> TREE_MEDIUM_SHIFT; }

LightListView open_light_list(LightTables tables, int cluster)
{
    uint outside = tables.list_count - 1u;
    LightListView list;
    list.tables = tables;
    list.index = cluster < 0 ? outside : min(uint(cluster), outside);
    list.range = VKPT_FETCH(LightList, tables.lists, list.index);
    list.counted = list.range.static_count + list.range.dynamic_count;
    return list;
}

// A list as an older sample is to meet it: its lights at their old places, `counted` of them.
LightListView open_repeated_list(LightTables tables, int cluster, LightIndexBuffer previous_lengths)
{
    LightListView list = open_light_list(tables, cluster);
    list.counted = previous_lengths.v[list.index];
    return list;
}

uint light_count(LightListView list) { return list.range.static_count + list.range.dynamic_count; }

// What stands at a position of a list, or of a multiset, in which a light may have several entries.
struct LightEntry {
    uint emitter;
    float share; // of its light that this entry stands for: a power of two
};

LightEntry light_entry_at(LightListView list, uint position)
{
    uint word;
    if (position < list.range.static_count)
        word = VKPT_FETCH(LightIndex, list.tables.static_indices, list.range.first_static + position);
    else
        word = list.tables.dynamic_indices.v[list.range.first_dynamic + position - list.range.static_count];
    const uint bits_of_one = 0x3f800000u, exponent_shift = 23u;
    LightEntry entry;
    entry.emitter = word & ((1u << LIGHT_COPIES_SHIFT) - 1u);
    entry.share = uintBitsToFloat(bits_of_one - ((word >> LIGHT_COPIES_SHIFT) << exponent_shift));
    return entry;
}

// The emitter index at a position of the list; ascending.
uint light_at(LightListView list, uint position) { return light_entry_at(list, position).emitter; }

// The lights of a repeated sample's list that were there when it was drawn, and those that were not. Static lights
// always were.
LightListView counted_lights(LightListView list)
{
    list.range.dynamic_count = list.counted - list.range.static_count;
    return list;
}

bool has_newcomers(LightListView list) { return list.counted < light_count(list); }

LightListView newcomers(LightListView list)
{
    list.range.first_dynamic += list.counted - list.range.static_count;
    list.range.dynamic_count = light_count(list) - list.counted;
    list.range.static_count = 0u;
    list.counted = list.range.dynamic_count;
    return list;
}

LightListView static_lights(LightListView list)
{
    list.range.dynamic_count = 0u;
    list.counted = list.range.static_count;
    return list;
}

// Newcomers included, behind those that are counted.
LightListView dynamic_lights(LightListView list)
{
    list.counted -= list.range.static_count;
    list.range.static_count = 0u;
    return list;
}

// `count` static indices from the `first` after the list's own on, and no dynamic light.
LightListView static_run(LightListView list, uint first, uint count)
{
    list.range.first_static += first;
    list.range.static_count = list.counted = count;
    list.range.dynamic_count = 0u;
    return list;
}

// The same lights with each static one as often as the cluster's multiset has it. All else that takes a list takes
// this, too, but for find_light.
LightListView open_multiset(LightListView list)
{
    LightMultiset multiset = list.tables.multisets.v[list.index];
    list.counted += multiset.count - list.range.static_count;
    list.range.first_static = multiset.first;
    list.range.static_count = multiset.count;
    return list;
}

// Where an emitter stands in a sorted part of the list, -1: nowhere. Without duplicates, places are no farther apart
// than indices: every index that is read bounds the place from both sides, and in a run of neighbouring emitters gives
// it away.
int find_light_in(LightListView list, uint emitter, uint first, uint end)
{
    if (first >= end)
        return -1;
    uint lowest = light_at(list, first), highest = light_at(list, end - 1u);
    if (emitter < lowest || emitter > highest)
        return -1;
    uint low = end - 1u - min(highest - emitter, end - 1u - first);
    uint high = min(end, first + (emitter - lowest) + 1u);
    while (low < high) {
        uint middle = (low + high) / 2u;
        uint there = light_at(list, middle);
        if (there == emitter)
            return int(middle);
        if (there < emitter) {
            low = middle + 1u;
            high = min(high, middle + (emitter - there) + 1u);
        } else {
            high = middle;
            low = max(low, middle - min(there - emitter, middle));
        }
    }
    return -1;
}

// Where an emitter stands in the list, -1: nowhere.
int find_light(LightListView list, uint emitter)
{
    int place = find_light_in(list, emitter, 0u, list.counted);
    return place >= 0 ? place : find_light_in(list, emitter, list.counted, light_count(list));
}

// Where one of an emitter's entries stands in a multiset, -1: it has none. xi in [0, 1) chooses among them.
int find_light_entry(LightListView list, uint emitter, float xi)
{
    uint low = 0u, high = list.range.static_count;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (light_at(list, middle) < emitter)
            low = middle + 1u;
        else
            high = middle;
    }
    if (low < list.range.static_count) {
        LightEntry first = light_entry_at(list, low);
        if (first.emitter == emitter)
            return int(low + floor_to_uint(xi / first.share));
    }
    int place = find_light_in(list, emitter, list.range.static_count, list.counted);
    return place >= 0 ? place : find_light_in(list, emitter, list.counted, light_count(list));
}

// With its lightstyle applied.
Emitter load_emitter(LightListView list, uint emitter)
{
    Emitter e = VKPT_FETCH(Emitter, list.tables.emitters, emitter);
    e.radiance *= list.tables.lightstyles.v[e.lightstyle];
    return e;
}

#endif

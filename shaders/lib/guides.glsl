// SPDX-License-Identifier: GPL-2.0-or-later
// Bounce rays that aim at the bright small places of a room: blocks of the light cache's cells. One guide of the
// cluster's list is chosen by what it is likely to send, a cell of it by its share, and a point on the cell. The ray
// counts if it ends in that block, and shares what it brings by MIS with the BSDF ray that meets the block by chance:
// the mean is that of BSDF rays alone, whatever the lists say.
#ifndef VKPT_LIB_GUIDES
#define VKPT_LIB_GUIDES

#include "light_cache.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer GuideEntryBuffer { uint v[]; };

// Entries of a list that are weighed for a choice: every n-th from a random one on, as the chapter's subsets of lights.
const uint guides_per_choice = 16u;

// The guides of a surface's cluster, of whose subset one is chosen.
struct Guides {
    uint first, count; // entries of the list
    uint stride, offset; // the subset: entries first + offset, first + offset + stride, ...
    float total; // of the subset's weights; 0: none is aimed at
    uint chosen; // entry
    float weight; // of the chosen one
    float rest; // what the choice has left of its random number
};
const Guides no_guides = Guides(0u, 0u, 1u, 0u, 0.0, 0u, 0.0, 0.0);

struct GuideSample {
    uint guide;
    vec3 direction;
    float pdf; // per solid angle; 0: none
};

uint guide_of_entry(uint entry) { return GuideEntryBuffer(frame.scene.cache.guide_entries).v[entry]; }

// About what the surface receives of an entry's guide.
float weigh_guide(Surface s, uint entry)
{
    uvec4 words = load_element(frame.scene.cache.guides, entry, uvec4(0u));
    vec3 way = uintBitsToFloat(words.xyz) - s.position;
    vec2 bits = unpack_snorm4_times_127(words.w).xy * (1.0 / 127.0);
    vec3 normal = vec3(bits, 1.0 - abs(bits.x) - abs(bits.y));
    vec2 folded = (1.0 - abs(bits.yx)) * vec2(bits.x < 0.0 ? -1.0 : 1.0, bits.y < 0.0 ? -1.0 : 1.0);
    normal.xy = normal.z < 0.0 ? folded : bits;
    float distance2 = dot(way, way), power = unpack_positive_half(words.w >> 16u);
    float cosines = quick_max(dot(way, s.normal), 0.0) * quick_max(-dot(way, normal), 0.0);
    // Never nearer than half a block is large.
    const float nearest2 = 1024.0;
    return power * cosines / (quick_max(distance2, 1e-6) * quick_max(distance2, nearest2));
}

uvec4 group_of_entries(Guides guides, uint place)
{
    return guides.first + min(guides.offset + (place + uvec4(0u, 1u, 2u, 3u)) * guides.stride, guides.count - 1u);
}

// Weights of the subset's entries from this place on; 0 behind its end.
vec4 weigh_group(Guides guides, Surface s, uint place)
{
    uvec4 entry = group_of_entries(guides, place);
    vec4 w = vec4(weigh_guide(s, entry.x), weigh_guide(s, entry.y), weigh_guide(s, entry.z), weigh_guide(s, entry.w));
    uvec4 at = guides.offset + (place + uvec4(0u, 1u, 2u, 3u)) * guides.stride;
    return mix(w, vec4(0.0), greaterThanEqual(at, uvec4(guides.count)));
}

float sum_of(vec4 w) { return (w.x + w.y) + (w.z + w.w); }

// One of four by what is left of the random number. `place` in the subset: of the first of the four.
void choose_in_group(inout Guides guides, uint place, vec4 weights, float xi)
{
    float threshold = xi * sum_of(weights), before = 0.0;
    UNROLLED_FOR (uint i = 0u; i < 4u; i++) {
        bool taken = weights[i] > 0.0 && threshold >= before;
        guides.chosen = taken ? guides.first + guides.offset + (place + i) * guides.stride : guides.chosen;
        guides.weight = taken ? weights[i] : guides.weight;
        guides.rest = taken ? threshold - before : guides.rest;
        before += weights[i];
    }
    guides.rest = quick_clamp(guides.rest / quick_max(guides.weight, 1e-30), 0.0, 0.99999994);
}

// One sweep over a random subset: Listing 47-2, as update_reservoir in light_sampler.glsl, over groups of four, of
// which each costs a division.
Guides open_guides(Surface s, int cluster, float xi)
{
    Guides guides = no_guides;
    if ((frame.flags & FRAME_GUIDES) == 0u || cluster < 0)
        return guides;
    uvec2 list = load_element(frame.scene.cache.guide_lists, uint(cluster), uvec2(0u));
    guides.first = list.x;
    guides.count = list.y;
    guides.stride = max((list.y + guides_per_choice - 1u) / guides_per_choice, 1u);
    xi *= float(int(guides.stride));
    guides.offset = min(floor_to_uint(xi), guides.stride - 1u);
    xi = quick_clamp(xi - float(int(guides.offset)), 0.0, 0.99999994);
    vec4 weights = vec4(0.0); // of the chosen group
    uint place = 0u;
    ROLLED_FOR (uint i = 0u; guides.offset + i * guides.stride < guides.count; i += 4u) {
        vec4 w = weigh_group(guides, s, i);
        float group = sum_of(w), before = guides.total;
        guides.total += group;
        float threshold = xi * guides.total;
        bool offered = group > 0.0, taken = offered && threshold >= before;
        place = taken ? i : place;
        weights = taken ? w : weights;
        float rest = (taken ? threshold - before : threshold) / (taken ? group : before);
        xi = offered ? quick_clamp(rest, 0.0, 0.99999994) : xi;
    }
    choose_in_group(guides, place, weights, xi);
    return guides;
}

// The probability that this entry of the list is chosen, whichever subset the random number names.
float guide_probability(Guides guides, Surface s, uint entry)
{
    uint offset = remainder_whole(entry - guides.first, guides.stride);
    bool summed = offset == guides.offset;
    float weight = 0.0, total = summed ? guides.total : 0.0;
    ROLLED_FOR (uint place = summed ? entry - guides.first : offset; place < guides.count; place += guides.stride) {
        float w = weigh_guide(s, guides.first + place);
        weight = guides.first + place == entry ? w : weight;
        total += summed ? 0.0 : w;
        if (summed)
            break;
    }
    return total > 0.0 ? weight / (total * float(int(guides.stride))) : 0.0;
}

CacheGuideBlock load_guide_block(uint guide)
{
    uint64_t address = frame.scene.cache.guide_blocks + uint64_t((guide - 1u) * 64u);
    uvec4 a = load_element(address, 0u, uvec4(0u)), b = load_element(address, 1u, uvec4(0u)),
          c = load_element(address, 2u, uvec4(0u)), d = load_element(address, 3u, uvec4(0u));
    return CacheGuideBlock(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), 0u, uintBitsToFloat(c.xyz), 0u,
        uint[4](d.x, d.y, d.z, d.w));
}

// Without an index that only the lane knows: CPU drivers keep such an array in memory.
uint share_of_cell(CacheGuideBlock block, uint cell)
{
    uint lower = cell < CACHE_GUIDE_SIDE ? block.shares[0] : block.shares[1],
         upper = cell < 3u * CACHE_GUIDE_SIDE ? block.shares[2] : block.shares[3];
    return ((cell < 2u * CACHE_GUIDE_SIDE ? lower : upper) >> (cell % CACHE_GUIDE_SIDE * 8u)) & 0xffu;
}

// Density, per solid angle at `from`, of a point in one of the block's cells, the block being chosen with this
// probability.
float guide_density(CacheGuideBlock block, uint cell, float probability, vec3 from, vec3 point)
{
    vec3 way = point - from;
    float distance2 = dot(way, way),
          height = abs(dot(way, cross(block.across, block.down))); // distance * area * cosine
    float share = float(int(share_of_cell(block, cell))) / float(int(block.total));
    return height > 0.0 ? probability * share * distance2 * sqrt(distance2) / height : 0.0;
}

// By its share; xi in [0, 1).
uint choose_cell(CacheGuideBlock block, float xi)
{
    uint threshold = min(floor_to_uint(xi * float(int(block.total))), block.total - 1u), sum = 0u, chosen = 0u;
    UNROLLED_FOR (uint cell = 0u; cell < CACHE_GUIDE_SIDE * CACHE_GUIDE_SIDE; cell++) {
        uint share = share_of_cell(block, cell);
        chosen = share > 0u && sum <= threshold ? cell : chosen;
        sum += share;
    }
    return chosen;
}

GuideSample sample_guide(Guides guides, Surface s, vec2 xi)
{
    GuideSample result;
    result.guide = guide_of_entry(guides.chosen);
    CacheGuideBlock block = load_guide_block(result.guide);
    uint cell = choose_cell(block, guides.rest);
    vec2 place = vec2(ivec2(cell % CACHE_GUIDE_SIDE, cell / CACHE_GUIDE_SIDE)) + xi;
    vec3 point = block.corner + block.across * place.x + block.down * place.y;
    result.direction = normalize(point - s.position);
    result.pdf
        = guide_density(block, cell, guides.weight / (guides.total * float(int(guides.stride))), s.position, point);
    return result;
}

// Density with which sample_guide would have aimed at this point of a guide. Entries are sorted.
float pdf_guide(Guides guides, Surface s, uint guide, vec3 point)
{
    uint low = guides.first, end = guides.first + guides.count, high = end;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (guide_of_entry(middle) < guide)
            low = middle + 1u;
        else
            high = middle;
    }
    if (low == end || guide_of_entry(low) != guide)
        return 0.0;
    CacheGuideBlock block = load_guide_block(guide);
    vec3 way = point - block.corner;
    vec2 place = vec2(
        dot(way, block.across) / dot(block.across, block.across), dot(way, block.down) / dot(block.down, block.down));
    uvec2 at = min(floor_to_uint(max(place, vec2(0.0))), uvec2(CACHE_GUIDE_SIDE - 1u));
    return guide_density(block, at.y * CACHE_GUIDE_SIDE + at.x, guide_probability(guides, s, low), s.position, point);
}

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// The light cache: squares on the map's faces, and the light that arrives at each. docs/light-cache.md tells the
// method.
#ifndef VKPT_SHARED_LIGHT_CACHE_H
#define VKPT_SHARED_LIGHT_CACHE_H

#include "language.h"

VKPT_SHARED_BEGIN

VKPT_CONST uint CACHE_LAYERS = 4u; // of a face at most, one for each lightstyle whose lights it may see
VKPT_CONST uint CACHE_NO_STYLE = 0xffffu; // of a layer that there is not
VKPT_CONST uint CACHE_SIZE_BITS = 12u; // of either number of a face's cells
// The last word of a value, from its lowest bits on: samples in it; schlick_power of the light's angle on average;
// number of the guide that the cell is of, 0: none.
VKPT_CONST uint CACHE_COUNT_MASK = 0xffu;
VKPT_CONST uint CACHE_POWER_SHIFT = 8u;
VKPT_CONST uint CACHE_GUIDE_SHIFT = 16u;
VKPT_CONST uint CACHE_MAX_GUIDE_BLOCKS = 0xffffu; // in a map
VKPT_CONST uint CACHE_MIN_SAMPLES = 8u; // with fewer a value is not used
VKPT_CONST uint CACHE_MAX_SAMPLES = 128u; // from here on older samples are forgotten: doors open
VKPT_CONST uint CACHE_ROW = 256u; // cells in a row of an update's grid
VKPT_CONST uint CACHE_MAX_UPDATED = 8192u; // cells that one dispatch updates: devices stop what takes too long

// What readers need of a face of the map. One for each, in their order.
struct CacheFace {
    vec4 across; // dot(point, xyz) + w: place in cells
    vec4 down;
    uint first_value; // a cell's layers follow one another, cells row by row
    uint size; // cells across | down << CACHE_SIZE_BITS | layers << 2 * CACHE_SIZE_BITS; 0: the face has no cells
    uint styles[2]; // lightstyles of the layers, 16 bits each
};
VKPT_ASSERT_SIZE(CacheFace, 48);

// What updates need of it beside that.
struct CacheFacePlane {
    vec3 origin; // of the first cell
    uint first_corner;
    vec3 across; // edge of a cell
    uint corner_count;
    vec3 down;
    int cluster; // of all of the face, -1: look it up by position
    vec3 normal;
    uint padding;
};
VKPT_ASSERT_SIZE(CacheFacePlane, 64);

struct CacheCell {
    uint face;
    uint first_value;
    uint centre; // of the part of the face that lies in the cell: 16 bits each, in cells
    uint padding;
};
VKPT_ASSERT_SIZE(CacheCell, 16);

// What a cell knows of the lights of one style, at scale 1.
struct CacheValue {
    uint light[2]; // irradiance / pi: three floats without sign and the lowest ten bits
    uint direction; // mean direction to the light, 10 bits a component; shorter the more it is spread
    uint last;
};
VKPT_ASSERT_SIZE(CacheValue, 16);

// The same light in parts, by where it comes from: what metals reflect of it. The parts of a value follow one another;
// see lobe_of_direction in lib/light_cache.glsl.
struct CacheLobe {
    uint light; // pack_rgb9e5
    uint direction; // as CacheValue
};
VKPT_ASSERT_SIZE(CacheLobe, 8);
VKPT_CONST uint CACHE_LOBES = 8u;

// A block of cells of a face, some of which stand out: bright and small, so that bounce rays seldom meet them and then
// bring much. They are aimed at. What a block is weighed by:
struct CacheGuide {
    vec3 centre; // of what it sends
    uint look; // radiance times area (16-bit float, upper half) and normal (octahedral, 8 bits each). The normal is of
               // the octahedron, not of unit length: what it is longer or shorter, the radiance makes up for
};
VKPT_ASSERT_SIZE(CacheGuide, 16);
VKPT_CONST uint CACHE_GUIDE_SIDE = 4u; // cells along a block's edge

// The block itself, from a corner.
struct CacheGuideBlock {
    vec3 corner;
    uint total; // of the shares
    vec3 across; // edge of a cell
    uint padding;
    vec3 down;
    uint more_padding;
    uint shares[CACHE_GUIDE_SIDE]; // of what the block sends: a row of cells each, a byte a cell
};
VKPT_ASSERT_SIZE(CacheGuideBlock, 64);

// Those that a cluster's points aim at: entries of a table of guides' numbers, from 1, ascending, and of what they are
// weighed by.
struct CacheGuideList {
    uint first;
    uint count;
};
VKPT_ASSERT_SIZE(CacheGuideList, 8);
VKPT_CONST uint CACHE_MAX_GUIDES = 96u; // in a list

// Addresses of the cache's tables, and what is updated.
struct LightCacheView {
    uint64_t faces; // CacheFace
    uint64_t planes; // CacheFacePlane
    uint64_t cells; // CacheCell
    uint64_t corners; // of the faces, vec2 in cells
    uint64_t values; // CacheValue: those that rays read, then as many that updates work on
    uint64_t lobes; // CacheLobe, CACHE_LOBES for each value: in the same order, those that rays read first
    uint64_t guides; // CacheGuide, one for each entry
    uint64_t guide_blocks; // CacheGuideBlock
    uint64_t guide_lists; // CacheGuideList, one for each cluster
    uint64_t guide_entries;
    uint cell_count; // 0: the map has no cache
    uint first_updated;
    uint updated; // cells
    uint samples; // of each of them
    uint first_sample; // so many were taken of each before
    uint value_count; // that rays read
};

VKPT_SHARED_END

#endif

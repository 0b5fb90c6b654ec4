// SPDX-License-Identifier: GPL-2.0-or-later
// What the rays meet: triangles, materials, emitters, light lists. One definition for both sides.
// Space: Quake world units. Radiance: linear RGB, where a diffuse white surface under a lightmap value of 128 has
// radiance 1.
#ifndef VKPT_SHARED_SCENE_H
#define VKPT_SHARED_SCENE_H

#include "language.h"

VKPT_SHARED_BEGIN

// Ray masks: a ray meets a triangle if (ray mask & triangle mask) != 0.
VKPT_CONST uint MASK_OPAQUE = 1u; // solid world and models
VKPT_CONST uint MASK_TRANSLUCENT = 2u; // water, glass, translucent models: let shadow rays pass
VKPT_CONST uint MASK_ALPHA_TEST = 4u; // opaque where the texture's alpha is >= 0.5
VKPT_CONST uint MASK_VIEW_WEAPON = 8u; // seen by camera rays only
VKPT_CONST uint MASK_OWN_BODY = 16u; // the player's own model: seen by all but camera rays
VKPT_CONST uint MASK_SKY = 32u; // sky faces
VKPT_CONST uint MASK_FILTER = 64u; // liquids and glass of maps, translucent ones too: what passes them is coloured
VKPT_CONST uint MASK_ALL = 0xffu;

// Triangle::emitter: emits nothing, or is not in the light lists; is seen to shine, but other emitters of its face send
// its light.
VKPT_CONST int EMITTER_UNLISTED = -1;
VKPT_CONST int EMITTER_SAMPLED_APART = -2;

// What fills a part of space. Triangle::medium: of the liquid that the face bounds, and on which side it is.
VKPT_CONST uint MEDIUM_NONE = 0u;
VKPT_CONST uint MEDIUM_WATER = 1u;
VKPT_CONST uint MEDIUM_SLIME = 2u;
VKPT_CONST uint MEDIUM_LAVA = 3u;
VKPT_CONST uint MEDIUM_MASK = 3u;
VKPT_CONST uint MEDIUM_IN_FRONT = 4u; // the liquid is before the face, not behind it

// One entry per triangle id (the id that a trace returns).
struct Triangle {
    vec3 positions[3]; // cross(p1 - p0, p2 - p0) points to the front
    vec2 uvs[3]; // texture coordinates, 1 = one texture width
    uint normals[3]; // shading normals, octahedral, 2 x 16 bit snorm
    uint material; // index into the material table
    int emitter; // index into the emitter table, or EMITTER_UNLISTED, EMITTER_SAMPLED_APART
    int cluster; // PVS cluster if all of it lies in one, else -1: look it up by position
    uint lightstyle; // scales the material's emission
    int face; // of the map, from 1; negative: of a brush model, where the light cache has nothing; 0: none
    uint medium; // MEDIUM_*
};
VKPT_ASSERT_SIZE(Triangle, 96);

// The box around some of the map's faces that colour light (MASK_FILTER).
struct FilterBox {
    vec3 mins;
    vec3 maxs;
};
VKPT_ASSERT_SIZE(FilterBox, 24);
VKPT_CONST uint MAX_FILTER_BOXES = 8u;

// Fog in a box. Its density at p, per unit: max(0, density + dot(gradient, p)).
struct FogBox {
    vec3 mins;
    float density;
    vec3 maxs;
    vec3 gradient;
    vec3 radiance; // of fog that nothing is seen through
};
VKPT_ASSERT_SIZE(FogBox, 52);
VKPT_CONST uint MAX_FOG_BOXES = 8u;

// A face's baked lightmaps: luxels of 16 units, row by row, those of further lightstyles behind.
struct LightmapFace {
    vec2 scale; // uv * scale + offset: place in luxels, whole numbers being their middles
    vec2 offset;
    uint first; // luxel; a word each, RGB, red in the lowest byte
    uint size; // luxels across | down << 16; 0: the face has none
    uint styles; // 8 bits each, 255: none
    uint padding;
};
VKPT_ASSERT_SIZE(LightmapFace, 32);

VKPT_CONST uint MATERIAL_SKY = 1u; // radiance comes from the sky
VKPT_CONST uint MATERIAL_WARP = 2u; // liquid: turbulent texture, refracting surface
VKPT_CONST uint MATERIAL_TRANSLUCENT = 4u; // `opacity` < 1
VKPT_CONST uint MATERIAL_ALPHA_TEST = 8u;
VKPT_CONST uint MATERIAL_FULLBRIGHT = 16u; // shown as its texture, unlit
VKPT_CONST uint MATERIAL_PARTICLE
    = 32u; // a disc in the square of its uv, as bright on the screen in dark rooms as in bright ones
VKPT_CONST uint MATERIAL_SQUARE = 64u; // a particle without the disc's soft edge
VKPT_CONST uint MATERIAL_GLASS = 128u; // a thin pane: translucent, smooth, colours what is behind
// With a normal map, what the two textures' alpha may hold.
VKPT_CONST uint MATERIAL_ROUGHNESS_IN_ALPHA = 256u; // of `texture`; `roughness` is the least
VKPT_CONST uint MATERIAL_METALNESS_IN_ALPHA = 512u; // of the normal map; times `metallic`

// How much of a coat's reflectance is missing, in 1 / MATERIAL_COAT_ONE.
VKPT_CONST uint MATERIAL_COAT_SHIFT = 11u;
VKPT_CONST uint MATERIAL_COAT_ONE = 31u;

// A screen that shows what the map's camera sees that is entry flags >> MATERIAL_SCREEN_SHIFT of SceneView::screens.
VKPT_CONST uint MATERIAL_SCREEN = 1024u;
VKPT_CONST uint MATERIAL_SCREEN_SHIFT = 16u;

struct Material {
    vec3 tint; // multiplies the texture
    float opacity; // 1 opaque
    vec3 emission; // radiance = emission * colour of the emissive map, or of the texture where there is none
    float roughness; // GGX alpha = roughness^2
    float metallic;
    uint texture; // bindless index
    uint flags; // MATERIAL_*
    vec2 uv_scroll; // added to uv, already multiplied by time
    uint texture_size; // width | height << 16 of its first level; it has all levels down to one texel
    // Bindless indices of the normal map (how its texels are stored: ref_vkpt/scene/normal_maps.hpp) and, above 16
    // bits, of the emissive map; 0: none.
    uint maps;
    // From the lowest bits: how far the normal map tilts the normal, in 1 / MATERIAL_BUMP_ONE; the mip of the normal
    // map less that of `texture` for one footprint, in 1 / MATERIAL_MIP_ONE, signed; the same of the emissive map.
    uint map_scales;
};
VKPT_ASSERT_SIZE(Material, 64);
VKPT_CONST uint MATERIAL_BUMP_BITS = 12u, MATERIAL_MIP_BITS = 10u;
VKPT_CONST float MATERIAL_BUMP_ONE = 256.0f;
VKPT_CONST float MATERIAL_MIP_ONE = 32.0f;

// What a part of a texture shows of a camera's picture.
struct Screen {
    vec2 area_mins; // of the texture, whose width and height are 1
    vec2 area_size;
    vec3 eye;
    vec3 corner; // from there to what the area's upper left corner shows
    vec3 across; // and how that changes to the upper right,
    vec3 down; // and to the lower left corner
    uint medium; // MEDIUM_* that the eye is in
};
VKPT_ASSERT_SIZE(Screen, 68);
VKPT_CONST uint MAX_SCREENS = 16u;

VKPT_CONST uint EMITTER_TRIANGLE = 0u; // one-sided, front as in Triangle
VKPT_CONST uint EMITTER_SPHERE = 1u; // p0 centre, p1.x radius; a spot has a cone, see CONE_SLACK
VKPT_CONST uint EMITTER_SKY
    = 2u; // triangle whose radiance is the sky's in the ray's direction; `radiance` is the average
VKPT_CONST uint EMITTER_TRANSPARENT
    = 3u; // triangle that bounce rays pass, all of it or its holes: translucent or alpha-tested

VKPT_CONST uint EMITTER_SUN = 4u; // sphere as far away as SUN_DISTANCE: shines where nothing is between it and the sky

// The light of a spot fades with the cosine between its axis, p2, and the direction to the receiver: all of it at the
// cosine p1.z, none below that less 1 / p1.y. p1.y = 0: no cone. Outlines hold the lower cosine less CONE_SLACK, so
// that rounding hides no light.
VKPT_CONST float CONE_SLACK = 3e-4f;

VKPT_CONST float SUN_DISTANCE = 1e7f; // its direction then differs by less than 0.05 degrees over a map

struct Emitter {
    vec3 p0;
    uint type; // EMITTER_*
    vec3 p1;
    uint lightstyle; // scales radiance; lightstyle 0 is the steady one
    vec3 p2;
    float area; // triangle: area; sphere: 4 pi r^2
    vec3 radiance; // average over the emitter, before lightstyle
    float reach; // no light farther than this from p0 (engine dlights); 0: no limit
};
VKPT_ASSERT_SIZE(Emitter, 64);

// What the weight of an emitter depends on, its lightstyle applied: all that is read of the lights among which one is
// chosen, and therefore small. pack_light_shape (ref_vkpt/lights/packed_lights.hpp) packs it, unpack_light_shape
// (lib/light_sampler.glsl) unpacks it.
struct PackedLight {
    vec3 p0;
    // A float without its lowest bits, luminance; its sign bit is set for spheres. In the lowest 9 bits, the exponent
    // of a power of two that is no less than any component of p1 - p0 and p2 - p0, with a float's bias.
    uint radiance;
    // Triangle: six floats without their lowest bits, PACKED_LIGHT_BITS of p1 - p0 and p2.x - p0.x at the top of a word
    // each; what the four words have left holds the highest PACKED_LIGHT_MORE_BITS of p2.y - p0.y (words 0 and 1) and
    // p2.z - p0.z. Sphere: radius, reach, a cone's axis (octahedral) and its inner and outer cosine (2 x 16 bit snorm;
    // 0: no cone).
    uint shape[4];
};
VKPT_CONST uint PACKED_LIGHT_BITS = 21u; // of a float: relative error 2^-13
VKPT_CONST uint PACKED_LIGHT_MORE_BITS = 22u; // of those in what is left: 2 * (32 - PACKED_LIGHT_BITS)
VKPT_CONST uint PACKED_LIGHT_RADIANCE_MASK = 0x7ffffe00u; // relative error 2^-14
VKPT_CONST float PACKED_LIGHT_ERROR = 1.220703125e-4f;
VKPT_ASSERT_SIZE(PackedLight, 32);

// The light list of a cluster is the concatenation of two ranges, ascending by emitter index and free of duplicates
// over both: static_indices[first_static .. + static_count) and dynamic_indices[first_dynamic .. + dynamic_count).
struct LightList {
    uint first_static;
    uint static_count;
    uint first_dynamic;
    uint dynamic_count;
};
VKPT_ASSERT_SIZE(LightList, 16);

// A list's static lights once more, each as many times as it is likely to matter to the cluster's points: a power of
// two. A light's entries follow one another, and each stands for an equal share of its light. See
// ref_vkpt/lights/light_multisets.hpp.
struct LightMultiset {
    uint first; // entry of the table of static indices
    uint count;
};
VKPT_ASSERT_SIZE(LightMultiset, 8);
// An entry of the static indices: emitter index, and above it the binary logarithm of how often the light is there, 0
// in lists.
VKPT_CONST uint LIGHT_COPIES_SHIFT = 27u;

// A list's static lights as a binary tree of their bounds, in preorder: the first child lies right behind its parent.
// The lights are in an order of their own, in which each node's follow one another. See
// ref_vkpt/lights/light_trees.hpp.
struct LightTreeNode {
    vec3 centre; // of a sphere that holds the lights
    float radius;
    vec3 axis; // of a cone that holds the directions that they face
    float cone_cosine; // of its half angle; -1: all directions
    float power; // luminance times area, lightstyles at 1
    uint second; // how many nodes behind its parent the second child lies; 0: a leaf
    uint first_count; // lights of the first child
    uint padding;
};
VKPT_ASSERT_SIZE(LightTreeNode, 48);
VKPT_CONST uint LIGHT_TREE_LEAF = 8u; // a leaf has so many lights at most

// BSP tree for finding a point's cluster and medium. child >= 0: node; < 0: the number -1 - child holds the cluster + 1
// (0: solid), and above TREE_MEDIUM_SHIFT bits MEDIUM_*.
VKPT_CONST uint TREE_MEDIUM_SHIFT = 20u;
struct BspTreeNode {
    vec3 normal;
    float dist;
    int front, back;
};
VKPT_ASSERT_SIZE(BspTreeNode, 24);

VKPT_SHARED_END

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// What every pass of a frame knows. One uniform buffer, written once per 3D view.
#ifndef VKPT_SHARED_FRAME_H
#define VKPT_SHARED_FRAME_H

#include "language.h"
#include "scene.h"
#include "cvars.h"
#include "light_cache.h"
#include "light_visibility.h"
#include "trace.h"

VKPT_SHARED_BEGIN

VKPT_CONST uint SAMPLER_REPEAT = 0u;
VKPT_CONST uint SAMPLER_CLAMP = 1u;
VKPT_CONST uint SAMPLER_REPEAT_NEAREST = 2u;
VKPT_CONST uint SAMPLER_CLAMP_NEAREST = 3u;
VKPT_CONST uint SAMPLER_COUNT = 4u;

// Passes over the screen: 64 lanes take a tile of 8 x 8 pixels, on the CPU driver PIXEL_TILES_PER_GROUP one after the
// other (lib/device/lanes.glsl).
VKPT_CONST uint PIXEL_GROUP_SIZE = 64u;
VKPT_CONST uint PIXEL_TILES_PER_GROUP = 8u;

VKPT_CONST uint STRATUM_BLOCKS = 3u; // A-SVGF: of so many by so many bounce blocks one repeats an older sample

VKPT_CONST uint OFFSETS_PER_PIXEL
    = 16u; // camera rays pass through so many places of each pixel of the result, one after the other

VKPT_CONST uint FRAME_ALPHA_TEST = 1u; // the scene has alpha-tested triangles
VKPT_CONST uint FRAME_NO_WORLD = 2u; // a view of models alone (menus): lit by a fixed light, no sky
VKPT_CONST uint FRAME_UNDERWATER = 4u; // the eye is in a liquid
VKPT_CONST uint FRAME_PROBES = 8u; // surfaces come from a list of points, not from the camera
VKPT_CONST uint FRAME_JITTER = 16u; // camera rays spread over the pixel: accumulation smooths edges
VKPT_CONST uint FRAME_PROBE_VISIBILITY = 32u; // probe_rays.comp asks whether anything is met, not for the nearest

VKPT_CONST uint FRAME_HISTORY = 64u; // the buffers named previous_ hold the last view of this scene
VKPT_CONST uint FRAME_REPROJECTED = 512u; // primary_visibility tells where things were in the last view
VKPT_CONST uint FRAME_DENOISED = 128u; // the image is made from the filtered light
VKPT_CONST uint FRAME_ANTIALIASED = 1024u; // the image is averaged over views
VKPT_CONST uint FRAME_REPLAYED
    = 256u; // random numbers follow the buffer random_seed: some pixels repeat an older sample
VKPT_CONST uint FRAME_BLOOM = 2048u; // the image is mixed with what bloom_*.comp made of it
VKPT_CONST uint FRAME_LAYERED = 8192u; // pixels share out what glass and water show, and are mixed by blend_layers
VKPT_CONST uint FRAME_NEAREST_TEXELS = 262144u; // large texels of images are shown as squares
VKPT_CONST uint FRAME_LIGHT_CACHE = 524288u; // bounce rays may end in the light cache
VKPT_CONST uint FRAME_GUIDES = 1048576u; // and are aimed at what stands out in it
VKPT_CONST uint FRAME_FOG = 2097152u; // there is fog
VKPT_CONST uint FRAME_GOD_RAYS = 4194304u; // and it scatters a sun's light
VKPT_CONST uint FRAME_WIPE = 8388608u; // a part of the image shows baked lightmaps
VKPT_CONST uint FRAME_PUBLISH_VISIBILITY = 16777216u; // the next views use what shadow rays have told since
VKPT_CONST uint FRAME_CACHE_BIAS = 33554432u; // the image is by how much the light cache is wrong
VKPT_CONST uint FRAME_COUNT_RAYS = 4096u; // every ray is counted in `ray_counts`
VKPT_CONST uint FRAME_SPATIAL = 16384u; // the denoiser also filters over neighbours
VKPT_CONST uint FRAME_FULLBRIGHT = 32768u; // r_fullbright: surfaces show their images
VKPT_CONST uint FRAME_LIGHT_ALONE = 65536u; // r_lightmap: all surfaces are white
VKPT_CONST uint FRAME_GREY_LIGHT = 131072u; // not gl3_colorlight

// What one of the engine's dynamic lights does to surfaces around it, without their angle: colour * (intensity -
// distance).
struct Dlight {
    vec3 origin;
    float intensity;
    vec3 colour; // of the light on a white wall
};
VKPT_ASSERT_SIZE(Dlight, 28);

// Rays of a view, by what they were asked.
struct RayCounts {
    uint nearest;
    uint visible;
};

VKPT_CONST uint LIGHT_LEVEL_LANES = 64u; // = PIXEL_GROUP_SIZE

// Automatic exposure's memory.
struct ExposureState {
    float exposure; // what radiance is multiplied with
    float adapted_log2;
    uint valid; // 0: no frame seen yet
};

struct ScreenBuffer {
    uint64_t address;
    uint texels; // its number in descriptor set 3, where tables are read as texels
    uint unused;
};

struct ScreenBuffers {
#define VKPT_SCREEN_BUFFER(type, name) ScreenBuffer name;
#include "screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
};

VKPT_CONST uint SCREEN_BUFFER_COUNT = 0u
#define VKPT_SCREEN_BUFFER(type, name) +1u
#include "screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
    ;

// What the passes count for the CPU.
struct FrameStatistics {
    uint nonfinite_pixels; // whose light was not a number, or infinite; they are shown black
    // The light of some pixels, and what the limit on fireflies took of it, in 4096ths of the image's range.
    uint sampled_light;
    uint cut_light;
};

VKPT_CONST uint BLOOM_FIRST_STEP
    = 4u; // the pyramid's first level has a pixel for so many of the image's, in either direction

// One level of the bloom's pyramid, which is made smaller from, or added to, another (push constants).
struct BloomPush {
    uint64_t source; // uvec2: rgb, 16 bits each; 0: the image's radiance
    uint64_t target;
    uvec2 source_size;
    uvec2 target_size;
    float own_share; // bloom_grow: of the target; what is left is the coarser levels'
};

// What one level of denoise/denoise_gradient_filter.comp is told (push constants).
struct GradientFilterPush {
    ScreenBuffer source; // of the type of the buffer `gradient_a`
    ScreenBuffer target;
    uint step; // pixels between taps
    uint level; // from 0
};

// What a level of denoise/denoise_atrous.glsl is told (push constants).
struct AtrousPush {
    ScreenBuffer source; // of the type of the buffer `filtered`
    ScreenBuffer target; // of the last level: none
    ivec2 way; // pixels to the first tap
};

// What inspect_pixel.comp is told (push constants).
struct InspectPush {
    uint64_t surface;
    uint64_t lights;
    uint pixel; // index in the screen buffers
    uint capacity; // lights that there is room for
    uint draws; // that a probability is averaged over
    uint choices; // at least, of which picks are counted
};

struct Camera {
    vec3 eye;
    vec3 forward;
    vec3 right; // scaled by half the image's width on the projection's plane: tan(fov_x / 2) in perspective
    vec3 up; // scaled by half its height: tan(fov_y / 2)
};

// Six images, their directions turned by `rotation` (columns: sky space axes in the world).
struct Sky {
    vec3 rotation[3];
    uint textures[6]; // on +x, -x, +y, -y, +z, -z; files named rt, lf, bk, ft, up, dn
    vec3 radiance; // multiplies the images
    uint present; // 0: `radiance` alone is the sky
};

struct SamplerTableAddresses {
#define VKPT_SAMPLER_TABLE(name, type, alignment) uint64_t name;
#include "sampler_tables.def"
};

// Addresses of the scene's tables. Triangle ids and emitter indices: first the map's, then those of this frame's moving
// things.
struct SceneView {
    BvhView trees; // the map's and the moving things'
    uint filter_root; // instead of the roots of `trees`, for rays that look for MASK_FILTER alone
    uint other_filter_root;
    uint64_t trace_stack;
    uint64_t structure; // the driver's own, where it traces
    uint64_t structure_ids[2]; // tables of triangle ids, see STRUCTURE_TABLE_SHIFT
    uint64_t triangles;
    uint64_t previous_positions; // of the moving things' triangles, nine floats each: where they were in the last view
    uint first_moving; // triangle id; UINT_MAX: previous_positions are not known
    uint64_t materials;
    uint64_t emitters;
    uint64_t packed_lights;
    uint64_t light_lists;
    uint64_t static_light_indices;
    uint64_t dynamic_light_indices;
    SamplerTableAddresses sampler_tables;
    // The same for samples that repeat the last view's random numbers, see LightLists::repeat(). 0: nothing has
    // changed.
    uint64_t repeated_lists;
    uint64_t repeated_light_indices;
    uint64_t previous_list_lengths; // a uint each
    uint oldest_repeatable; // frame_index: samples with older numbers met other lists in the last view
    uint64_t lightstyles; // a float each
    uint64_t bsp_tree;
    uint light_list_count; // clusters + 1
    uint light_tree_lights; // see LightTables
    LightCacheView cache;
    LightVisibilityView visibility;
    Sky sky;
    uint64_t lightmap_faces; // LightmapFace, one for each face of the map; where FRAME_WIPE
    uint64_t luxels;
    FilterBox filter_boxes[MAX_FILTER_BOXES]; // what colours light is in these; nothing meets unused ones
    uint filter_box_count;
    uint fog_box_count;
    FogBox fog_boxes[MAX_FOG_BOXES];
    vec3 fog_radiance; // of pt_fog, as FogBox has it
    vec3 to_sun; // where FRAME_GOD_RAYS; unit
    vec3 sun_irradiance; // on what faces it
    uint eye_medium; // MEDIUM_*
    Screen screens[MAX_SCREENS];
};

struct FrameUniforms {
    Camera camera;
    Camera previous_camera; // where FRAME_HISTORY
    vec2 pixel_offset; // where in their pixel camera rays pass, unless FRAME_JITTER
    uint offset_phase; // that place's number of OFFSETS_PER_PIXEL, where as many pixels are rendered as are shown
    float texture_taps; // at most, along a ray's footprint in an image
    uvec2 previous_size; // pixels of the buffers named previous_, other than previous_resolved
    vec2 previous_scale; // previous_size / size
    vec2 offset_change; // from `reprojected` to where the last view's pixels were sampled, in its pixels
    SceneView scene;
    ScreenBuffers screen;
    uint64_t exposure; // ExposureState
    uint64_t ltc; // shared/ltc.h
    uint64_t blue_noise; // words as in noise.h
    uint64_t probes; // IrradianceProbe list where FRAME_PROBES; rays of probe_rays.comp
    uint64_t probe_hits; // written by probe_rays.comp
    uint probe_mask; // of the rays
    uint64_t statistics; // FrameStatistics
    uint64_t light_level; // LIGHT_LEVEL_LANES floats, written by light_level.comp
    uint64_t ray_counts; // RayCounts where FRAME_COUNT_RAYS
    uint probe_count;
    uint dark_light_count;
    uint64_t dark_lights; // Dlight: what those of negative colour take away
    uint64_t dlights; // Dlight, all of them, as the classic renderers add them; where FRAME_WIPE
    uint dlight_count;
    uvec2 size; // pixels rendered
    uvec2 bloom_size; // pixels of the level of `bloom` that is its result, where FRAME_BLOOM
    uvec2 resolved_size; // pixels of the buffers `resolved` and `accumulated`: more where anti-aliasing upscales
    uint64_t output_words; // the image that is shown: a word a pixel, RGBA, red in the lowest byte, sRGB-encoded
    uint output_across; // its pixels in a row
    float headroom; // how many times as bright as paper white the screen can be; 1: highlights are not kept
    // What the screen shows above the image, sRGB-encoded as that; three half floats a pixel, in 8 bytes. The image's
    // alpha is then what 2D covers of it.
    uint64_t highlights;
    uvec2 output_origin; // where the view lies in it
    uvec2 output_size;
    float time; // seconds of the game
    float frame_seconds; // wall time since the last view
    uint frame_index; // seeds the random numbers
    uint seed;
    uvec2 bounce_block; // pixels that share a bounce ray: 1 x 1, 2 x 1 or 2 x 2
    uint accumulated_frames; // frames already in `accumulated`
    uint flags; // FRAME_*
    vec4 blend; // the engine's screen blend, sRGB-encoded, alpha
    float gamma; // vid_gamma
    float overbright; // multiplies the exposed radiance: vk_overbrightbits
    float intensity; // multiplies the encoded image: by vk_intensity
    ShaderCvars cvars;
};

VKPT_SHARED_END

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// What every pass has: the frame's uniforms, the screen buffers, the images, and the walk over the screen's pixels.
// Include this first: it enables the extensions.
#ifndef VKPT_LIB_FRAME
#define VKPT_LIB_FRAME

#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#define VKPT_SCENE_TEXELS
#include "../shared/frame.h"
#include "device/lanes.glsl"
#include "device/texels.glsl"
#include "device/whole_numbers.glsl"

layout(set = 0, binding = 0, scalar) uniform FrameBlock { FrameUniforms frame; };
layout(set = 0, binding = 1) uniform sampler samplers[SAMPLER_COUNT];
layout(set = 1, binding = 0) uniform texture2D textures[];

// The pass's push constants, whose struct its row in passes.def names.
#define VKPT_PUSH_CONSTANTS                                                                                            \
    layout(push_constant, scalar) uniform PushBlock { VKPT_PUSH push; };

// An image that may be another one in every lane. Both the index and what is made of it have to be called nonuniform,
// or the CPU driver takes the first lane's image for all.
#define VKPT_TEXTURE(slot, sampler_index)                                                                              \
    nonuniformEXT(sampler2D(textures[nonuniformEXT(slot)], samplers[sampler_index]))

// An element of a buffer at an address; the last parameter of load_element tells its type. By 64-bit loads and stores
// where its size allows it (see wide_loads.glsl).
#define VKPT_ELEMENT(type)                                                                                             \
    layout(buffer_reference, scalar, buffer_reference_align = 4) buffer type##_elements { type v[]; };                 \
    type load_element(uint64_t address, uint index, type unused) { return type##_elements(address).v[index]; }         \
    void store_element(uint64_t address, uint index, type value) { type##_elements(address).v[index] = value; }
VKPT_ELEMENT(float)
VKPT_ELEMENT(uint)
#undef VKPT_ELEMENT

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer ElementWords { uint64_t v[]; };

uvec2 load_element(uint64_t address, uint index, uvec2 unused) { return unpack32(ElementWords(address).v[index]); }
void store_element(uint64_t address, uint index, uvec2 value) { ElementWords(address).v[index] = pack64(value); }

uvec4 load_element(uint64_t address, uint index, uvec4 unused)
{
    return uvec4(unpack32(ElementWords(address).v[index * 2u]), unpack32(ElementWords(address).v[index * 2u + 1u]));
}
void store_element(uint64_t address, uint index, uvec4 value)
{
    ElementWords(address).v[index * 2u] = pack64(value.xy);
    ElementWords(address).v[index * 2u + 1u] = pack64(value.zw);
}
void store_element(uint64_t address, uint index, vec2 value) { store_element(address, index, floatBitsToUint(value)); }
void store_element(uint64_t address, uint index, vec4 value) { store_element(address, index, floatBitsToUint(value)); }

// An element of a screen buffer. Texels may be fetched at any time: a pass must not load what it has stored.
layout(set = 3, binding = 0) uniform utextureBuffer screen_texels[SCREEN_BUFFER_COUNT];

uvec4 load_element(ScreenBuffer buffer_, uint index, uvec4 unused)
{
    return tables_are_texels ? texelFetch(screen_texels[buffer_.texels], int(index))
                             : load_element(buffer_.address, index, uvec4(0u));
}
uvec2 load_element(ScreenBuffer buffer_, uint index, uvec2 unused)
{
    return tables_are_texels ? texelFetch(screen_texels[buffer_.texels], int(index)).xy
                             : load_element(buffer_.address, index, uvec2(0u));
}
vec2 load_element(ScreenBuffer buffer_, uint index, vec2 unused)
{
    return uintBitsToFloat(load_element(buffer_, index, uvec2(0u)));
}
vec4 load_element(ScreenBuffer buffer_, uint index, vec4 unused)
{
    return uintBitsToFloat(load_element(buffer_, index, uvec4(0u)));
}
uint load_element(ScreenBuffer buffer_, uint index, uint unused) { return load_element(buffer_.address, index, 0u); }
float load_element(ScreenBuffer buffer_, uint index, float unused) { return load_element(buffer_.address, index, 0.0); }

// load_NAME(pixel index) and store_NAME(pixel index, value) for every screen buffer
#define VKPT_SCREEN_BUFFER(type, name)                                                                                 \
    type load_##name(uint pixel)                                                                                       \
    {                                                                                                                  \
        type unused;                                                                                                   \
        return load_element(frame.screen.name, pixel, unused);                                                         \
    }                                                                                                                  \
    void store_##name(uint pixel, type value) { store_element(frame.screen.name.address, pixel, value); }
#include "../shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER

// In the screen buffers.
uint pixel_index(uvec2 pixel) { return pixel.y * frame.size.x + pixel.x; }
// What is negative is very great without sign.
bool is_on_screen(uvec2 pixel) { return all(lessThan(pixel, frame.size)); }

// Where lane `lane` of 64 stands in an 8 x 8 tile: 16 neighbouring lanes (one vector of the CPU driver) cover 4 x 4
// pixels.
uvec2 pixel_in_tile(uint lane)
{
    return uvec2(((lane >> 4u) & 1u) * 4u + (lane & 3u), (lane >> 5u) * 4u + ((lane >> 2u) & 3u));
}

// How a pass runs over its pixels, over blocks of them (lib/bounce_blocks.glsl), or over PIXEL_GROUP_SIZE lanes with a
// number each, or over one pixel of 2 x 2, or over the light cache's cells that are updated: the macros define main(),
// which calls run(pixel, index of the pixel in the screen buffers), run(block, its number), run(place in the grid,
// number of the cell) or run(lane). They are what lets one source be a compute shader or, for the trace backend
// "pipeline", a ray generation shader, which has neither workgroups nor shared memory: a pass that traces keeps to
// them.
#if defined(VKPT_TRACE_PIPELINE)
#extension GL_EXT_ray_tracing : require

// One launch index a pixel, or a block.
#define VKPT_RUN_OVER_PIXELS(run)                                                                                      \
    void main() { run(gl_LaunchIDEXT.xy, gl_LaunchIDEXT.y* frame.size.x + gl_LaunchIDEXT.x); }
#define VKPT_RUN_OVER_BLOCKS(run)                                                                                      \
    void main() { run(gl_LaunchIDEXT.xy, gl_LaunchIDEXT.y* gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x); }
#define VKPT_RUN_OVER_HALF(run) VKPT_RUN_OVER_BLOCKS(run)
#define VKPT_RUN_OVER_CELLS(run)                                                                                       \
    void main() { run(gl_LaunchIDEXT.xy, gl_LaunchIDEXT.y* CACHE_ROW + gl_LaunchIDEXT.x); }
#define VKPT_RUN_OVER_LANES(run)                                                                                       \
    void main() { run(gl_LaunchIDEXT.x); }

#else

// The light cache's cells that are updated, in rows.
uvec2 cache_update_grid() { return uvec2(CACHE_ROW, (frame.scene.cache.updated + CACHE_ROW - 1u) / CACHE_ROW); }

// One pixel of so many in either direction, at least 4, is looked at where one workgroup looks at no more than
// max_samples.
uint sample_spacing(uvec2 size, uint max_samples)
{
    return max(4u, uint(ceil(sqrt(float(size.x * size.y) / float(max_samples)))));
}

// Where tile `tile` of rows of `across` stands.
uvec2 place_of_tile(uint tile, uint across)
{
    uint row = divide_whole(tile, across);
    return uvec2(tile - row * across, row);
}

// The pixel is kept from tile to tile: the CPU driver divides lane by lane for the lane's number, and would do so in
// every tile.
#define VKPT_RUN_OVER(size_, run)                                                                                      \
    layout(local_size_x = PIXEL_GROUP_SIZE) in;                                                                        \
    void main()                                                                                                        \
    {                                                                                                                  \
        uvec2 size = size_;                                                                                            \
        uint tiles_across = (size.x + 7u) / 8u, tiles = has_gpu_lanes ? 1u : PIXEL_TILES_PER_GROUP;                    \
        uvec2 tile = has_gpu_lanes ? gl_WorkGroupID.xy : place_of_tile(gl_WorkGroupID.x * tiles, tiles_across);        \
        uvec2 pixel = tile * 8u + pixel_in_tile(gl_LocalInvocationID.x);                                               \
        ROLLED_FOR (uint i = 0u; i < tiles; i++) {                                                                     \
            if (all(lessThan(pixel, size)))                                                                            \
                run(pixel, pixel.y* size.x + pixel.x);                                                                 \
            if (has_gpu_lanes) /* compilers that know it drop the loop */                                              \
                break;                                                                                                 \
            pixel.x += 8u;                                                                                             \
            if (pixel.x >= tiles_across * 8u)                                                                          \
                pixel += uvec2(-int(tiles_across) * 8, 8);                                                             \
        }                                                                                                              \
    }
#define VKPT_RUN_OVER_PIXELS(run) VKPT_RUN_OVER(frame.size, run)
#define VKPT_RUN_OVER_BLOCKS(run) VKPT_RUN_OVER(bounce_block_count(), run)
#define VKPT_RUN_OVER_HALF(run) VKPT_RUN_OVER((frame.size + 1u) / 2u, run)
#define VKPT_RUN_OVER_CELLS(run) VKPT_RUN_OVER(cache_update_grid(), run)
#define VKPT_RUN_OVER_LANES(run)                                                                                       \
    layout(local_size_x = PIXEL_GROUP_SIZE) in;                                                                        \
    void main() { run(gl_LocalInvocationID.x); }

#endif

#endif

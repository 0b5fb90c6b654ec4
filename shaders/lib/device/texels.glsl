// SPDX-License-Identifier: GPL-2.0-or-later
// Tables that are read as texels, 16 bytes at once. The CPU driver loads a texel lane by lane and transposes, in 20 ns
// for the 16 lanes of a vector; by buffer references it makes gathers of eight lanes out of every load, which take 40
// ns for as much (docs/notes/cpu-driver.md), unless the processor's gathers are quick. GPUs read by address, see
// Device::reads_texels. Needs GL_EXT_samplerless_texture_functions. Define VKPT_TEXEL_SET where it is not 2.
#ifndef VKPT_LIB_TEXELS
#define VKPT_LIB_TEXELS

#include "../../shared/texels.h"
#include "lanes.glsl"

#ifndef VKPT_TEXEL_SET
#define VKPT_TEXEL_SET 2
#endif

layout(constant_id = TEXELS_CONSTANT) const bool tables_are_texels = true;

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer TexelWords { uint64_t v[]; };

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer AlignedTexels { uvec4 v[]; };

// `address`: a multiple of 16.
uvec4 load_aligned_texel(uint64_t address, uint texel) { return AlignedTexels(address).v[texel]; }
// `address`: a multiple of 8.
uvec4 load_texel(uint64_t address, uint texel)
{
    TexelWords words = TexelWords(address);
    return uvec4(unpack32(words.v[texel * 2u]), unpack32(words.v[texel * 2u + 1u]));
}

#define VKPT_TEXELS(name, slot) layout(set = VKPT_TEXEL_SET, binding = slot) uniform utextureBuffer name;

// Texel `i` of entry `index`, each of `bytes`, a multiple of 16, of the table at an address that is one, too.
#define VKPT_LOAD_TEXEL(address, bytes, index, i)                                                                      \
    (has_gpu_lanes ? load_aligned_texel((address) + uint64_t((index) * (bytes)), i)                                    \
                   : load_texel((address) + uint64_t((index) * (bytes)), i))
// The same as number `first_of_texels` + `index` in the texels, where tables are read so.
#define VKPT_TEXEL(name, first_of_texels, address, bytes, index, i)                                                    \
    (tables_are_texels ? texelFetch(name, int(((first_of_texels) + (index)) * ((bytes) / TEXEL_BYTES) + (i)))          \
                       : VKPT_LOAD_TEXEL(address, bytes, index, i))

#endif

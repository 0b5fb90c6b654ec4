// SPDX-License-Identifier: GPL-2.0-or-later
// Tables that are read as texels, 16 bytes at once. The CPU driver loads a texel lane by lane and transposes, in 20 ns
// for the 16 lanes of a vector; by buffer references it makes gathers of eight lanes out of every load, which take 40
// ns for as much (docs/notes/cpu-driver.md), unless the processor's gathers are quick. GPUs read by address, see
// Device::reads_texels. Needs GL_EXT_samplerless_texture_functions. Define VKPT_TEXEL_SET where it is not 2.
#ifndef VKPT_LIB_TEXELS
#define VKPT_LIB_TEXELS

#include "../../shared/texels.h"

#ifndef VKPT_TEXEL_SET
#define VKPT_TEXEL_SET 2
#endif

layout(constant_id = TEXELS_CONSTANT) const bool tables_are_texels = true;

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer TexelWords { uint64_t v[]; };

uvec4 load_texel(uint64_t address, uint texel)
{
    TexelWords words = TexelWords(address);
    return uvec4(unpack32(words.v[texel * 2u]), unpack32(words.v[texel * 2u + 1u]));
}

#define VKPT_TEXELS(name, slot) layout(set = VKPT_TEXEL_SET, binding = slot) uniform utextureBuffer name;

// Texel `i` of an entry of `bytes`: number `first_of_texels` + `index` in the texels, `index` in the table at an
// address.
#define VKPT_TEXEL(name, first_of_texels, address, bytes, index, i)                                                    \
    (tables_are_texels ? texelFetch(name, int(((first_of_texels) + (index)) * ((bytes) / TEXEL_BYTES) + (i)))          \
                       : load_texel((address) + uint64_t((index) * (bytes)), i))

#endif

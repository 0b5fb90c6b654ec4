// SPDX-License-Identifier: GPL-2.0-or-later
// The scene's tables as buffers of texels: their bindings in descriptor set 2 (lib/device/texels.glsl,
// frame/scene_texels.hpp). Texels are of four words, but for the lists' lights, which are of one.
#ifndef VKPT_SHARED_TEXELS_H
#define VKPT_SHARED_TEXELS_H

#include "language.h"

VKPT_SHARED_BEGIN

VKPT_CONST uint TEXEL_BYTES = 16u; // every entry of the tables in texels of four words is a whole number of them

VKPT_CONST uint TEXELS_CONSTANT = 1u; // the specialization constant that tells whether tables are read as texels

VKPT_CONST uint TEXELS_TREE_NODES = 0u; // of all trees of backend "software", one behind the other
VKPT_CONST uint TEXELS_TREE_TRIANGLES = 1u; // those of the trees, in the order of their leaves
VKPT_CONST uint TEXELS_TRIANGLES = 2u; // Triangle
VKPT_CONST uint TEXELS_MATERIALS = 3u; // Material
VKPT_CONST uint TEXELS_EMITTERS = 4u; // Emitter
VKPT_CONST uint TEXELS_PACKED_LIGHTS = 5u; // PackedLight
VKPT_CONST uint TEXELS_STATIC_LIGHTS = 6u; // the lists' static lights, a word each
VKPT_CONST uint TEXELS_COUNT = 7u;

VKPT_SHARED_END

#endif

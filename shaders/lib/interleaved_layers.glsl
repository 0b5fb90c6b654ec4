// SPDX-License-Identifier: GPL-2.0-or-later
// The layers of what is seen through glass and in water: what is reflected, or the pane's own image, and what is
// behind. A camera ray follows one of them, at random and by how much it is of the whole. In images that are filtered
// (FRAME_LAYERED) neighbouring pixels share them out in a pattern instead, so that each layer has neighbours and a
// history to be filtered with; what it counts for makes up for the number of its pixels. blend_layers.comp puts the
// layers together. The pattern moves on with every view, and anti-aliasing averages what is left of it.
#ifndef VKPT_LIB_INTERLEAVED_LAYERS
#define VKPT_LIB_INTERLEAVED_LAYERS

#include "device/whole_numbers.glsl"

// Pixels are of one of three classes: those to the right and above are of the next class, those to the left and below
// of the last one.
const uint layer_classes = 3u;

// The classes first to first + count - 1 follow the pixel's layer; 1: there is nothing left to share out.
struct Layers {
    uint own; // the pixel's class
    uint first;
    uint count;
};

const Layers unshared_layers = Layers(0u, 0u, 1u);

Layers share_layers(uvec2 pixel)
{
    uint phase = (frame.flags & FRAME_ANTIALIASED) != 0u ? frame.frame_index % layer_classes : 0u;
    uint sum = pixel.x + 2u * pixel.y + phase;
    return Layers(sum - layer_classes * divide_whole(sum, layer_classes), 0u, layer_classes);
}

// In `throughput`, above blue: the next class, or the last one, shows another layer.
const uint next_differs = 0x10000u, last_differs = 0x20000u;

uint other_layers_bits(Layers layers)
{
    uint same = ((1u << layers.count) - 1u) << layers.first, others = ~(same | (same << layer_classes)) >> layers.own;
    return (others << 15u) & (next_differs | last_differs);
}

// Whether another layer than the pixel's own is next to it: next_differs, last_differs.
uint differing_layers(uint index) { return load_throughput(index).y & (next_differs | last_differs); }

#endif

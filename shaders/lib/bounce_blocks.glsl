// SPDX-License-Identifier: GPL-2.0-or-later
// Blocks of 1, 2 x 1 or 2 x 2 pixels (pt_bounce_pixels), of which one, the leader, sends a bounce ray, each in its
// turn; the others take over what it met.
#ifndef VKPT_LIB_BOUNCE_BLOCKS
#define VKPT_LIB_BOUNCE_BLOCKS

#include "frame.glsl"
#include "random.glsl"

uint bounce_block_pixels() { return frame.bounce_block.x * frame.bounce_block.y; }

// A side is 1 or 2: a quotient would need registers of every lane.
uvec2 bounce_block_count() { return (frame.size + frame.bounce_block - 1u) >> (frame.bounce_block - 1u); }

// A block's pixels in the order of this frame, the leader first. Where the screen's size is odd, some lie outside.
struct BounceBlock {
    uvec2 first;
    uint leader;
};

// The turns of a block of four: a pixel, the one diagonally across, and the other two. Blocks are out of step with
// their neighbours.
BounceBlock open_bounce_block(uvec2 block)
{
    uint turn
        = (hash_pcg4(uvec4(block, 0x2545f491u, 0x9e3779b9u)).x + frame.frame_index) & (bounce_block_pixels() - 1u);
    uint leader = ((turn ^ (turn >> 1u)) & 1u) | (turn << 1u);
    return BounceBlock(block * frame.bounce_block, leader & (bounce_block_pixels() - 1u));
}

// The block that holds a pixel of a view of the same blocks, that pixel first.
BounceBlock bounce_block_of(uvec2 pixel)
{
    uvec2 first = divide_whole(pixel, frame.bounce_block) * frame.bounce_block;
    return BounceBlock(first, (pixel.x - first.x) | ((pixel.y - first.y) << 1u));
}

uvec2 pixel_of_block(BounceBlock block, uint i)
{
    uint place = block.leader ^ i;
    return block.first + uvec2(place & 1u, place >> 1u);
}

#endif

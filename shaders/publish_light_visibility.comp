#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Makes of the counted shadow rays what the next frames' light samplers believe of the lights' visibility.
#include "lib/frame.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer VisibilityCounts { uint v[]; };

// Two bits; one more ray counts as arrived, so that few rays tell little.
uint hidden_thirds(uint count)
{
    float rays = float(count & 0xffffu), arrived = float(count >> 16u);
    return uint(3.0 * (rays - arrived) / (rays + 1.0) + 0.5);
}

uint forget_old_rays(uint count)
{
    float rays = float(count & 0xffffu), arrived = float(count >> 16u);
    return rays > float(VISIBILITY_MAX_COUNT)
        ? uint(arrived * float(VISIBILITY_MAX_COUNT) / rays + 0.5) << 16u | VISIBILITY_MAX_COUNT
        : count;
}

uint publish_word(uint first)
{
    VisibilityCounts counts = VisibilityCounts(frame.scene.visibility.counts);
    uint word = 0u;
    ROLLED_FOR (uint i = 0u; i < 16u; i++) {
        uint count = counts.v[first + i];
        word |= hidden_thirds(count) << (2u * i);
        counts.v[first + i] = forget_old_rays(count);
    }
    return word;
}

void publish_row(uvec2, uint row)
{
    uint first = row * VISIBILITY_SLOTS;
    uint a = publish_word(first), b = publish_word(first + 16u), c = publish_word(first + 32u),
         d = publish_word(first + 48u);
    store_element(frame.scene.visibility.rows, row, uvec4(a, b, c, d));
}

VKPT_RUN_OVER(uvec2(VISIBILITY_GRID), publish_row)

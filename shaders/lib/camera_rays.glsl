// SPDX-License-Identifier: GPL-2.0-or-later
// What rays from the camera meet, and what primary_visibility tells of them for more rays through the edges of lamps
// (antialiasing/supersample_lamps.comp).
#ifndef VKPT_LIB_CAMERA_RAYS
#define VKPT_LIB_CAMERA_RAYS

#include "interleaved_layers.glsl"
#include "surfaces.glsl"

const uint mask_camera = MASK_OPAQUE | MASK_TRANSLUCENT | MASK_ALPHA_TEST | MASK_VIEW_WEAPON | MASK_SKY;

// Metals smoother than this are mirrors.
const float mirror_roughness = 0.06;
bool is_mirror(Surface s) { return s.metallic > 0.5 && s.roughness < mirror_roughness; }

// How bright what the pixel shows is of itself, in the bits of `throughput` that are left: the upper 13 of a
// luminance's light16_bits.
uint brightness_bits(vec3 emitted) { return (light16_bits(luminance(emitted)) & 0xfff8u) << 16u; }
float brightness_of(uvec2 throughput) { return unpack_light2(throughput.y & 0xfff80000u).y; }

// Whether the camera's ray came to what the pixel shows straight, through nothing that takes or adds light.
bool is_seen_straight(uvec2 throughput)
{
    const uint layers = next_differs | last_differs;
    uvec2 whole = pack_light3(vec3(1.0));
    return throughput.x == whole.x && (throughput.y & 0xffffu) == whole.y
        && ((frame.flags & FRAME_LAYERED) == 0u || (throughput.y & layers) == 0u);
}

#endif

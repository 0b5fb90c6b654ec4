#version 460
// SPDX-License-Identifier: GPL-2.0-or-later
// Traces a buffer of rays with the software backend. A group takes runs of 64 rays.
#extension GL_GOOGLE_include_directive : require
#define VKPT_TEXEL_SET 0
#include "shaders/lib/trace_software.glsl"
#include "tests/rays/trace_rays.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool any_hit = false;
layout(push_constant, scalar) uniform PushConstants { TraceRaysPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Words { uint64_t words[]; };

TestRay load_ray(uint index)
{
    Words source = Words(push.rays + uint64_t(index) * 32ul);
    vec2 a = uintBitsToFloat(unpack32(source.words[0])), b = uintBitsToFloat(unpack32(source.words[1]));
    vec2 c = uintBitsToFloat(unpack32(source.words[2])), d = uintBitsToFloat(unpack32(source.words[3]));
    return TestRay(vec3(a, b.x), b.y, vec3(c, d.x), d.y);
}

void store_hit(uint index, RawHit hit)
{
    Words target = Words(push.hits + uint64_t(index) * 24ul);
    target.words[0] = pack64(uvec2(hit.triangle, floatBitsToUint(hit.t)));
    target.words[1] = pack64(floatBitsToUint(hit.barycentrics));
    target.words[2] = pack64(uvec2(hit.front, 0u));
}

void main()
{
    uint64_t stack = software_stack(push.stack, gl_GlobalInvocationID.x);
    [[dont_unroll]] for (uint run = 0u; run < TRACE_RAYS_PER_GROUP / TRACE_RAYS_GROUP; run++)
    {
        uint index = gl_WorkGroupID.x * TRACE_RAYS_PER_GROUP + run * TRACE_RAYS_GROUP + gl_LocalInvocationIndex;
        if (index < push.ray_count) {
            TestRay ray = load_ray(index);
            store_hit(index,
                software_trace(
                    push.trees, ray.origin, ray.direction, ray.t_min, ray.t_max, push.ray_mask, any_hit, stack));
        }
    }
}

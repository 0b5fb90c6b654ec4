// SPDX-License-Identifier: GPL-2.0-or-later
// The sky: six textures around the world, turning if the map says so.
#ifndef VKPT_LIB_SKY
#define VKPT_LIB_SKY

#include "frame.glsl"

// xy: where a direction meets the cube around the eye, -1..1 from a texture's left top; z: which texture
// (Sky::textures).
vec3 sky_face(vec3 d)
{
    vec3 size = abs(d);
    if (size.x >= size.y && size.x >= size.z)
        return d.x > 0.0 ? vec3(-d.y, -d.z, 0.0) / vec3(size.x, size.x, 1.0)
                         : vec3(d.y, -d.z, 1.0) / vec3(size.x, size.x, 1.0);
    if (size.y >= size.z)
        return d.y > 0.0 ? vec3(d.x, -d.z, 2.0) / vec3(size.y, size.y, 1.0)
                         : vec3(-d.x, -d.z, 3.0) / vec3(size.y, size.y, 1.0);
    return d.z > 0.0 ? vec3(-d.y, d.x, 4.0) / vec3(size.z, size.z, 1.0)
                     : vec3(-d.y, -d.x, 5.0) / vec3(size.z, size.z, 1.0);
}

// Radiance from the sky along a unit direction.
vec3 sky_radiance(vec3 direction)
{
    if (frame.scene.sky.present == 0u)
        return frame.scene.sky.radiance;
    vec3 d = vec3(dot(direction, frame.scene.sky.rotation[0]), dot(direction, frame.scene.sky.rotation[1]),
        dot(direction, frame.scene.sky.rotation[2]));
    vec3 face = sky_face(d);
    uint slot = frame.scene.sky.textures[floor_to_uint(face.z)];
    vec2 uv = face.xy * 0.5 + 0.5;
    return textureLod(VKPT_TEXTURE(slot, SAMPLER_CLAMP), uv, 0.0).rgb * frame.scene.sky.radiance;
}

#endif

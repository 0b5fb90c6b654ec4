// SPDX-License-Identifier: GPL-2.0-or-later
// Light that a surface reflects, and the buffer that passes hand it on in.
#ifndef VKPT_LIB_REFLECTED_LIGHT
#define VKPT_LIB_REFLECTED_LIGHT

#include "frame.glsl"
#include "bsdf.glsl"
#include "packing.glsl"

// Radiance, where the cache is corrected (pt_indirect both) also below 0.
struct ReflectedLight {
    vec3 diffuse; // without albedo
    vec3 specular;
};
const ReflectedLight no_reflected_light = ReflectedLight(vec3(0.0), vec3(0.0));

vec2 luminances(ReflectedLight light) { return vec2(luminance(light.diffuse), luminance(light.specular)); }

ReflectedLight fetch_reflected_light(uint index)
{
    uvec4 bits = load_reflected_light(index);
    return ReflectedLight(unpack_floats3(bits.xy), unpack_floats3(bits.zw));
}

void store_reflected_light(uint index, ReflectedLight light)
{
    store_reflected_light(index, uvec4(pack_floats3(light.diffuse), pack_floats3(light.specular)));
}

#endif

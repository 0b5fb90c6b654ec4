// SPDX-License-Identifier: GPL-2.0-or-later
// What the denoiser's passes share. Light is kept demodulated: diffuse without albedo, specular without a metal's
// colour, so that no texture is blurred. Sources: Schied et al. 2017 (SVGF), Schied, Peters and Dachsbacher 2018
// (A-SVGF).
#ifndef VKPT_LIB_DENOISE
#define VKPT_LIB_DENOISE

#include "../lib/bounce_blocks.glsl"
#include "../lib/reflected_light.glsl"
#include "../lib/reprojection.glsl"
#include "../lib/surfaces.glsl"

// Light of a pixel with the standard deviation of its luminance, either for each of the two lobes. Where too few frames
// tell how much the luminance varies, minus the root of its mean square: the spatial filter's first levels measure it
// among the neighbours. The levels behind those define VKPT_DEVIATIONS_ARE_KNOWN; there the sign only tells that it was
// measured (is_measured).
struct FilteredLight {
    vec3 diffuse;
    float diffuse_deviation;
    vec3 specular;
    float specular_deviation;
};

// In the upper half of a word: as light, but for the last bit, which is the sign.
uint deviation_bits(float deviation)
{
    return ((light16_bits(abs(deviation)) & ~1u) | (floatBitsToUint(deviation) >> 31u)) << 16u;
}
#ifdef VKPT_DEVIATIONS_ARE_KNOWN
uint sign_of_deviation(uint bits) { return 0u; }
bool is_known(float deviation) { return true; }
#else
uint sign_of_deviation(uint bits) { return (bits << 15u) & 0x80000000u; }
bool is_known(float deviation) { return floatBitsToInt(deviation) >= 0; }
#endif
float unpack_deviation(uint bits)
{
    return uintBitsToFloat((((bits >> 3u) & 0x1fffc000u) + uint(min_light16)) | sign_of_deviation(bits));
}

uvec4 pack_filtered(FilteredLight light)
{
    return uvec4(pack_light2(light.diffuse.xy), light16_bits(light.diffuse.z) | deviation_bits(light.diffuse_deviation),
        pack_light2(light.specular.xy), light16_bits(light.specular.z) | deviation_bits(light.specular_deviation));
}

FilteredLight unpack_filtered(uvec4 bits)
{
    return FilteredLight(vec3(unpack_light2(bits.x), unpack_light2(bits.y).x), unpack_deviation(bits.y),
        vec3(unpack_light2(bits.z), unpack_light2(bits.w).x), unpack_deviation(bits.w));
}

// Whether the deviation of either lobe is unknown, or was measured among the neighbours for want of history.
bvec2 is_measured(uvec4 bits) { return notEqual(bits.yw & 0x10000u, uvec2(0u)); }

// Colour that the specular light of this surface carries.
vec3 specular_tint(Surface s) { return mix(vec3(1.0), quick_max(s.albedo, vec3(0.05)), s.metallic); }

// ---- broken light

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FrameStatisticsBuffer { FrameStatistics v; };

bool is_nonfinite(vec3 light) { return any(isnan(light)) || any(isinf(light)); }
void count_nonfinite_pixel() { atomicAdd(FrameStatisticsBuffer(frame.statistics).v.nonfinite_pixels, 1u); }

// ---- strata: 3 x 3 blocks of pixels that share a bounce ray, mostly of one pixel each. One of them repeats an older
// sample.

uvec2 stratum_size() { return frame.bounce_block * STRATUM_BLOCKS; }
uvec2 stratum_count() { return divide_whole(frame.size + stratum_size() - 1u, stratum_size()); }

// The stratum's block whose turn it is in this frame: its leader repeats a sample, where the screen has that pixel. A
// block that had its turn every time would show one sample for ever.
BounceBlock stratum_block(uvec2 stratum)
{
    uvec4 hash = hash_pcg4(uvec4(stratum, frame.frame_index, 0x51ed270bu));
    uvec2 first = stratum * STRATUM_BLOCKS;
    return open_bounce_block(
        first + ((hash.xy >> 16u) * min(uvec2(STRATUM_BLOCKS), bounce_block_count() - first) >> 16u));
}

uvec2 stratum_pixel(uvec2 stratum) { return min(pixel_of_block(stratum_block(stratum), 0u), frame.size - 1u); }

// How much of either lobe's light has changed around a stratum, by the repeated samples: 0 to 1.
vec2 changed_share_of_stratum(uint number)
{
    vec4 gradient = load_gradient_b(number);
    return quick_min(abs(gradient.xz) / quick_max(gradient.yw, vec2(1e-10)), vec2(1.0));
}

// The same around a pixel.
vec2 changed_share(uvec2 pixel)
{
    uvec2 stratum = divide_whole(pixel, stratum_size());
    return changed_share_of_stratum(stratum.y * stratum_count().x + stratum.x);
}

// main() for passes over strata: run(stratum, its number).
#define VKPT_RUN_OVER_STRATA(run) VKPT_RUN_OVER(stratum_count(), run)

// ---- moments

struct Moments {
    vec2 diffuse; // mean and root mean square of the luminance
    vec2 specular;
    vec2 frames; // how many the light's average is worth: diffuse, specular
    float specular_hit_distance; // average, to what the specular lobe shows; 0: unknown
    vec2 newest; // luminance of the newest sample as it was taken: diffuse, specular
};

// Frames are kept in 8 bits each: up to 36 of them, in sevenths.
const float frame_parts = 7.0;

uvec4 pack_moments(Moments m)
{
    ivec2 frames = min(whole_to_int(floor(m.frames * frame_parts + 0.5)), 255);
    return uvec4(pack_light2(m.diffuse), pack_light2(m.specular),
        light16_bits(m.specular_hit_distance) | (uint(frames.x) << 16u) | (uint(frames.y) << 24u),
        pack_light2(m.newest));
}

Moments unpack_moments(uvec4 bits)
{
    return Moments(unpack_light2(bits.x), unpack_light2(bits.y),
        vec2((bits.z >> 16u) & 255u, bits.z >> 24u) * (1.0 / frame_parts), unpack_light2(bits.z).x,
        unpack_light2(bits.w));
}

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// From the finished image to the light that an HDR screen shows. The image is sRGB-encoded; 1 is paper white, and the
// encoding goes on above it.
#ifndef VKPT_LIB_HDR
#define VKPT_LIB_HDR

// Linear, paper white being 1. IEC 61966-2-1, extended beyond 1; what is negative becomes 0.
vec3 decode_srgb(vec3 encoded)
{
    vec3 clamped = max(encoded, vec3(0.0f));
    return mix(pow((clamped + 0.055f) / 1.055f, vec3(2.4f)), clamped / 12.92f, lessThan(clamped, vec3(0.04045f)));
}

// Linear, from BT.709's primaries, which are sRGB's, to BT.2020's; white stays. ITU-R BT.2087-0, section 4.
vec3 widen_primaries(vec3 rgb)
{
    return vec3(dot(rgb, vec3(0.6274f, 0.3293f, 0.0433f)), dot(rgb, vec3(0.0691f, 0.9195f, 0.0114f)),
        dot(rgb, vec3(0.0164f, 0.0880f, 0.8956f)));
}

const float pq_peak = 10000.0f; // cd/m^2

// The inverse EOTF of SMPTE ST 2084: from cd/m^2 to 0..1.
vec3 encode_pq(vec3 luminance)
{
    const float m1 = 2610.0f / 16384.0f, m2 = 2523.0f / 32.0f, c1 = 3424.0f / 4096.0f, c2 = 2413.0f / 128.0f,
                c3 = 2392.0f / 128.0f;
    vec3 y = pow(clamp(luminance / pq_peak, vec3(0.0f), vec3(1.0f)), vec3(m1));
    return pow((c1 + c2 * y) / (1.0f + c3 * y), vec3(m2));
}

// cd/m^2 that the screen shows of an encoded pixel, of at most `peak`: what is brighter keeps its hue.
vec3 shown_luminance(vec3 encoded, float paper_white, float peak)
{
    vec3 light = decode_srgb(encoded) * paper_white;
    float brightest = max(light.x, max(light.y, light.z));
    return brightest > peak ? light * (peak / brightest) : light;
}

#endif

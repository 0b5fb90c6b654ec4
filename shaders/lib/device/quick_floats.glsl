// SPDX-License-Identifier: GPL-2.0-or-later
// Float functions that CPU drivers work out much faster than the built-in ones. Theirs treat NaN with care and have no
// instruction for 16 lanes: a minimum or maximum takes them some eight instructions, a root or a quotient the time of
// ten to twenty. They are used for whatever is never negative in code that runs for each ray, light, tap or pixel;
// elsewhere the built-in ones are.
#ifndef VKPT_LIB_QUICK_FLOATS
#define VKPT_LIB_QUICK_FLOATS

#include "../../shared/functions.h"

// max and min unless both numbers are negative: such floats are ordered as their bits are. Of two negative numbers
// either one. NaN counts as greater than all (its sign bit set: as less than 0).
float quick_max(float a, float b) { return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b))); }
float quick_min(float a, float b) { return intBitsToFloat(min(floatBitsToInt(a), floatBitsToInt(b))); }
vec2 quick_max(vec2 a, vec2 b) { return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b))); }
vec3 quick_max(vec3 a, vec3 b) { return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b))); }
vec2 quick_min(vec2 a, vec2 b) { return intBitsToFloat(min(floatBitsToInt(a), floatBitsToInt(b))); }
vec3 quick_min(vec3 a, vec3 b) { return intBitsToFloat(min(floatBitsToInt(a), floatBitsToInt(b))); }
float quick_max3(vec3 v) { return quick_max(quick_max(v.x, v.y), v.z); }

// 0 <= low <= high
float quick_clamp(float x, float low, float high) { return quick_min(quick_max(x, low), high); }
vec3 quick_clamp(vec3 x, float low, float high) { return quick_min(quick_max(x, vec3(low)), vec3(high)); }

// 1 / sqrt(x) to 0.09 % for x > 0, by the float's bits and one step of Newton's method (constants: Moroz et al. 2018).
float quick_inversesqrt(float x)
{
    float y = intBitsToFloat(0x5f376908 - (floatBitsToInt(x) >> 1));
    return y * (1.50087896f - 0.5f * x * y * y);
}

#endif

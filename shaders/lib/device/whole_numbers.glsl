// SPDX-License-Identifier: GPL-2.0-or-later
// Whole numbers by way of floats. CPU drivers convert floats to integers lane by lane, because of what lies beyond the
// range, and have no vectors to divide integers.
#ifndef VKPT_LIB_WHOLE_NUMBERS
#define VKPT_LIB_WHOLE_NUMBERS

#include "../../shared/functions.h"

// Whole numbers from -2^22 to 2^22, added to this (1.5 * 2^23), are the last bits of the sum; other numbers are
// rounded.
const float whole_base = 12582912.0f;
const int whole_base_bits = 0x4b400000;
// The same for numbers from 0 to 2^23 (2^23).
const float unsigned_whole_base = 8388608.0f;

int whole_to_int(float whole) { return floatBitsToInt(whole + whole_base) - whole_base_bits; }
ivec2 whole_to_int(vec2 whole) { return floatBitsToInt(whole + whole_base) - whole_base_bits; }
ivec3 whole_to_int(vec3 whole) { return floatBitsToInt(whole + whole_base) - whole_base_bits; }

// The greatest whole number that is not above x; from 0 to 2^22.
uint floor_to_uint(float x) { return uint(whole_to_int(floor(x))); }
uvec2 floor_to_uint(vec2 x) { return uvec2(whole_to_int(floor(x))); }

// number / divisor, of which `quotient` is a float's estimate, at most one beside it. Vulkan's division may be 2.5 ULP
// off, which is that much for numbers between 1.6 million and 2^22.
uint correct_quotient(uint number, uint divisor, float quotient)
{
    int whole = whole_to_int(floor(quotient));
    int rest = int(number) - whole * int(divisor);
    return uint(whole + (rest >= int(divisor) ? 1 : 0) - (rest < 0 ? 1 : 0));
}

// number / divisor, exact for numbers below 2^22. Through int: there is no quick way from unsigned to float either.
uint divide_whole(uint number, uint divisor)
{
    return correct_quotient(number, divisor, (float(int(number)) + 0.5f) / float(int(divisor)));
}
uvec2 divide_whole(uvec2 number, uvec2 divisor)
{
    return uvec2(divide_whole(number.x, divisor.x), divide_whole(number.y, divisor.y));
}

// number % divisor
uint remainder_whole(uint number, uint divisor) { return number - divide_whole(number, divisor) * divisor; }

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// Whole numbers by way of floats. CPU drivers convert floats to integers lane by lane, because of what lies beyond the range, and have
// no vectors to divide integers.
#ifndef VKPT_LIB_WHOLE_NUMBERS
#define VKPT_LIB_WHOLE_NUMBERS

#include "../shared/functions.h"

// Whole numbers from -2^22 to 2^22: added to 1.5 * 2^23, they are the last bits of the float.
int whole_to_int(float whole)
{
    return floatBitsToInt(whole + 12582912.0f) - 0x4b400000;
}
ivec2 whole_to_int(vec2 whole)
{
    return floatBitsToInt(whole + 12582912.0f) - 0x4b400000;
}

// The greatest whole number that is not above x; from 0 to 2^22.
uint floor_to_uint(float x)
{
    return uint(whole_to_int(floor(x)));
}

// number / divisor, exact for numbers below 2^22. Through int: there is no quick way from unsigned to float either.
uint divide_whole(uint number, uint divisor)
{
    return floor_to_uint((float(int(number)) + 0.5f) / float(int(divisor)));
}
uvec2 divide_whole(uvec2 number, uvec2 divisor)
{
    return uvec2(divide_whole(number.x, divisor.x), divide_whole(number.y, divisor.y));
}

// number % divisor
uint remainder_whole(uint number, uint divisor)
{
    return number - divide_whole(number, divisor) * divisor;
}

#endif

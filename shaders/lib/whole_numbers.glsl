// SPDX-License-Identifier: GPL-2.0-or-later
// Division of whole numbers by way of floats: CPU drivers have no vectors for it and divide lane by lane.
#ifndef VKPT_LIB_WHOLE_NUMBERS
#define VKPT_LIB_WHOLE_NUMBERS

#include "../shared/functions.h"

// number / divisor, exact for numbers below 2^22. Through int: that driver has no quick way from unsigned to float either.
uint divide_whole(uint number, uint divisor)
{
    return uint(int((float(int(number)) + 0.5f) / float(int(divisor))));
}

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// What earlier frames' shadow rays tell of the lights' visibility, per patch of the map's surfaces and per light.
// docs/light-sampling.md tells the method.
#ifndef VKPT_SHARED_LIGHT_VISIBILITY_H
#define VKPT_SHARED_LIGHT_VISIBILITY_H

#include "language.h"

VKPT_SHARED_BEGIN

VKPT_CONST float VISIBILITY_PATCH = 32.0f; // edge of a patch, units
// Patches are hashed to the table's rows, a patch's lights to the row's slots by their number: neighbouring lights have
// slots of their own. Who shares one shares what is believed of them.
VKPT_CONST uint VISIBILITY_GRID = 128u; // the rows as a square
VKPT_CONST uint VISIBILITY_ROWS = VISIBILITY_GRID * VISIBILITY_GRID;
VKPT_CONST uint VISIBILITY_SLOTS = 64u; // of two bits each: how many thirds of a light are believed to be hidden
// What of a light's weight remains where none of its shadow rays has arrived. The second moment of an estimate that is
// led astray is at most 1 / this times what it was.
VKPT_CONST float VISIBILITY_LEAST = 0.2f;
// A slot's count: shadow rays in the lower half, those of them that arrived in the upper one.
VKPT_CONST uint VISIBILITY_ARRIVED = 0x10001u, VISIBILITY_BLOCKED = 1u;
VKPT_CONST uint VISIBILITY_MAX_COUNT = 64u; // older rays are forgotten beyond: doors open
VKPT_CONST uint VISIBILITY_MAX_RAYS
    = 60000u; // about so many are counted between publications: halves must not overflow

// Addresses of the table, and what this frame does to it.
struct LightVisibilityView {
    uint64_t rows; // uvec4 each; 0: there is no table
    uint64_t counts; // VISIBILITY_SLOTS uints for each row
    uint counted_tiles; // of a power of two of tiles of 4 x 4 pixels one is counted: that less 1
    uint static_emitters; // emitters below are the map's, which keep their numbers; others are not counted
};

VKPT_SHARED_END

#endif

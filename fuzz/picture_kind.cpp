// SPDX-License-Identifier: GPL-2.0-or-later
// What tells the programs of picture_fuzzer.cpp apart.
extern const char* const picture_kind;
const char* const picture_kind = VKPT_PICTURE;

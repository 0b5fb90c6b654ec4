// SPDX-License-Identifier: GPL-2.0-or-later
// The engine's dynamic lights as it sends them, for passes that do not trace them.
#ifndef VKPT_LIB_DLIGHTS
#define VKPT_LIB_DLIGHTS

#include "frame.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer DlightBuffer { Dlight v[]; };

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// What a window is sent, by the shaders' own functions.
#pragma once

#include "shaders/shared/present.h"

#include <glm/glm.hpp>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace vkpt::tests {
namespace {
namespace glsl {
using namespace vkpt::shared;
using namespace ::glm;
using uint = uint32_t;
#include "shaders/lib/present_packing.glsl"
} // namespace glsl
} // namespace
} // namespace vkpt::tests
#pragma GCC diagnostic pop

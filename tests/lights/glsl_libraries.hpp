// SPDX-License-Identifier: GPL-2.0-or-later
// The function libraries of shaders/lib as C++, in vkpt::test::glsl. Include it in one source file per test program
// part: its functions are not inline, hence the anonymous namespace.
#pragma once

#include "ref_vkpt/lights/packed_lights.hpp"
#include "shaders/shared/cvars.h"
#include "shaders/shared/functions.h"
#include "shaders/shared/light_sampler.h"
#include "shaders/shared/light_visibility.h"
#include "shaders/shared/ltc.h"
#include "shaders/shared/noise.h"
#include "shaders/shared/octahedral.h"
#include "shaders/shared/scene.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace vkpt::test::glsl {
namespace {

using namespace vkpt::shared;
using namespace ::glm;

#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/emitters.glsl"
#include "shaders/lib/light_lists.glsl"
#include "shaders/lib/light_subsets.glsl"
#include "shaders/lib/light_weights.glsl"
#include "shaders/lib/packing.glsl"
#include "shaders/lib/random.glsl"

} // namespace
} // namespace vkpt::test::glsl
#pragma GCC diagnostic pop

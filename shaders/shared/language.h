// SPDX-License-Identifier: GPL-2.0-or-later
// Lets one header be read as C++ and as GLSL (scalar block layout: C++ packs these types the same way).
#ifndef VKPT_SHARED_LANGUAGE_H
#define VKPT_SHARED_LANGUAGE_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#define VKPT_SHARED_BEGIN namespace vkpt::shared {
#define VKPT_SHARED_END }
namespace vkpt::shared {
using uint = uint32_t;
using glm::ivec2;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
} // namespace vkpt::shared
#define VKPT_CONST inline constexpr
#define VKPT_ASSERT_SIZE(type, bytes) static_assert(sizeof(type) == (bytes))
#else
#define VKPT_SHARED_BEGIN
#define VKPT_SHARED_END
#define VKPT_CONST const
#define VKPT_ASSERT_SIZE(type, bytes)
#endif

#endif

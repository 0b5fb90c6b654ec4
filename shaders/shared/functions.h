// SPDX-License-Identifier: GPL-2.0-or-later
// Lets the function libraries (shaders/lib, shaders/light_samplers) be read as GLSL and as C++, so that tests run the
// very code that the shaders run. Rules for such a file: floats with the suffix f, no swizzles of more than one
// component, INOUT(T) for inout parameters, buffers by VKPT_BUFFER, no global bindings. A C++ user includes the shared
// headers that the library reads and this one at file level, then the library inside a namespace that says `using
// namespace vkpt::shared; using namespace glm;`.
#ifndef VKPT_SHARED_FUNCTIONS_H
#define VKPT_SHARED_FUNCTIONS_H

#include "language.h"

#ifdef __cplusplus
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>
#define VKPT_INLINE inline
#define INOUT(type) type&
#define ROLLED_FOR for
#define UNROLLED_FOR for
// Elements are name.v[i]. `alignment` is what the address is known to be a multiple of.
#define VKPT_BUFFER(name, type, alignment)                                                                             \
    struct name {                                                                                                      \
        const type* v = nullptr;                                                                                       \
    }
#else
#extension GL_EXT_control_flow_attributes : require
#define VKPT_INLINE
#define INOUT(type) inout type
#define ROLLED_FOR [[dont_unroll]] for
#define UNROLLED_FOR [[unroll]] for
#define VKPT_BUFFER(name, type, alignment)                                                                             \
    layout(buffer_reference, scalar, buffer_reference_align = alignment) readonly buffer name { type v[]; }
#endif

#endif

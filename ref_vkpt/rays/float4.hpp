// SPDX-License-Identifier: GPL-2.0-or-later
// Four floats in a vector register, by the compilers' vector extension: operators work on all four at once.
#pragma once

#include "ref_vkpt/rays/binary_tree.hpp"

#include <glm/vec3.hpp>

namespace vkpt {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));

inline Float4 splat(float value) { return Float4 { value, value, value, value }; }
inline Float4 to_float4(glm::vec3 v) { return Float4 { v.x, v.y, v.z, 0.0f }; }
inline glm::vec3 to_vec3(Float4 v) { return { v[0], v[1], v[2] }; }

// Where `value` is NaN, the other one.
inline Float4 lower(Float4 value, Float4 other) { return value < other ? value : other; }
inline Float4 higher(Float4 value, Float4 other) { return value > other ? value : other; }

// A box in the first three lanes; the fourth is anybody's.
struct Box4 {
    Float4 low = splat(std::numeric_limits<float>::max());
    Float4 high = splat(std::numeric_limits<float>::lowest());

    // A NaN leaves the box as it is.
    void add(Float4 p)
    {
        low = lower(p, low);
        high = higher(p, high);
    }
    void add(const Box4& box)
    {
        low = lower(box.low, low);
        high = higher(box.high, high);
    }
    Box to_box() const { return { to_vec3(low), to_vec3(high) }; }
};
inline Box4 to_box4(const Box& box) { return { to_float4(box.low), to_float4(box.high) }; }

} // namespace vkpt

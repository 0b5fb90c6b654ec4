// SPDX-License-Identifier: GPL-2.0-or-later
// Random numbers that are the same in every run: of our own, for the game's must not be disturbed.
#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace vkpt::game {

// Marsaglia's xorshift, 32 bits.
class Random {
public:
    explicit Random(uint32_t seed)
        : state_(seed * 2654435761u ^ 0x9e3779b9u)
    {
        if (state_ == 0)
            state_ = 1;
    }
    uint32_t next()
    {
        state_ ^= state_ << 13;
        state_ ^= state_ >> 17;
        state_ ^= state_ << 5;
        return state_;
    }
    // 0..1, without 1.
    float share() { return float(next() >> 8) / float(1 << 24); }
    float between(float least, float most) { return least + (most - least) * share(); }
    glm::vec3 direction()
    {
        for (;;) {
            const glm::vec3 v(between(-1, 1), between(-1, 1), between(-1, 1));
            if (const float length2 = glm::dot(v, v); length2 <= 1 && length2 > 0.01f)
                return v / glm::length(v);
        }
    }

private:
    uint32_t state_;
};

} // namespace vkpt::game

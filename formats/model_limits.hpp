// SPDX-License-Identifier: GPL-2.0-or-later
// What every reader of models checks.
#pragma once

#include "formats/byte_reader.hpp"

#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>

namespace formats {

// Of a position: false for NaN, too.
inline bool is_sane_position(glm::vec3 v)
{
    constexpr float limit = 1e6f; // far outside of any map
    return std::abs(v.x) < limit && std::abs(v.y) < limit && std::abs(v.z) < limit;
}

// A few bytes of a file may stand for many frames of many vertices: a hostile one must not fill the memory.
class ExpandedSize {
public:
    // Before the memory for positions and normals is taken. `place`: what asks for it.
    void add(const ByteReader& reader, size_t place, uint64_t frames, uint64_t vertices)
    {
        bytes_ += frames * vertices * 2 * sizeof(glm::vec3);
        if (bytes_ > max_bytes)
            reader.fail_at(place,
                "the model is too large: " + std::to_string(frames) + " frames of " + std::to_string(vertices)
                    + " vertices; use fewer of either");
    }

private:
    static constexpr uint64_t max_bytes = uint64_t(128) << 20;
    uint64_t bytes_ = 0;
};

// Those that lie packed in the file from `place` on.
inline void check_texture_coordinates(const ByteReader& reader, size_t place, std::span<const glm::vec2> coordinates)
{
    constexpr float limit = 1e4f; // times round the skin
    for (size_t i = 0; i < coordinates.size(); i++)
        if (!(std::abs(coordinates[i].x) < limit && std::abs(coordinates[i].y) < limit))
            reader.fail_at(place + i * sizeof(glm::vec2), "a texture coordinate is not a sensible number; unwrap anew");
}

} // namespace formats

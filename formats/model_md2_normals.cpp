// SPDX-License-Identifier: GPL-2.0-or-later
// The 162 directions, by construction. Their order in the format is that in which a walk over the faces meets them
// first: each face is split in four at its edges' middles, and the pieces at its three corners are split once more.
#include "formats/md2_disk.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace formats::md2_disk {

namespace {

using Directions = std::array<glm::vec3, 162>;

class Walk {
public:
    Directions take()
    {
        // Corners of three golden rectangles, numbered as the walk meets them; a face names its corners in walking
        // order.
        const double longer = std::sqrt((5 + std::sqrt(5.0)) / 10), shorter = std::sqrt((5 - std::sqrt(5.0)) / 10);
        const float l = float(longer), s = float(shorter);
        const std::array<glm::vec3, 12> corners { { { -s, 0, l }, { 0, l, s }, { s, 0, l }, { -l, s, 0 }, { 0, l, -s },
            { l, s, 0 }, { l, -s, 0 }, { s, 0, -l }, { -s, 0, -l }, { 0, -l, -s }, { 0, -l, s }, { -l, -s, 0 } } };
        constexpr uint8_t faces[20][3] = { { 0, 1, 2 }, { 0, 3, 1 }, { 3, 4, 1 }, { 1, 4, 5 }, { 1, 5, 2 }, { 5, 6, 2 },
            { 5, 7, 6 }, { 4, 7, 5 }, { 4, 8, 7 }, { 8, 9, 7 }, { 9, 6, 7 }, { 9, 10, 6 }, { 9, 11, 10 }, { 11, 0, 10 },
            { 0, 2, 10 }, { 10, 2, 6 }, { 3, 0, 11 }, { 3, 11, 8 }, { 3, 8, 4 }, { 9, 8, 11 } };
        for (const auto& [a, b, c] : faces)
            visit_face(corners[a], corners[b], corners[c]);
        return directions_;
    }

private:
    static glm::vec3 middle(glm::vec3 a, glm::vec3 b) { return (a + b) * 0.5f; }

    void visit_face(glm::vec3 a, glm::vec3 b, glm::vec3 c)
    {
        const glm::vec3 ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        visit_corner(a, ab, ca);
        visit_corner(b, ab, bc);
        visit_corner(c, ca, bc);
    }

    void visit_corner(glm::vec3 corner, glm::vec3 left, glm::vec3 right)
    {
        for (const glm::vec3& point :
            { corner, middle(corner, left), middle(corner, right), left, middle(left, right), right })
            visit(glm::normalize(point));
    }

    void visit(glm::vec3 direction)
    {
        const auto end = directions_.begin() + ptrdiff_t(count_);
        if (std::none_of(directions_.begin(), end, [&](glm::vec3 met) { return glm::dot(met, direction) > 0.999f; }))
            directions_[count_++] = direction;
    }

    Directions directions_ {};
    size_t count_ = 0;
};

} // namespace

std::span<const glm::vec3, 162> normal_directions()
{
    static const Directions directions = Walk().take();
    return directions;
}

uint8_t nearest_direction(glm::vec3 normal)
{
    const auto directions = normal_directions();
    const auto nearest = std::max_element(directions.begin(), directions.end(),
        [&](glm::vec3 a, glm::vec3 b) { return glm::dot(a, normal) < glm::dot(b, normal); });
    return uint8_t(nearest - directions.begin());
}

} // namespace formats::md2_disk

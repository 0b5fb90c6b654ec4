// SPDX-License-Identifier: GPL-2.0-or-later
// Cuts convex face outlines into triangles. Outlines carry corners on straight edges, where a neighbour's corner lies;
// a plain fan would lose those and leave pinholes, so we search for the cut whose flattest triangle is the least flat.
#include "ref_vkpt/lights/face_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace vkpt {

namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;

constexpr float min_doubled_area = 1e-3f; // units^2; flatter triangles are no triangles
constexpr size_t max_searched_outline = 40; // the search is cubic

// The smallest height of a triangle.
float measure_height(const std::vector<glm::vec3>& p, size_t a, size_t b, size_t c)
{
    const float longest = std::max({ glm::distance(p[a], p[b]), glm::distance(p[b], p[c]), glm::distance(p[c], p[a]) });
    return longest > 0 ? glm::length(glm::cross(p[b] - p[a], p[c] - p[a])) / longest : 0;
}

Triangles cut_fan(size_t count)
{
    Triangles triangles;
    for (uint32_t i = 1; i + 1 < count; i++)
        triangles.push_back({ 0, i, i + 1 });
    return triangles;
}

// Dynamic programming over chords (i, k): the best least height of the part of the outline between i and k.
class OutlineCut {
public:
    explicit OutlineCut(const std::vector<glm::vec3>& outline)
        : outline_(outline)
        , count_(outline.size())
        , height_(count_ * count_, 1e30f)
        , apex_(count_ * count_, 0)
    {
        for (size_t span = 2; span < count_; span++)
            for (size_t i = 0; i + span < count_; i++)
                choose_apex(i, i + span);
    }

    void collect(size_t i, size_t k, Triangles& triangles) const
    {
        if (k - i < 2)
            return;
        const size_t j = apex_[i * count_ + k];
        collect(i, j, triangles);
        triangles.push_back({ uint32_t(i), uint32_t(j), uint32_t(k) });
        collect(j, k, triangles);
    }

private:
    void choose_apex(size_t i, size_t k)
    {
        float best = -1;
        for (size_t j = i + 1; j < k; j++) {
            const float height
                = std::min({ height_[i * count_ + j], height_[j * count_ + k], measure_height(outline_, i, j, k) });
            if (height > best) {
                best = height;
                apex_[i * count_ + k] = j;
            }
        }
        height_[i * count_ + k] = best;
    }

    const std::vector<glm::vec3>& outline_;
    size_t count_;
    std::vector<float> height_;
    std::vector<size_t> apex_;
};

} // namespace

Triangles triangulate(const std::vector<glm::vec3>& outline, glm::vec3 normal)
{
    if (outline.size() < 3)
        return {};
    Triangles triangles;
    if (outline.size() > 4 && outline.size() <= max_searched_outline)
        OutlineCut(outline).collect(0, outline.size() - 1, triangles);
    else
        triangles = cut_fan(outline.size());

    Triangles kept;
    for (std::array<uint32_t, 3> t : triangles) {
        const glm::vec3 doubled_area = glm::cross(outline[t[1]] - outline[t[0]], outline[t[2]] - outline[t[0]]);
        const float towards_front = glm::dot(doubled_area, normal);
        if (!(std::abs(towards_front) > min_doubled_area))
            continue;
        if (towards_front < 0)
            std::swap(t[1], t[2]);
        kept.push_back(t);
    }
    return kept;
}

} // namespace vkpt

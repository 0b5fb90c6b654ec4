// SPDX-License-Identifier: GPL-2.0-or-later
// Rays among triangles in double precision: a tree of boxes halved by the median.
#pragma once

#include "tests/truth/exported_scene.hpp"

#include <cstdint>
#include <limits>

namespace vkpt::truth {

struct RayHit {
    int triangle = -1; // -1: nothing was met
    double t = std::numeric_limits<double>::infinity();
    double b1 = 0, b2 = 0; // weights of the second and third corner
};

class RayTree {
public:
    explicit RayTree(const std::vector<Triangle>& triangles);
    // The nearest triangle whose mask has a bit of `mask`, before t_max.
    RayHit find_nearest(dvec3 origin, dvec3 direction, double t_max, uint32_t mask) const;
    bool is_blocked(dvec3 origin, dvec3 direction, double t_max, uint32_t mask) const;

private:
    struct Node {
        dvec3 mins { std::numeric_limits<double>::infinity() }, maxs { -std::numeric_limits<double>::infinity() };
        uint32_t first = 0, count = 0; // of triangles, in leaves
        uint32_t second = 0; // child; the first child follows its parent
    };
    void build(uint32_t first, uint32_t count);
    template <class Visit> void visit_leaves(dvec3 origin, dvec3 direction, const double& t_max, Visit visit) const;

    const std::vector<Triangle>& triangles_;
    std::vector<uint32_t> order_;
    std::vector<dvec3> centres_;
    std::vector<Node> nodes_;
};

} // namespace vkpt::truth

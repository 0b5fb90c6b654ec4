// SPDX-License-Identifier: GPL-2.0-or-later
// Planes and convex polygons in double precision. Quake units.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <unordered_map>
#include <vector>

namespace vkpt::tools {

using glm::dvec3;

// Points nearer than this to a plane lie on it.
inline constexpr double on_epsilon = 0.05;
// Half the width of the world that Quake II's network protocol can address.
inline constexpr double world_limit = 4096.0;

struct Plane {
    dvec3 normal { 0 };
    double dist = 0;
    int type = 0; // 0..2 axial x, y, z; 3..5 nearest axis

    double distance(const dvec3& p) const { return glm::dot(normal, p) - dist; }
    Plane flipped() const { return { -normal, -dist, type }; }
};

// A convex polygon, clockwise seen from the front of its plane (as Quake II's files store faces).
using Winding = std::vector<dvec3>;

struct Bounds {
    dvec3 mins { 1e30 }, maxs { -1e30 };

    void add(const dvec3& p)
    {
        mins = glm::min(mins, p);
        maxs = glm::max(maxs, p);
    }
    void add(const Bounds& other)
    {
        mins = glm::min(mins, other.mins);
        maxs = glm::max(maxs, other.maxs);
    }
    void add(const Winding& winding)
    {
        for (const dvec3& p : winding)
            add(p);
    }
    bool empty() const { return mins.x > maxs.x; }
};

// The map's planes in pairs: index 2k looks towards its positive major axis, 2k+1 is its opposite.
class PlaneSet {
public:
    // The existing plane within tolerance (normals and whole-numbered distances are snapped), or a new one.
    int find(dvec3 normal, double dist);
    const Plane& operator[](int index) const { return planes_[size_t(index)]; }
    size_t size() const { return planes_.size(); }
    const std::vector<Plane>& all() const { return planes_; }

private:
    std::vector<Plane> planes_;
    std::unordered_multimap<long, int> by_distance_; // key: |dist| in steps of 8
};

// A square on the plane, larger than the world.
Winding make_base_winding(const Plane& plane);

// The part in front of the plane; empty when nothing is left. A winding on the plane is kept where keep_on.
Winding clip_winding(const Winding& winding, const Plane& plane, double epsilon = on_epsilon, bool keep_on = false);

struct SplitWinding {
    Winding front, back;
    bool on = false; // lies in the plane: neither side filled
};
SplitWinding split_winding(const Winding& winding, const Plane& plane, double epsilon = on_epsilon);

double winding_area(const Winding& winding);
dvec3 winding_centre(const Winding& winding);
// Too thin to be worth keeping: fewer than three edges of visible length.
bool is_tiny(const Winding& winding);
Plane winding_plane(const Winding& winding);
Winding reversed(const Winding& winding);

} // namespace vkpt::tools

// SPDX-License-Identifier: GPL-2.0-or-later
// Sampling a triangle uniformly in projected solid angle: the density is cosine / projected solid angle, so that on
// matte surfaces each unshadowed sample is worth the same. After the idea of Peters 2021, "BRDF Importance Sampling for
// Polygonal Lights": on the unit disc below the hemisphere, edges of spherical polygons are arcs of ellipses around the
// origin. The area between such an arc and the origin is known in closed form; its inverse in the azimuth is found by
// Newton's method. Space: x and y along the surface, z along its normal.
#ifndef VKPT_LIB_PROJECTED_TRIANGLE
#define VKPT_LIB_PROJECTED_TRIANGLE

#include "../shared/functions.h"
#include "bsdf.glsl"

// The part of a triangle above the horizon: three or four corners, 0: nothing.
struct ClippedTriangle {
    uint count;
    vec3 v0, v1, v2, v3; // v3 = v2 where there are three
};

vec3 cut_at_horizon(vec3 a, vec3 b)
{
    vec3 cut = a + (b - a) * (a.z / (a.z - b.z));
    cut.z = 0.0f;
    return cut;
}

// Keeps the order of the corners.
ClippedTriangle clip_to_horizon(vec3 a, vec3 b, vec3 c)
{
    ClippedTriangle result;
    uint above = (a.z > 0.0f ? 1u : 0u) + (b.z > 0.0f ? 1u : 0u) + (c.z > 0.0f ? 1u : 0u);
    result.count = above == 0u ? 0u : above == 2u ? 4u : 3u;
    result.v0 = a;
    result.v1 = b;
    result.v2 = c;
    result.v3 = c;
    if (above == 0u || above == 3u)
        return result;
    // Turned so that the corner that is alone on its side comes first.
    bool lone_above = above == 1u;
    vec3 lone = a, next = b, last = c;
    if ((b.z > 0.0f) == lone_above) {
        lone = b;
        next = c;
        last = a;
    } else if ((c.z > 0.0f) == lone_above) {
        lone = c;
        next = a;
        last = b;
    }
    vec3 cut_next = cut_at_horizon(lone, next), cut_last = cut_at_horizon(lone, last);
    if (lone_above) {
        result.v0 = lone;
        result.v1 = cut_next;
        result.v2 = cut_last;
        result.v3 = cut_last;
    } else {
        result.v0 = cut_next;
        result.v1 = next;
        result.v2 = last;
        result.v3 = cut_last;
    }
    return result;
}

// Lambert's sum for one edge between unit vectors: the signed projected solid angle of its triangle with the zenith.
float projected_edge(vec3 a, vec3 b)
{
    vec3 across = cross(a, b);
    float sine = length(across);
    return sine > 0.0f ? 0.5f * atan(sine, dot(a, b)) * across.z / sine : 0.0f;
}

float projected_area(vec3 a, vec3 b, vec3 c)
{
    return abs(projected_edge(a, b) + projected_edge(b, c) + projected_edge(c, a));
}

// A triangle as seen by a surface, cut at the horizon and split in two where that leaves four corners.
struct ProjectedTriangle {
    vec3 x, y, z; // the surface's axes in the world
    vec3 v0, v1, v2, v3; // unit
    float first_area; // of v0, v1, v2
    float area; // with v0, v2, v3; 0: below the horizon
};

vec3 to_axes(vec3 v, vec3 x, vec3 y, vec3 z) { return vec3(dot(v, x), dot(v, y), dot(v, z)); }

// Corners relative to the surface.
ProjectedTriangle project_triangle(vec3 a, vec3 b, vec3 c, vec3 normal)
{
    ProjectedTriangle p;
    p.z = normal;
    p.x = any_tangent(normal);
    p.y = cross(normal, p.x);
    p.first_area = 0.0f;
    p.area = 0.0f;
    ClippedTriangle clipped
        = clip_to_horizon(to_axes(a, p.x, p.y, p.z), to_axes(b, p.x, p.y, p.z), to_axes(c, p.x, p.y, p.z));
    p.v0 = normalize(clipped.v0);
    p.v1 = normalize(clipped.v1);
    p.v2 = normalize(clipped.v2);
    p.v3 = normalize(clipped.v3);
    if (clipped.count == 0u)
        return p;
    p.first_area = projected_area(p.v0, p.v1, p.v2);
    p.area = p.first_area + (clipped.count == 4u ? projected_area(p.v0, p.v2, p.v3) : 0.0f);
    return p;
}

// The plane of a great circle, its normal pointing down: arcs of it above the horizon lie where dot(normal.xy, azimuth)
// > 0.
vec3 arc_normal(vec3 a, vec3 b)
{
    vec3 n = cross(a, b);
    float len = length(n);
    n = len > 1e-12f ? n / len : vec3(1.0f, 0.0f, 0.0f);
    return n.z > 0.0f ? -n : n;
}

// Squared distance of the projected arc from the origin, in the direction of the unit vector `azimuth`.
float arc_radius2(vec3 n, vec2 azimuth)
{
    float g = n.x * azimuth.x + n.y * azimuth.y;
    return n.z * n.z / max(g * g + n.z * n.z, 1e-20f);
}

float turn(vec2 from, vec2 to) { return from.x * to.y - from.y * to.x; }

// The area between the arc and the origin from one azimuth to another (unit vectors, less than half a turn). With psi
// counted from the ellipse's short axis, half the integral of radius^2 is |n.z| / 2 * atan(|n.z| tan psi); the
// difference of two such angles needs no axis, so that arcs along the horizon are no special case.
float arc_area(vec3 n, vec2 from, vec2 to)
{
    vec2 axis = vec2(n.x, n.y);
    return -0.5f * n.z * atan(-n.z * turn(from, to), dot(from, to) - turn(axis, from) * turn(axis, to));
}

// A part of the disc between two azimuths (counter-clockwise, less than half a turn) and two arcs. inner.z = 0: the
// origin.
struct Sector {
    vec3 outer, inner;
    vec2 from, to; // unit
    float area;
};

vec2 azimuth_of(vec3 v)
{
    float len2 = v.x * v.x + v.y * v.y;
    return len2 > 1e-24f ? vec2(v.x, v.y) * inversesqrt(len2) : vec2(1.0f, 0.0f);
}

Sector make_sector(vec3 arc, vec3 other_arc, vec3 from, vec3 to)
{
    Sector s;
    s.from = azimuth_of(from);
    s.to = azimuth_of(to);
    if (turn(s.from, s.to) < 0.0f) {
        vec2 swapped = s.from;
        s.from = s.to;
        s.to = swapped;
    }
    vec2 sum = s.from + s.to;
    vec2 middle = azimuth_of(vec3(sum.x, sum.y, 0.0f));
    bool outside = arc_radius2(arc, middle) >= arc_radius2(other_arc, middle);
    s.outer = outside ? arc : other_arc;
    s.inner = outside ? other_arc : arc;
    s.area = max(arc_area(s.outer, s.from, s.to) - arc_area(s.inner, s.from, s.to), 0.0f);
    return s;
}

const uint sector_newton_steps = 6u;

// The azimuth that splits the sector's area as xi.x says, then a radius between the arcs.
vec3 sample_sector(Sector s, vec2 xi)
{
    float whole = atan(max(turn(s.from, s.to), 0.0f), dot(s.from, s.to));
    float d0 = arc_radius2(s.outer, s.from) - arc_radius2(s.inner, s.from);
    float d1 = arc_radius2(s.outer, s.to) - arc_radius2(s.inner, s.to);
    d0 = max(d0, 0.0f);
    d1 = max(d1, 0.0f);
    // Exact if the width changed linearly.
    float guess = xi.x * (d0 + d1) / max(d0 + sqrt(d0 * d0 + (d1 * d1 - d0 * d0) * xi.x), 1e-12f);
    float low = 0.0f, high = whole;
    float angle = clamp(guess, 0.0f, 1.0f) * whole;
    float wanted = xi.x * s.area;
    vec2 sideways = vec2(-s.from.y, s.from.x);
    vec2 azimuth = s.from;
    for (uint i = 0u; i < sector_newton_steps; i++) {
        azimuth = s.from * cos(angle) + sideways * sin(angle);
        float excess = arc_area(s.outer, s.from, azimuth) - arc_area(s.inner, s.from, azimuth) - wanted;
        if (excess > 0.0f)
            high = angle;
        else
            low = angle;
        float slope = 0.5f * (arc_radius2(s.outer, azimuth) - arc_radius2(s.inner, azimuth));
        float next = slope > 1e-9f ? angle - excess / slope : low;
        angle = next > low && next < high ? next : 0.5f * (low + high);
    }
    azimuth = s.from * cos(angle) + sideways * sin(angle);
    float inner2 = arc_radius2(s.inner, azimuth), outer2 = max(arc_radius2(s.outer, azimuth), inner2);
    float radius2 = inner2 + (outer2 - inner2) * xi.y;
    float radius = sqrt(radius2);
    return vec3(azimuth.x * radius, azimuth.y * radius, sqrt(max(1.0f - radius2, 0.0f)));
}

// A spherical triangle above the horizon: around the zenith it has a sector below each edge; elsewhere its middle
// azimuth divides it in two.
vec3 sample_disc_triangle(vec3 a, vec3 b, vec3 c, vec2 xi)
{
    const vec3 origin = vec3(1.0f, 0.0f, 0.0f);
    float ab = cross(a, b).z, bc = cross(b, c).z, ca = cross(c, a).z;
    bool around_zenith = (ab > 0.0f) == (bc > 0.0f) && (bc > 0.0f) == (ca > 0.0f);
    Sector first, second, third;
    if (around_zenith) {
        first = make_sector(arc_normal(a, b), origin, a, b);
        second = make_sector(arc_normal(b, c), origin, b, c);
        third = make_sector(arc_normal(c, a), origin, c, a);
    } else {
        // The edge that turns the other way than both others spans them.
        vec3 left = a, middle = b, right = c;
        if ((ab > 0.0f) != (bc > 0.0f) && (ab > 0.0f) != (ca > 0.0f)) {
            left = b;
            middle = c;
            right = a;
        } else if ((bc > 0.0f) != (ab > 0.0f) && (bc > 0.0f) != (ca > 0.0f)) {
            left = c;
            middle = a;
            right = b;
        }
        vec3 long_arc = arc_normal(left, right);
        first = make_sector(arc_normal(left, middle), long_arc, left, middle);
        second = make_sector(arc_normal(middle, right), long_arc, middle, right);
        third = second;
        third.area = 0.0f;
    }
    float share = xi.x * (first.area + second.area + third.area);
    Sector chosen = first;
    if (share >= first.area) {
        share -= first.area;
        chosen = second;
        if (share >= second.area && third.area > 0.0f) {
            share -= second.area;
            chosen = third;
        }
    }
    float rest = chosen.area > 0.0f ? clamp(share / chosen.area, 0.0f, 1.0f) : 0.5f;
    return sample_sector(chosen, vec2(rest, xi.y));
}

// Unit direction in the world; density: cosine to the normal / p.area. p.area must not be 0.
vec3 sample_projected_triangle(ProjectedTriangle p, vec2 xi)
{
    float share = xi.x * p.area;
    bool in_first = share < p.first_area || p.area <= p.first_area;
    float rest = in_first ? share / p.first_area : (share - p.first_area) / (p.area - p.first_area);
    vec3 direction
        = sample_disc_triangle(p.v0, in_first ? p.v1 : p.v2, in_first ? p.v2 : p.v3, vec2(min(rest, 1.0f), xi.y));
    // Clear of the horizon, where the density would be 0.
    return normalize(p.x * direction.x + p.y * direction.y + p.z * max(direction.z, 1e-4f));
}

#endif

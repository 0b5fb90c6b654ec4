// SPDX-License-Identifier: GPL-2.0-or-later
// One emitter: what it sends to a surface, picking a point on it, and the density of that.
// An Emitter passed to these functions has its lightstyle already multiplied into `radiance` (load_emitter does it).
#ifndef VKPT_LIB_EMITTERS
#define VKPT_LIB_EMITTERS

#include "../shared/functions.h"
#include "../shared/cvars.h"
#include "../shared/scene.h"
#include "bsdf.glsl"
#include "projected_triangle.glsl"

VKPT_BUFFER(LtcBuffer, float, 4);

// How lights are chosen, and points on them.
struct LightOptions {
    uint subset_length; // pt_light_subset
    int weight; // LIGHT_WEIGHT_*
    int point; // LIGHT_POINT_*
    LtcBuffer ltc; // LTC_* of shared/ltc.h
    uvec4 hidden; // a row of the table of shared/light_visibility.h; 0: every light is believed to be in sight
};

struct EmitterSample {
    vec3 point;
    vec3 direction; // from the receiver, unit
    float distance;
    vec3 radiance; // towards the receiver. EMITTER_SKY: the average, replace it by the sky's in `direction`
    float pdf; // per solid angle at the receiver; 0: this emitter does not light the receiver
};

const float emitter_pi = 3.14159265358979f;
// Triangles are sampled by solid angle from here on; below, float rounding would show, and area sampling is as good.
const float min_spherical_angle = 3e-4f;
// Below this projected solid angle, too, uniform sampling takes over.
const float min_projected_angle = 3e-4f;

// Whether bounce rays meet all of the emitter's front, wherever it is not hidden. Spheres are lights without a surface
// in the scene, and rays pass what is translucent or cut out: light sampling alone accounts for those.
bool is_sphere(Emitter e) { return e.type == EMITTER_SPHERE || e.type == EMITTER_SUN; }

bool is_met_by_rays(Emitter e) { return e.type == EMITTER_TRIANGLE || e.type == EMITTER_SKY; }

// Emitters with a reach fade to nothing there, smoothly: (1 - (d / reach)^4)^2.
float reach_window(vec3 to_emitter, float reach)
{
    if (reach <= 0.0f)
        return 1.0f;
    float q = dot(to_emitter, to_emitter) / (reach * reach);
    float window = quick_max(1.0f - q * q, 0.0f);
    return window * window;
}

// How much of a spot's light arrives, by CONE_SLACK's rule. Without branches: a slope of 0 gives 1.
float cone_window(vec3 to_emitter, vec3 axis, float inner_cosine, float slope)
{
    float cosine = -dot(to_emitter, axis) * inversesqrt(quick_max(dot(to_emitter, to_emitter), 1e-20f));
    return quick_clamp(1.0f + slope * (cosine - inner_cosine), 0.0f, 1.0f);
}

// What a ray from `receiver` that hits the emitter's front sees (for hits found by BSDF sampling, too).
vec3 emitted_radiance(Emitter e, vec3 receiver)
{
    vec3 to_emitter = e.p0 - receiver;
    float window = reach_window(to_emitter, e.reach);
    if (e.type == EMITTER_SPHERE)
        window *= cone_window(to_emitter, e.p2, e.p1.z, e.p1.y);
    return e.radiance * window;
}

// The angle of (x, y) from the axis, y > 0, given that of the same lengths with the shorter one upright.
float unfold_angle(float angle, float y, float x)
{
    angle = y > abs(x) ? 0.5f * emitter_pi - angle : angle;
    return x < 0.0f ? emitter_pi - angle : angle;
}

// atan(y, x) for y > 0, relative error 2e-7 (polynomial: Abramowitz and Stegun 1964, 4.4.49). Drivers' own cost several
// times as much and may be less exact.
float angle_above_axis(float y, float x)
{
    float side = abs(x);
    float tangent = quick_min(y, side) / quick_max(y, side);
    float t2 = tangent * tangent;
    float series = 0.0429096138f + t2 * (-0.0161657367f + t2 * 0.0028662257f);
    series = -0.1420889944f + t2 * (0.1065626393f + t2 * (-0.0752896400f + t2 * series));
    float angle = tangent + tangent * t2 * (-0.3333314528f + t2 * (0.1999355085f + t2 * series));
    return unfold_angle(angle, y, x);
}

// A triangle's solid angle is 2 atan(volume, this): Van Oosterom and Strackee 1983. Corners relative to the eye;
// volume: six times the tetrahedron's, > 0 in front, which keeps its precision at tiny angles if it is worked out from
// the edges.
float solid_angle_denominator(vec3 a, vec3 b, vec3 c, vec3 lengths)
{
    return lengths.x * lengths.y * lengths.z + dot(a, b) * lengths.z + dot(b, c) * lengths.x + dot(c, a) * lengths.y;
}

// A triangle as seen from a point.
struct TriangleAspect {
    vec3 a, b, c; // receiver to corners
    vec3 edges_cross; // cross(p1 - p0, p2 - p0)
    float volume; // six times the tetrahedron's; > 0: the receiver is in front
    float solid_angle; // 0 where volume <= 0
    vec3 lengths; // of a, b, c
};

TriangleAspect view_triangle(Emitter e, vec3 receiver)
{
    TriangleAspect t;
    t.a = e.p0 - receiver;
    t.b = e.p1 - receiver;
    t.c = e.p2 - receiver;
    t.edges_cross = cross(e.p1 - e.p0, e.p2 - e.p0);
    t.volume = -dot(t.a, t.edges_cross);
    t.solid_angle = 0.0f;
    t.lengths = vec3(length(t.a), length(t.b), length(t.c));
    if (t.volume > 0.0f)
        t.solid_angle = 2.0f * angle_above_axis(t.volume, solid_angle_denominator(t.a, t.b, t.c, t.lengths));
    return t;
}

// Arvo 1995: first the sub-triangle (a, b, c') that has the share xi.x of the solid angle, c' on the arc from a to c;
// then uniform height on the arc from b to c'. c' without trigonometric inverses: write it as the mirror image of a at
// r = p a + q c; then tan(angle / 2) = q G0 / (p G2 + q G1) with the G below, which is linear in p and q.
vec3 sample_spherical_triangle(TriangleAspect t, vec2 xi)
{
    vec3 inverse = vec3(1.0f) / t.lengths;
    vec3 a = t.a * inverse.x;
    vec3 b = t.b * inverse.y;
    vec3 c = t.c * inverse.z;
    float g0 = t.volume * inverse.x * inverse.y * inverse.z;
    float g1 = dot(a, c) + dot(b, c);
    float g2 = 1.0f + dot(a, b);
    float half_angle = 0.5f * t.solid_angle * xi.x;
    float sine = sin(half_angle);
    vec3 r = a * (g0 * cos(half_angle) - g1 * sine) + c * (g2 * sine);
    float r2 = dot(r, r);
    vec3 top = r2 > 0.0f ? r * (2.0f * dot(a, r) / r2) - a : a;

    vec3 chord = top - b;
    float depth = xi.y * 0.5f * dot(chord, chord); // 1 - cosine of the angle from b
    vec3 sideways = top - b * dot(b, top);
    float sideways2 = dot(sideways, sideways);
    if (sideways2 < 1e-14f)
        return b;
    float sideways_length = sqrt(quick_max(depth * (2.0f - depth), 0.0f) / sideways2);
    return normalize(b * (1.0f - depth) + sideways * sideways_length);
}

EmitterSample no_emitter_sample(Emitter e)
{
    EmitterSample result;
    result.point = e.p0;
    result.direction = vec3(0.0f, 0.0f, 1.0f);
    result.distance = 0.0f;
    result.radiance = vec3(0.0f);
    result.pdf = 0.0f;
    return result;
}

// How the points of one triangle are drawn for one surface. pdf_emitter_point takes the same decision.
struct TriangleSampling {
    int method; // LIGHT_POINT_*
    ProjectedTriangle projected;
};

TriangleSampling choose_triangle_sampling(TriangleAspect t, Surface s, LightOptions options)
{
    TriangleSampling sampling;
    sampling.method = options.point;
    if (sampling.method == LIGHT_POINT_PROJECTED) {
        sampling.projected = project_triangle(t.a, t.b, t.c, s.normal);
        if (sampling.projected.area < min_projected_angle)
            sampling.method = LIGHT_POINT_SOLID_ANGLE;
    }
    if (sampling.method == LIGHT_POINT_SOLID_ANGLE && t.solid_angle < min_spherical_angle)
        sampling.method = LIGHT_POINT_AREA;
    return sampling;
}

float pdf_of_direction(TriangleAspect t, TriangleSampling sampling, Surface s, vec3 direction, float distance)
{
    if (sampling.method == LIGHT_POINT_PROJECTED)
        return quick_max(dot(direction, s.normal), 0.0f) / sampling.projected.area;
    if (sampling.method == LIGHT_POINT_SOLID_ANGLE)
        return 1.0f / t.solid_angle;
    // Distance^2 / (area * cosine), where area * cosine = volume / (2 * distance).
    return 2.0f * distance * distance * distance / t.volume;
}

EmitterSample sample_triangle_point(Emitter e, Surface s, vec2 xi, LightOptions options)
{
    EmitterSample result = no_emitter_sample(e);
    TriangleAspect t = view_triangle(e, s.position);
    if (t.volume <= 0.0f || t.solid_angle <= 0.0f)
        return result;
    TriangleSampling sampling = choose_triangle_sampling(t, s, options);
    if (sampling.method == LIGHT_POINT_AREA) {
        float root = sqrt(xi.x);
        vec3 offset = t.a * (1.0f - root) + t.b * (root * (1.0f - xi.y)) + t.c * (root * xi.y);
        result.distance = length(offset);
        if (result.distance <= 0.0f)
            return result;
        result.direction = offset / result.distance;
    } else {
        if (sampling.method == LIGHT_POINT_PROJECTED)
            result.direction = sample_projected_triangle(sampling.projected, xi);
        else
            result.direction = sample_spherical_triangle(t, xi);
        float farthest = sqrt(quick_max3(vec3(dot(t.a, t.a), dot(t.b, t.b), dot(t.c, t.c))));
        // Grazing rays may be rounded past the plane: no point of the triangle is farther than its farthest corner.
        float slope = quick_max(-dot(result.direction, t.edges_cross), t.volume / farthest);
        result.distance = t.volume / slope;
    }
    result.pdf = pdf_of_direction(t, sampling, s, result.direction, result.distance);
    result.point = s.position + result.direction * result.distance;
    result.radiance = emitted_radiance(e, s.position);
    return result;
}

// 1 - cosine of the half angle under which a sphere appears; 2 inside of it: it is all around.
float sphere_cone_depth(vec3 to_centre, float radius)
{
    float distance2 = dot(to_centre, to_centre);
    float sine2 = radius * radius / quick_max(distance2, 1e-20f);
    if (sine2 >= 1.0f)
        return 2.0f;
    return sine2 / (1.0f + sqrt(1.0f - sine2));
}

// A receiver inside the sphere (a wall that a dynamic light grazes) is lit from all around: the irradiance is
// continuous.
EmitterSample sample_sphere_point(Emitter e, vec3 receiver, vec2 xi)
{
    EmitterSample result;
    float radius = e.p1.x;
    vec3 to_centre = e.p0 - receiver;
    float centre_distance2 = dot(to_centre, to_centre);
    float cone_depth = sphere_cone_depth(to_centre, radius);
    bool inside = cone_depth >= 2.0f;
    vec3 axis = centre_distance2 > 1e-12f ? to_centre * inversesqrt(centre_distance2) : vec3(0.0f, 0.0f, 1.0f);
    vec3 tangent = any_tangent(axis);
    vec3 bitangent = cross(axis, tangent);
    float depth = xi.x * cone_depth;
    float sine2 = quick_max(depth * (2.0f - depth), 0.0f);
    float phi = 2.0f * emitter_pi * xi.y;
    float sine = sqrt(sine2);
    result.direction = normalize(axis * (1.0f - depth) + (tangent * cos(phi) + bitangent * sin(phi)) * sine);
    float along = sqrt(centre_distance2) * (1.0f - depth);
    float chord = sqrt(quick_max(radius * radius - centre_distance2 * sine2, 0.0f));
    result.distance = inside ? along + chord : along - chord;
    result.point = receiver + result.direction * result.distance;
    result.radiance = emitted_radiance(e, receiver);
    result.pdf = radius > 0.0f ? 1.0f / (2.0f * emitter_pi * cone_depth) : 0.0f;
    return result;
}

// `xi` in [0, 1)^2. Triangles by options.point, spheres by the cone under which they appear.
EmitterSample sample_emitter_point(Emitter e, Surface s, vec2 xi, LightOptions options)
{
    if (is_sphere(e))
        return sample_sphere_point(e, s.position, xi);
    return sample_triangle_point(e, s, xi, options);
}

// Density with which sample_emitter_point picks `point` (on the emitter, visible from the surface), per solid angle.
float pdf_emitter_point(Emitter e, Surface s, vec3 point, LightOptions options)
{
    if (is_sphere(e)) {
        float cone_depth = sphere_cone_depth(e.p0 - s.position, e.p1.x);
        return e.p1.x > 0.0f ? 1.0f / (2.0f * emitter_pi * cone_depth) : 0.0f;
    }
    TriangleAspect t = view_triangle(e, s.position);
    if (t.volume <= 0.0f || t.solid_angle <= 0.0f)
        return 0.0f;
    vec3 offset = point - s.position;
    float distance = length(offset);
    return pdf_of_direction(t, choose_triangle_sampling(t, s, options), s, offset / distance, distance);
}

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// One emitter: picking a point on it, the density of that, and a prediction of what it contributes to a surface.
// An Emitter passed to these functions has its lightstyle already multiplied into `radiance` (load_emitter does it).
#ifndef VKPT_LIB_EMITTERS
#define VKPT_LIB_EMITTERS

#include "../shared/functions.h"
#include "../shared/scene.h"
#include "bsdf.glsl"

struct EmitterSample {
    vec3 point;
    vec3 direction; // from the receiver, unit
    float distance;
    vec3 radiance; // towards the receiver. EMITTER_SKY: the average, replace it by the sky's in `direction`
    float pdf;     // per solid angle at the receiver; 0: this emitter does not light the receiver
};

const float emitter_pi = 3.14159265358979f;
// Triangles are sampled by solid angle from here on; below, float rounding would show, and area sampling is as good.
const float least_spherical_angle = 3e-4f;
const float least_contribution = 1e-30f;    // the weight of what is possible but predicted to be nothing
const float greatest_contribution = 1e20f;  // keeps sums of weights finite
const float prediction_roughness = 0.35f;   // no lobe narrower than this guides the choice of lights
const float prediction_horizon = 0.05f;     // sine of the lowest elevation at which the reflectance is looked up

// Emitters with a reach fade to nothing there, smoothly: (1 - (d / reach)^4)^2.
float reach_window(Emitter e, vec3 receiver)
{
    if (e.reach <= 0.0f)
        return 1.0f;
    vec3 to_emitter = e.p0 - receiver;
    float q = dot(to_emitter, to_emitter) / (e.reach * e.reach);
    float window = max(1.0f - q * q, 0.0f);
    return window * window;
}

// What a ray from `receiver` that hits the emitter's front sees (for hits found by BSDF sampling, too).
vec3 emitted_radiance(Emitter e, vec3 receiver)
{
    return e.radiance * reach_window(e, receiver);
}

// A triangle as seen from a point.
struct TriangleAspect {
    vec3 a, b, c;      // receiver to corners
    vec3 edges_cross;  // cross(p1 - p0, p2 - p0)
    float volume;      // six times the tetrahedron's; > 0: the receiver is in front
    float solid_angle; // 0 where volume <= 0
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
    if (t.volume > 0.0f) {
        float la = length(t.a);
        float lb = length(t.b);
        float lc = length(t.c);
        // Van Oosterom and Strackee 1983. The volume from the edges keeps its precision at tiny angles.
        float denominator = la * lb * lc + dot(t.a, t.b) * lc + dot(t.b, t.c) * la + dot(t.c, t.a) * lb;
        t.solid_angle = 2.0f * atan(t.volume, denominator);
    }
    return t;
}

bool uses_spherical_sampling(TriangleAspect t)
{
    return t.solid_angle >= least_spherical_angle;
}

// Arvo 1995: first the sub-triangle (a, b, c') that has the share xi.x of the solid angle, c' on the arc from a to c; then
// uniform height on the arc from b to c'. c' without trigonometric inverses: write it as the mirror image of a at
// r = p a + q c; then tan(angle / 2) = q G0 / (p G2 + q G1) with the G below, which is linear in p and q.
vec3 sample_spherical_triangle(TriangleAspect t, vec2 xi)
{
    float la = length(t.a);
    float lb = length(t.b);
    float lc = length(t.c);
    vec3 a = t.a / la;
    vec3 b = t.b / lb;
    vec3 c = t.c / lc;
    float g0 = t.volume / la / lb / lc;
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
    float sideways_length = sqrt(max(depth * (2.0f - depth), 0.0f) / sideways2);
    return normalize(b * (1.0f - depth) + sideways * sideways_length);
}

EmitterSample sample_triangle_point(Emitter e, vec3 receiver, vec2 xi)
{
    EmitterSample result;
    result.point = e.p0;
    result.direction = vec3(0.0f, 0.0f, 1.0f);
    result.distance = 0.0f;
    result.radiance = vec3(0.0f);
    result.pdf = 0.0f;
    TriangleAspect t = view_triangle(e, receiver);
    if (t.volume <= 0.0f || t.solid_angle <= 0.0f)
        return result;
    if (uses_spherical_sampling(t)) {
        result.direction = sample_spherical_triangle(t, xi);
        float farthest = sqrt(max(max(dot(t.a, t.a), dot(t.b, t.b)), dot(t.c, t.c)));
        // Grazing rays may be rounded past the plane: no point of the triangle is farther than its farthest corner.
        float slope = max(-dot(result.direction, t.edges_cross), t.volume / farthest);
        result.distance = t.volume / slope;
        result.pdf = 1.0f / t.solid_angle;
    } else {
        float root = sqrt(xi.x);
        vec3 offset = t.a * (1.0f - root) + t.b * (root * (1.0f - xi.y)) + t.c * (root * xi.y);
        result.distance = length(offset);
        if (result.distance <= 0.0f)
            return result;
        result.direction = offset / result.distance;
        // Distance^2 / (area * cosine), where area * cosine = volume / (2 * distance).
        result.pdf = 2.0f * result.distance * result.distance * result.distance / t.volume;
    }
    result.point = receiver + result.direction * result.distance;
    result.radiance = emitted_radiance(e, receiver);
    return result;
}

// 1 - cosine of the half angle under which a sphere appears; 2 inside of it: it is all around.
float sphere_cone_depth(vec3 to_centre, float radius)
{
    float distance2 = dot(to_centre, to_centre);
    float sine2 = radius * radius / max(distance2, 1e-20f);
    if (sine2 >= 1.0f)
        return 2.0f;
    return sine2 / (1.0f + sqrt(1.0f - sine2));
}

// A receiver inside the sphere (a wall that a dynamic light grazes) is lit from all around: the irradiance is continuous.
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
    float sine2 = max(depth * (2.0f - depth), 0.0f);
    float phi = 2.0f * emitter_pi * xi.y;
    float sine = sqrt(sine2);
    result.direction = normalize(axis * (1.0f - depth) + (tangent * cos(phi) + bitangent * sin(phi)) * sine);
    float along = sqrt(centre_distance2) * (1.0f - depth);
    float chord = sqrt(max(radius * radius - centre_distance2 * sine2, 0.0f));
    result.distance = inside ? along + chord : along - chord;
    result.point = receiver + result.direction * result.distance;
    result.radiance = emitted_radiance(e, receiver);
    result.pdf = radius > 0.0f ? 1.0f / (2.0f * emitter_pi * cone_depth) : 0.0f;
    return result;
}

EmitterSample sample_emitter_point(Emitter e, vec3 receiver, vec2 xi)
{
    if (e.type == EMITTER_SPHERE)
        return sample_sphere_point(e, receiver, xi);
    return sample_triangle_point(e, receiver, xi);
}

// Density with which sample_emitter_point picks `point` (on the emitter, visible from the receiver), per solid angle.
float pdf_emitter_point(Emitter e, vec3 receiver, vec3 point)
{
    if (e.type == EMITTER_SPHERE) {
        float cone_depth = sphere_cone_depth(e.p0 - receiver, e.p1.x);
        return e.p1.x > 0.0f ? 1.0f / (2.0f * emitter_pi * cone_depth) : 0.0f;
    }
    TriangleAspect t = view_triangle(e, receiver);
    if (t.volume <= 0.0f || t.solid_angle <= 0.0f)
        return 0.0f;
    if (uses_spherical_sampling(t))
        return 1.0f / t.solid_angle;
    vec3 offset = point - receiver;
    float len = length(offset);
    return 2.0f * len * len * len / t.volume;
}

// What the prediction needs to know of an emitter's shape. solid_angle 0: it cannot light the surface.
struct EmitterAspect {
    vec3 centre; // receiver to centre
    float solid_angle;
    float cosine_bound;
};

EmitterAspect view_emitter_triangle(Surface s, Emitter e)
{
    EmitterAspect aspect;
    TriangleAspect t = view_triangle(e, s.position);
    aspect.centre = (t.a + t.b + t.c) * (1.0f / 3.0f);
    aspect.solid_angle = t.solid_angle;
    vec3 heights = vec3(dot(s.normal, t.a), dot(s.normal, t.b), dot(s.normal, t.c));
    float geometric_height = max(
        max(dot(s.geometric_normal, t.a), dot(s.geometric_normal, t.b)), dot(s.geometric_normal, t.c));
    if (max(max(heights.x, heights.y), heights.z) <= 0.0f || geometric_height <= 0.0f)
        aspect.solid_angle = 0.0f;
    // The highest corner may lie lower than the middle of a triangle right above.
    aspect.cosine_bound = max(max(heights.x / max(length(t.a), 1e-10f), heights.y / max(length(t.b), 1e-10f)),
        max(heights.z / max(length(t.c), 1e-10f), dot(s.normal, aspect.centre) / max(length(aspect.centre), 1e-10f)));
    return aspect;
}

EmitterAspect view_emitter_sphere(Surface s, Emitter e)
{
    EmitterAspect aspect;
    float radius = e.p1.x;
    aspect.centre = e.p0 - s.position;
    float cone_depth = sphere_cone_depth(aspect.centre, radius);
    aspect.solid_angle = 2.0f * emitter_pi * cone_depth;
    float height = dot(s.normal, aspect.centre) + radius;
    if (radius <= 0.0f || height <= 0.0f || dot(s.geometric_normal, aspect.centre) + radius <= 0.0f)
        aspect.solid_angle = 0.0f;
    aspect.cosine_bound = height / max(length(aspect.centre), radius);
    return aspect;
}

// Reflectance (luminance) towards a direction that is lifted above the horizon, with the roughness limited from below.
float predict_reflectance(Surface s, vec3 to_light)
{
    float len = length(to_light);
    vec3 direction = len > 1e-10f ? to_light / len : s.normal;
    float height = dot(s.normal, direction);
    if (height < prediction_horizon)
        direction = normalize(direction + s.normal * (prediction_horizon - height));
    s.roughness = max(s.roughness, prediction_roughness);
    BsdfValue value = evaluate_brdf(s, direction);
    return value.diffuse * luminance(s.albedo) + luminance(value.specular);
}

// Section 47.4.5: the weight by which samplers choose. Radiance x reflectance at the horizon-clipped centre x solid angle x
// bounded cosine; visibility is unknown. Never 0 where the emitter can contribute.
float light_contribution(Surface s, Emitter e)
{
    float radiance = luminance(emitted_radiance(e, s.position));
    if (!(radiance > 0.0f))
        return 0.0f;
    EmitterAspect aspect;
    if (e.type == EMITTER_SPHERE)
        aspect = view_emitter_sphere(s, e);
    else
        aspect = view_emitter_triangle(s, e);
    if (!(aspect.solid_angle > 0.0f))
        return 0.0f;
    float reflectance = max(predict_reflectance(s, aspect.centre), 1e-4f);
    float cosine = clamp(aspect.cosine_bound, 1e-4f, 1.0f);
    return clamp(radiance * reflectance * aspect.solid_angle * cosine, least_contribution, greatest_contribution);
}

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// The weights by which samplers choose lights: a prediction of what an emitter, unshadowed, contributes to a surface.
// LIGHT_WEIGHT_CHAPTER: section 47.4.5. LIGHT_WEIGHT_LTC: Heitz et al. 2016, "Real-Time Polygonal-Light Shading with Linearly
// Transformed Cosines", with a table of our own (tools/fit_ltc).
// A weight is never 0 where light can arrive: that would be bias.
#ifndef VKPT_LIB_LIGHT_WEIGHTS
#define VKPT_LIB_LIGHT_WEIGHTS

#include "../shared/cvars.h"
#include "../shared/ltc.h"
#include "bsdf.glsl"
#include "emitters.glsl"
#include "projected_triangle.glsl"
#include "whole_numbers.glsl"

const float least_contribution = 1e-30f;    // the weight of what is possible but predicted to be nothing
const float greatest_contribution = 1e20f;  // keeps sums of weights finite
const float prediction_roughness = 0.35f;   // no lobe narrower than this guides the choice of lights
const float ltc_tail = 0.15f;               // density of a lobe of alpha 1, far from its peak
const float prediction_horizon = 0.05f;     // sine of the lowest elevation at which the reflectance is looked up

// A surface prepared for weighing many lights.
struct LightPredictor {
    Surface s;
    int weight; // LIGHT_WEIGHT_*
    // Chapter's weight only: what predict_reflectance needs of the surface and its viewer.
    float view_height; // cosine
    float view_root;   // smith_root
    float albedo;      // luminance
    float base;        // diffuse reflectance (luminance), but for what the layer takes from the light on its way in
    // LTC only: rows that turn the world into the space where the lobe is a cosine, and what the lobes reflect (luminance).
    vec3 diffuse_rows[3];
    vec3 specular_rows[3];
    float diffuse;
    float specular;
};

struct LtcEntry {
    float xx, xz, yy, zx; // of the inverse matrix
    float albedo;         // of the lobe with a Fresnel factor of 1
    float grazing;        // of it with a Fresnel factor of (1 - cosine)^5
};

LtcEntry load_ltc_entry(LtcBuffer table, uint row, uint column)
{
    uint first = (row * LTC_SIZE + column) * LTC_VALUES;
    LtcEntry e;
    e.xx = table.v[first];
    e.xz = table.v[first + 1u];
    e.yy = table.v[first + 2u];
    e.zx = table.v[first + 3u];
    e.albedo = table.v[first + 4u];
    e.grazing = table.v[first + 5u];
    return e;
}

LtcEntry mix_ltc(LtcEntry a, LtcEntry b, float t)
{
    LtcEntry e;
    e.xx = mix(a.xx, b.xx, t);
    e.xz = mix(a.xz, b.xz, t);
    e.yy = mix(a.yy, b.yy, t);
    e.zx = mix(a.zx, b.zx, t);
    e.albedo = mix(a.albedo, b.albedo, t);
    e.grazing = mix(a.grazing, b.grazing, t);
    return e;
}

LtcEntry find_ltc_entry(LtcBuffer table, float roughness, float cosine)
{
    float last = float(LTC_SIZE - 1u);
    float y = clamp((roughness - LTC_LEAST_ROUGHNESS) / (1.0f - LTC_LEAST_ROUGHNESS), 0.0f, 1.0f) * last;
    float x = sqrt(clamp(1.0f - cosine, 0.0f, 1.0f)) * last;
    uint row = min(floor_to_uint(y), LTC_SIZE - 2u), column = min(floor_to_uint(x), LTC_SIZE - 2u);
    float u = x - float(column), v = y - float(row);
    LtcEntry low = mix_ltc(load_ltc_entry(table, row, column), load_ltc_entry(table, row, column + 1u), u);
    LtcEntry high = mix_ltc(load_ltc_entry(table, row + 1u, column), load_ltc_entry(table, row + 1u, column + 1u), u);
    return mix_ltc(low, high, v);
}

void prepare_ltc(INOUT(LightPredictor) p, LtcBuffer table)
{
    vec3 z = p.s.normal;
    float cosine = dot(z, p.s.view);
    vec3 along = p.s.view - z * cosine;
    float along2 = dot(along, along);
    vec3 x = along2 > 1e-10f ? along * inversesqrt(along2) : any_tangent(z);
    vec3 y = cross(z, x);
    p.diffuse_rows[0] = x;
    p.diffuse_rows[1] = y;
    p.diffuse_rows[2] = z;
    p.diffuse = bsdf_pi * coupled_diffuse(p.s, cosine, cosine) * luminance(p.s.albedo);

    LtcEntry e = find_ltc_entry(table, p.s.roughness, cosine);
    p.specular_rows[0] = x * e.xx + z * e.xz;
    p.specular_rows[1] = y * e.yy;
    p.specular_rows[2] = x * e.zx + z;
    // Schlick: F0 + (1 - F0) (1 - cosine)^5.
    float head_on = luminance(specular_fresnel(p.s, 0.0f)), grazing = luminance(specular_fresnel(p.s, 1.0f));
    p.specular = head_on * (e.albedo - e.grazing) + grazing * e.grazing;
}

void prepare_reflectance(INOUT(LightPredictor) p)
{
    float alpha = ggx_alpha(p.s.roughness);
    p.view_height = dot(p.s.normal, p.s.view);
    p.view_root = smith_root(p.view_height, alpha);
    p.albedo = luminance(p.s.albedo);
    p.base = coupled_diffuse_base(p.s, p.view_height) * p.albedo;
}

LightPredictor make_predictor(Surface s, LightOptions options)
{
    LightPredictor p;
    p.s = s;
    p.s.view = view_above_horizon(s);
    p.weight = options.weight;
    if (p.weight == LIGHT_WEIGHT_LTC) {
        prepare_ltc(p, options.ltc);
    } else {
        p.s.roughness = max(s.roughness, prediction_roughness);
        prepare_reflectance(p);
    }
    return p;
}

// Angle over sine of the angle for a cosine: a rational fit for [0, 1], relative error 6e-7; below 0 by symmetry.
float angle_over_sine(float cosine)
{
    float x = abs(cosine);
    float near_part = (1.570795f + x * (0.9058243f + x * 0.02603313f)) / (1.0f + x * (1.213246f + x * 0.2894057f));
    return cosine >= 0.0f ? near_part : bsdf_pi * inversesqrt(quick_max(1.0f - x * x, 1e-10f)) - near_part;
}

float form_factor_edge(vec3 a, vec3 b)
{
    return (a.x * b.y - a.y * b.x) * angle_over_sine(dot(a, b));
}

// What share of a cosine lobe a triangle takes: its part above the horizon, projected, over pi. Corners in the lobe's space.
float cosine_form_factor(vec3 a, vec3 b, vec3 c)
{
    ClippedTriangle t = clip_to_horizon(a, b, c);
    if (t.count == 0u)
        return 0.0f;
    vec3 centre = (a + b + c) * (1.0f / 3.0f);
    float centre2 = dot(centre, centre);
    vec3 ab = b - a, ac = c - a;
    const float small = 0.004f; // sides shorter than 1/16 of the distance: no more than a point, and edges would cancel out
    if (t.count == 3u && max(dot(ab, ab), dot(ac, ac)) < small * centre2 && min(a.z, min(b.z, c.z)) > 0.0f)
        return 0.5f * abs(dot(centre, cross(ab, ac))) * centre.z / (bsdf_pi * centre2 * centre2);
    vec3 v0 = normalize(t.v0), v1 = normalize(t.v1), v2 = normalize(t.v2), v3 = normalize(t.v3);
    float sum = form_factor_edge(v0, v1) + form_factor_edge(v1, v2) + form_factor_edge(v3, v0);
    if (t.count == 4u)
        sum += form_factor_edge(v2, v3);
    return abs(sum) * (0.5f / bsdf_pi);
}

// Shares of the two lobes that a triangle takes. Corners relative to the surface.
vec2 form_factors(LightPredictor p, vec3 a, vec3 b, vec3 c)
{
    vec2 shares = vec2(0.0f);
    if (p.diffuse > 0.0f)
        shares.x = cosine_form_factor(to_axes(a, p.diffuse_rows[0], p.diffuse_rows[1], p.diffuse_rows[2]),
            to_axes(b, p.diffuse_rows[0], p.diffuse_rows[1], p.diffuse_rows[2]),
            to_axes(c, p.diffuse_rows[0], p.diffuse_rows[1], p.diffuse_rows[2]));
    if (p.specular > 0.0f)
        shares.y = cosine_form_factor(to_axes(a, p.specular_rows[0], p.specular_rows[1], p.specular_rows[2]),
            to_axes(b, p.specular_rows[0], p.specular_rows[1], p.specular_rows[2]),
            to_axes(c, p.specular_rows[0], p.specular_rows[1], p.specular_rows[2]));
    return shares;
}

// A sphere as the square that faces the surface and looks as large.
vec2 sphere_form_factors(LightPredictor p, vec3 to_centre, float radius)
{
    float distance2 = dot(to_centre, to_centre), distance = sqrt(distance2);
    const float half_side_of_disc = 0.886226925f; // sqrt(pi) / 2
    float half_side = half_side_of_disc * radius * distance
        * inversesqrt(max(distance2 - radius * radius, 0.02f * distance2));
    vec3 x = any_tangent(to_centre / distance), y = cross(to_centre / distance, x);
    vec3 across = (x + y) * half_side, other = (x - y) * half_side;
    return form_factors(p, to_centre + across, to_centre + other, to_centre - across)
        + form_factors(p, to_centre + across, to_centre - across, to_centre - other);
}

// An emitter as its weight sees it.
struct LightShape {
    vec3 p0;            // a triangle's first corner, a sphere's centre
    vec3 first, second; // a triangle's edges from there
    float radius, reach; // of a sphere
    bool is_sphere;
    float radiance; // luminance
};

// What the prediction needs to know of an emitter's shape. solid_angle 0: it cannot light the surface.
struct EmitterAspect {
    vec3 direction; // receiver to centre, unit; 0 at the centre
    float solid_angle;
    float cosine_bound;
};

vec3 direction_or_zero(vec3 v)
{
    return v * quick_inversesqrt(quick_max(dot(v, v), 1e-20f));
}

// angle_above_axis (lib/emitters.glsl) to 0.6 %.
float quick_angle_above_axis(float y, float x)
{
    float side = abs(x), longer = quick_max(y, side);
    float inverse = quick_inversesqrt(quick_max(longer, 1e-18f));
    float tangent = quick_min(y, side) * inverse * inverse;
    float t2 = tangent * tangent;
    float angle = tangent * (0.995354f + t2 * (-0.288679f + t2 * 0.079331f));
    return unfold_angle(angle, y, x);
}

bool is_below(vec3 heights, float limit)
{
    return heights.x <= limit && heights.y <= limit && heights.z <= limit;
}

// The corners are an outline's, and may be a little off: only what is well below a horizon, or well behind the emitter, is out.
// Without branches: some lane nearly always has an emitter in view, and every value that is chosen by a branch costs CPU drivers a
// blend and, in this loop, a way through memory.
EmitterAspect view_emitter_triangle(Surface s, LightShape light)
{
    vec3 a = light.p0 - s.position, b = a + light.first, c = a + light.second;
    float side = quick_max3(quick_max(abs(light.first), abs(light.second))), offset = quick_max3(abs(a));
    float slack = 3.0f * OUTLINE_ERROR * side;
    vec3 heights = vec3(dot(s.normal, a), dot(s.normal, b), dot(s.normal, c));
    vec3 geometric_heights = vec3(dot(s.geometric_normal, a), dot(s.geometric_normal, b), dot(s.geometric_normal, c));
    float volume = -dot(a, cross(light.first, light.second));
    bool unseen = is_below(heights, -slack) || is_below(geometric_heights, -slack) || volume <= -6.0f * slack * side * offset;
    vec3 squares = quick_max(vec3(dot(a, a), dot(b, b), dot(c, c)), vec3(1e-20f));
    vec3 inverse = vec3(quick_inversesqrt(squares.x), quick_inversesqrt(squares.y), quick_inversesqrt(squares.z));
    vec3 lengths = squares * inverse;
    float angle = quick_angle_above_axis(quick_max(volume, 1e-20f), solid_angle_denominator(a, b, c, lengths));
    vec3 cosines = heights * inverse;
    EmitterAspect aspect;
    aspect.direction = direction_or_zero(a + b + c);
    aspect.solid_angle = unseen ? 0.0f : 2.0f * angle;
    // The highest corner may lie lower than the middle of a triangle right above.
    aspect.cosine_bound = quick_max(quick_max3(cosines), dot(s.normal, aspect.direction));
    return aspect;
}

EmitterAspect view_emitter_sphere(Surface s, LightShape light)
{
    EmitterAspect aspect;
    float radius = light.radius;
    vec3 centre = light.p0 - s.position;
    aspect.direction = direction_or_zero(centre);
    float height = dot(s.normal, centre) + radius;
    bool unseen = radius <= 0.0f || height <= 0.0f || dot(s.geometric_normal, centre) + radius <= 0.0f;
    aspect.solid_angle = unseen ? 0.0f : 2.0f * emitter_pi * sphere_cone_depth(centre, radius);
    aspect.cosine_bound = height * quick_inversesqrt(quick_max(quick_max(dot(centre, centre), radius * radius), 1e-20f));
    return aspect;
}

// Luminance of evaluate_brdf towards a unit direction, or 0, that is lifted above the horizon.
float predict_reflectance(LightPredictor p, vec3 direction)
{
    Surface s = p.s;
    float height = dot(s.normal, direction);
    if (height < prediction_horizon) {
        direction = direction_or_zero(direction + s.normal * (prediction_horizon - height));
        height = dot(s.normal, direction);
    }
    vec3 h = direction_or_zero(s.view + direction); // not 0: both are above the horizon
    vec3 across = cross(s.normal, h);
    float cosine = dot(s.normal, h);
    float alpha = ggx_alpha(s.roughness);
    float a2 = alpha * alpha;
    float d = cosine * cosine * a2 + dot(across, across);
    float root2 = a2 + (1.0f - a2) * height * height;
    float roots = height * p.view_root + p.view_height * root2 * quick_inversesqrt(root2); // smith_root
    float inverse = quick_inversesqrt(d * d * roots);
    float lobe = a2 * (0.5f / bsdf_pi) * inverse * inverse;
    float schlick = schlick_power(dot(s.view, h));
    float specular = mix(dielectric_fresnel(s, schlick), p.albedo + (1.0f - p.albedo) * schlick, s.metallic);
    return p.base * coupled_diffuse_share(s, height) + specular * lobe;
}

// Reflectance at the horizon-clipped centre, its lobes not too narrow, x solid angle x bounded cosine.
float predict_by_chapter(LightPredictor p, EmitterAspect aspect)
{
    float reflectance = quick_max(predict_reflectance(p, aspect.direction), 1e-4f);
    return reflectance * aspect.solid_angle * quick_clamp(aspect.cosine_bound, 1e-4f, 1.0f);
}

float predict_by_ltc(LightPredictor p, LightShape light, EmitterAspect aspect)
{
    vec3 a = light.p0 - p.s.position;
    vec2 shares = vec2(1.0f); // inside of a sphere: it is all around
    if (!light.is_sphere)
        shares = form_factors(p, a, a + light.first, a + light.second);
    else if (dot(a, a) > light.radius * light.radius)
        shares = sphere_form_factors(p, a, light.radius);
    // Transformed cosines end at a horizon of their own, GGX does not: about what it has far off its peak.
    float alpha = ggx_alpha(p.s.roughness);
    float tail = ltc_tail * alpha * alpha * aspect.solid_angle * quick_clamp(aspect.cosine_bound, 1e-2f, 1.0f);
    return p.diffuse * quick_max(shares.x, 1e-4f * aspect.solid_angle) + p.specular * quick_max(shares.y, tail);
}

// The weight: reflected luminance, visibility unknown. 0 only where the emitter cannot contribute.
float light_contribution(LightPredictor p, LightShape light)
{
    float radiance = light.radiance;
    EmitterAspect aspect = view_emitter_triangle(p.s, light);
    if (light.is_sphere) {
        radiance *= reach_window(light.p0 - p.s.position, light.reach); // no triangle has a reach
        aspect = view_emitter_sphere(p.s, light);
    }
    if (!(aspect.solid_angle > 0.0f && radiance > 0.0f))
        return 0.0f;
    float share = p.weight == LIGHT_WEIGHT_LTC ? predict_by_ltc(p, light, aspect) : predict_by_chapter(p, aspect);
    return quick_clamp(radiance * share, least_contribution, greatest_contribution);
}

float light_contribution(LightPredictor p, Emitter e)
{
    LightShape light;
    light.p0 = e.p0;
    light.first = e.p1 - e.p0;
    light.second = e.p2 - e.p0;
    light.radius = e.p1.x;
    light.reach = e.reach;
    light.is_sphere = e.type == EMITTER_SPHERE;
    light.radiance = luminance(e.radiance);
    return light_contribution(p, light);
}

#endif

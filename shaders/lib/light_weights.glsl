// SPDX-License-Identifier: GPL-2.0-or-later
// The weights by which samplers choose lights: a prediction of what an emitter, unshadowed, contributes to a surface.
// LIGHT_WEIGHT_BRDF_CENTRE: section 47.4.5. LIGHT_WEIGHT_LTC: Heitz et al. 2016, "Real-Time Polygonal-Light Shading
// with Linearly Transformed Cosines", with a table of our own (tools/fit_ltc). A weight is never 0 where light can
// arrive: that would be bias.
#ifndef VKPT_LIB_LIGHT_WEIGHTS
#define VKPT_LIB_LIGHT_WEIGHTS

#include "../shared/cvars.h"
#include "../shared/ltc.h"
#include "bsdf.glsl"
#include "emitters.glsl"
#include "packing.glsl"
#include "projected_triangle.glsl"
#include "device/whole_numbers.glsl"

const float min_contribution = 1e-30f; // the weight of what is possible but predicted to be nothing
const float max_contribution = 1e20f; // keeps sums of weights finite
const float prediction_roughness = 0.35f; // no lobe narrower than this guides the choice of lights
const float ltc_tail = 0.15f; // density of a lobe of alpha 1, far from its peak
const float prediction_horizon = 0.05f; // sine of the lowest elevation at which the reflectance is looked up

// A surface prepared for weighing many lights.
struct LightPredictor {
    Surface s;
    int weight; // LIGHT_WEIGHT_*
    uvec4 hidden; // as LightOptions has it
    // Chapter's weight only: what predict_reflectance needs of the surface and its viewer.
    float view_height; // cosine
    float view_root; // smith_root
    float alpha2; // alpha^2
    vec2 base; // diffuse reflectance (luminance): x - y schlick_power
    vec2 coat; // specular_fresnel (luminance) times alpha^2 / (2 pi): x + y schlick_power
    // LTC only: rows that turn the world into the space where the lobe is a cosine, and what the lobes reflect
    // (luminance).
    vec3 diffuse_rows[3];
    vec3 specular_rows[3];
    float diffuse;
    float specular;
};

struct LtcEntry {
    float xx, xz, yy, zx; // of the inverse matrix
    float albedo; // of the lobe with a Fresnel factor of 1
    float grazing; // of it with a Fresnel factor of (1 - cosine)^5
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
    float y = clamp((roughness - LTC_MIN_ROUGHNESS) / (1.0f - LTC_MIN_ROUGHNESS), 0.0f, 1.0f) * last;
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
    p.alpha2 = alpha * alpha;
    // Both are linear in schlick_power, so that two values give all.
    float base = coupled_diffuse_base(p.s, p.view_height) * luminance(p.s.albedo);
    float upright = coupled_diffuse_share(p.s, 1.0f), level = coupled_diffuse_share(p.s, 0.0f);
    p.base = base * vec2(upright, upright - level);
    float head_on = luminance(specular_fresnel(p.s, 0.0f)), grazing = luminance(specular_fresnel(p.s, 1.0f));
    p.coat = p.alpha2 * (0.5f / bsdf_pi) * vec2(head_on, grazing - head_on);
}

LightPredictor make_predictor(Surface s, LightOptions options)
{
    LightPredictor p;
    p.s = s;
    p.s.view = view_above_horizon(s);
    p.weight = options.weight;
    p.hidden = options.hidden;
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

float form_factor_edge(vec3 a, vec3 b) { return (a.x * b.y - a.y * b.x) * angle_over_sine(dot(a, b)); }

// What share of a cosine lobe a triangle takes: its part above the horizon, projected, over pi. Corners in the lobe's
// space.
float cosine_form_factor(vec3 a, vec3 b, vec3 c)
{
    ClippedTriangle t = clip_to_horizon(a, b, c);
    if (t.count == 0u)
        return 0.0f;
    vec3 centre = (a + b + c) * (1.0f / 3.0f);
    float centre2 = dot(centre, centre);
    vec3 ab = b - a, ac = c - a;
    const float small
        = 0.004f; // sides shorter than 1/16 of the distance: no more than a point, and edges would cancel out
    if (t.count == 3u && max(dot(ab, ab), dot(ac, ac)) < small * centre2 && min(a.z, min(b.z, c.z)) > 0.0f)
        return 0.5f * abs(dot(centre, cross(ab, ac))) * centre.z / (bsdf_pi * centre2 * centre2);
    vec3 v0 = normalize(t.v0), v1 = normalize(t.v1), v2 = normalize(t.v2), v3 = normalize(t.v3);
    float sum = form_factor_edge(v0, v1) + form_factor_edge(v1, v2) + form_factor_edge(v3, v0);
    if (t.count == 4u)
        sum += form_factor_edge(v2, v3);
    return abs(sum) * (0.5f / bsdf_pi);
}

// A fan of one triangle or two: the second one is a, c, d. Corners relative to the surface.
struct Fan {
    vec3 a, b, c, d;
    uint triangles;
};

// What share of a lobe the fan takes; x, y, z: rows that turn the world into the lobe's space.
float form_factor(Fan fan, vec3 x, vec3 y, vec3 z)
{
    vec3 a = to_axes(fan.a, x, y, z), b = to_axes(fan.b, x, y, z), c = to_axes(fan.c, x, y, z);
    float share = 0.0f;
    ROLLED_FOR (uint triangle = 0u; triangle < fan.triangles; triangle++) {
        share += cosine_form_factor(a, b, c);
        b = c;
        c = to_axes(fan.d, x, y, z);
    }
    return share;
}

// Shares of the two lobes. Loops, here and above, because drivers put every call of a function in line.
vec2 form_factors(LightPredictor p, Fan fan)
{
    vec2 shares = vec2(0.0f);
    ROLLED_FOR (uint lobe = 0u; lobe < 2u; lobe++) {
        bool is_first = lobe == 0u;
        if ((is_first ? p.diffuse : p.specular) > 0.0f) {
            float share = form_factor(fan, is_first ? p.diffuse_rows[0] : p.specular_rows[0],
                is_first ? p.diffuse_rows[1] : p.specular_rows[1], is_first ? p.diffuse_rows[2] : p.specular_rows[2]);
            shares = is_first ? vec2(share, 0.0f) : vec2(shares.x, share);
        }
    }
    return shares;
}

// A sphere as the square that faces the surface and looks as large.
Fan square_of_sphere(vec3 to_centre, float radius)
{
    float distance2 = dot(to_centre, to_centre), distance = sqrt(distance2);
    const float half_side_of_disc = 0.886226925f; // sqrt(pi) / 2
    float half_side
        = half_side_of_disc * radius * distance * inversesqrt(max(distance2 - radius * radius, 0.02f * distance2));
    vec3 x = any_tangent(to_centre / distance), y = cross(to_centre / distance, x);
    vec3 across = (x + y) * half_side, other = (x - y) * half_side;
    Fan square;
    square.a = to_centre + across;
    square.b = to_centre + other;
    square.c = to_centre - across;
    square.d = to_centre - other;
    square.triangles = 2u;
    return square;
}

// An emitter as its weight sees it.
struct LightShape {
    vec3 p0; // a triangle's first corner, a sphere's centre
    vec3 first, second; // a triangle's edges from there
    float side; // no less than any component of the two edges
    float radius, reach; // of a sphere
    uint axis, cosines; // of its cone, as in PackedLight; 0: it has none
    bool is_sphere;
    float radiance; // luminance
};

// What the prediction needs to know of an emitter's shape. solid_angle 0: it cannot light the surface.
struct EmitterAspect {
    // A vector from the surface towards the emitter's centre, of any length: what it is along the normal and along the
    // view, and its square.
    float height;
    float along_view;
    float length2;
    float length_bound; // no less than its length
    float solid_angle;
    float highest_cosine; // of the emitter's points, but for its centre
};

EmitterAspect aspect_of_centre(Surface s, vec3 to_centre)
{
    EmitterAspect aspect;
    aspect.height = dot(s.normal, to_centre);
    aspect.along_view = dot(s.view, to_centre);
    aspect.length2 = dot(to_centre, to_centre);
    return aspect;
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

bool is_below(vec3 heights, float limit) { return heights.x <= limit && heights.y <= limit && heights.z <= limit; }

// The corners are an outline's, and may be a little off: only what is well below a horizon, or well behind the emitter,
// is out. Without branches: some lane nearly always has an emitter in view, and every value that is chosen by a branch
// costs CPU drivers a blend and, in this loop, a way through memory.
EmitterAspect view_emitter_triangle(Surface s, LightShape light)
{
    vec3 a = light.p0 - s.position, b = a + light.first, c = a + light.second;
    vec3 heights = vec3(dot(s.normal, a), dot(s.normal, b), dot(s.normal, c));
    vec3 geometric_heights = vec3(dot(s.geometric_normal, a), dot(s.geometric_normal, b), dot(s.geometric_normal, c));
    vec3 squares = quick_max(vec3(dot(a, a), dot(b, b), dot(c, c)), vec3(1e-20f));
    vec3 inverse = vec3(quick_inversesqrt(squares.x), quick_inversesqrt(squares.y), quick_inversesqrt(squares.z));
    vec3 lengths = squares * inverse;
    float volume = -dot(a, cross(light.first, light.second));
    float slack = 3.0f * PACKED_LIGHT_ERROR * light.side;
    bool unseen = is_below(heights, -slack) || is_below(geometric_heights, -slack)
        || volume <= -6.0f * slack * light.side * lengths.x;
    float angle = quick_angle_above_axis(quick_max(volume, 1e-20f), solid_angle_denominator(a, b, c, lengths));
    EmitterAspect aspect = aspect_of_centre(s, a + b + c);
    aspect.length_bound = lengths.x + lengths.y + lengths.z;
    aspect.solid_angle = unseen ? 0.0f : 2.0f * angle;
    aspect.highest_cosine = quick_max3(heights * inverse);
    return aspect;
}

EmitterAspect view_emitter_sphere(Surface s, LightShape light)
{
    float radius = light.radius;
    vec3 centre = light.p0 - s.position;
    EmitterAspect aspect = aspect_of_centre(s, centre);
    float square = quick_max(aspect.length2, 1e-20f);
    aspect.length_bound = square * quick_inversesqrt(square);
    bool unseen = radius <= 0.0f || aspect.height + radius <= 0.0f || dot(s.geometric_normal, centre) + radius <= 0.0f;
    aspect.solid_angle = unseen ? 0.0f : 2.0f * emitter_pi * sphere_cone_depth(centre, radius);
    aspect.highest_cosine = (aspect.height + radius) * quick_inversesqrt(quick_max(square, radius * radius));
    return aspect;
}

// The highest corner may lie lower than the middle of a triangle right above. `inverse`: of the length of what points
// to the centre.
float cosine_bound(EmitterAspect aspect, float inverse)
{
    return quick_max(aspect.highest_cosine, aspect.height * inverse);
}

// Luminance of evaluate_brdf. The unit direction to the light is told by its cosines to the normal (> 0) and to the
// view, and by what its squared length is in truth: the half vector's length, and its cosines, follow from those
// without the vector itself.
float predict_reflectance(LightPredictor p, float height, float view_cosine, float length2)
{
    float sum2 = 1.0f + length2 + 2.0f * view_cosine; // |view + direction|^2, not 0: both are above the horizon
    float sum_height = p.view_height + height;
    float sum_height2 = sum_height * sum_height;
    float d = p.alpha2 * sum_height2 + quick_max(sum2 - sum_height2, 0.0f); // GGX's, times sum2
    float root2 = p.alpha2 + (1.0f - p.alpha2) * height * height;
    float roots = height * p.view_root + p.view_height * root2 * quick_inversesqrt(root2); // smith_root
    float inverse = sum2 * quick_inversesqrt(d * d * roots);
    float schlick = schlick_power(
        0.5f * sum2 * quick_inversesqrt(sum2)); // half the sum's length is the cosine to the half vector
    return p.base.x - p.base.y * schlick_power(height) + (p.coat.x + p.coat.y * schlick) * inverse * inverse;
}

// Reflectance at the horizon-clipped centre, its lobes not too narrow, x solid angle x bounded cosine.
float predict_by_chapter(LightPredictor p, EmitterAspect aspect)
{
    float lift = quick_max(prediction_horizon * aspect.length_bound - aspect.height, 0.0f);
    float lifted = aspect.height + lift;
    float length2 = quick_max(aspect.length2 + lift * (aspect.height + lifted), 1e-20f);
    float inverse = quick_inversesqrt(length2);
    float reflectance = predict_reflectance(
        p, lifted * inverse, (aspect.along_view + lift * p.view_height) * inverse, length2 * inverse * inverse);
    return quick_max(reflectance, 1e-4f) * aspect.solid_angle * quick_clamp(cosine_bound(aspect, inverse), 1e-4f, 1.0f);
}

float predict_by_ltc(LightPredictor p, LightShape light, EmitterAspect aspect)
{
    if (!(aspect.solid_angle > 0.0f))
        return 0.0f;
    Fan fan;
    fan.a = light.p0 - p.s.position;
    fan.b = fan.a + light.first;
    fan.c = fan.a + light.second;
    fan.d = fan.c;
    fan.triangles = 1u;
    bool is_inside = light.is_sphere && !(dot(fan.a, fan.a) > light.radius * light.radius);
    if (light.is_sphere)
        fan = square_of_sphere(fan.a, light.radius);
    vec2 shares = is_inside ? vec2(1.0f) : form_factors(p, fan); // inside of a sphere: it is all around
    // Transformed cosines end at a horizon of their own, GGX does not: about what it has far off its peak.
    float alpha = ggx_alpha(p.s.roughness);
    float cosine = cosine_bound(aspect, quick_inversesqrt(quick_max(aspect.length2, 1e-20f)));
    float tail = ltc_tail * alpha * alpha * aspect.solid_angle * quick_clamp(cosine, 1e-2f, 1.0f);
    return p.diffuse * quick_max(shares.x, 1e-4f * aspect.solid_angle) + p.specular * quick_max(shares.y, tail);
}

// cone_window of a sphere's shape.
float shape_window(LightShape light, vec3 to_centre)
{
    if (light.cosines == 0u)
        return 1.0f;
    vec2 cosines = unpack_snorm2(light.cosines);
    return cone_window(to_centre, unpack_direction(light.axis), cosines.x, 1.0f / (cosines.x - cosines.y));
}

// The weight: reflected luminance, visibility unknown. 0 only where the emitter cannot contribute.
float light_contribution(LightPredictor p, LightShape light)
{
    float radiance = light.radiance;
    EmitterAspect aspect = view_emitter_triangle(p.s, light);
    if (light.is_sphere) {
        vec3 to_centre = light.p0 - p.s.position;
        radiance *= reach_window(to_centre, light.reach)
            * shape_window(light, to_centre); // no triangle has a reach, or a cone
        aspect = view_emitter_sphere(p.s, light);
    }
    float share = p.weight == LIGHT_WEIGHT_LTC ? predict_by_ltc(p, light, aspect) : predict_by_chapter(p, aspect);
    bool arrives = aspect.solid_angle > 0.0f && radiance > 0.0f;
    return arrives ? quick_clamp(radiance * share, min_contribution, max_contribution) : 0.0f;
}

float light_contribution(LightPredictor p, Emitter e)
{
    LightShape light;
    light.p0 = e.p0;
    light.first = e.p1 - e.p0;
    light.second = e.p2 - e.p0;
    light.side = quick_max3(quick_max(abs(light.first), abs(light.second)));
    light.radius = e.p1.x;
    light.reach = e.reach;
    light.is_sphere = is_sphere(e);
    light.axis = 0u;
    light.cosines = 0u;
    if (e.type == EMITTER_SPHERE && e.p1.y > 0.0f) {
        light.axis = pack_direction(e.p2);
        light.cosines = pack_snorm2(vec2(e.p1.z, max(e.p1.z - 1.0f / e.p1.y - CONE_SLACK, -1.0f)));
    }
    light.radiance = luminance(e.radiance);
    return light_contribution(p, light);
}

#endif

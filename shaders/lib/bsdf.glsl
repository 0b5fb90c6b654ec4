// SPDX-License-Identifier: GPL-2.0-or-later
// The one surface model: a diffuse base under a GGX coat, or a GGX metal, mixed by `metallic`.
// Sources: Walter et al. 2007 (GGX), Heitz 2014 (height-correlated Smith), Dupuy and Benyoub 2023 (visible normals by
// spherical caps), Kelemen and Szirmay-Kalos 2001 (a base that reflects what the coat lets through). Directions are
// unit vectors that point away from the surface.
#ifndef VKPT_LIB_BSDF
#define VKPT_LIB_BSDF

#include "../shared/functions.h"
#include "device/quick_floats.glsl"

struct Surface {
    vec3 position;
    vec3 normal; // shading normal, on the viewer's side
    vec3 geometric_normal; // of the triangle, on the viewer's side: nothing comes from below it
    vec3 view; // towards where the ray came from
    vec3 albedo;
    float roughness; // GGX alpha = roughness^2; 1 and not metallic: matte, exactly Lambert
    float metallic;
    float coat_loss; // share of the coat's reflectance that is missing: 0 none, 1 no coat
};

// Reflected radiance = (albedo * diffuse + specular) * incoming radiance. The diffuse part is kept free of the albedo
// so that denoisers see no texture in it.
struct BsdfValue {
    float diffuse;
    vec3 specular;
};

struct BsdfSample {
    vec3 direction;
    float pdf; // per solid angle, of both lobes together; 0: nothing is reflected this way
    BsdfValue value; // of evaluate_bsdf for `direction`
    uint lobe; // BSDF_LOBE_*
};

const uint BSDF_LOBE_DIFFUSE = 0u;
const uint BSDF_LOBE_SPECULAR = 1u;

const float bsdf_pi = 3.14159265358979f;
const float bsdf_min_alpha = 1e-3f; // smoother than this is for the mirror chain
const float bsdf_dielectric_f0 = 0.04f; // index of refraction 1.5

float luminance(vec3 colour) { return dot(colour, vec3(0.2126f, 0.7152f, 0.0722f)); }

float ggx_alpha(float roughness) { return quick_max(roughness * roughness, bsdf_min_alpha); }

// Interpolated and mapped normals may face away from the viewer: the view is then lifted just above their horizon.
vec3 view_above_horizon(Surface s)
{
    float height = dot(s.normal, s.view);
    const float least = 1e-3f;
    return height >= least ? s.view : normalize(s.view + s.normal * (least - height));
}

vec3 any_tangent(vec3 normal)
{
    vec3 other = abs(normal.z) < 0.7f ? vec3(0.0f, 0.0f, 1.0f) : vec3(1.0f, 0.0f, 0.0f);
    return normalize(cross(other, normal));
}

// `sine2` = squared sine between normal and half vector: it keeps the precision that 1 - cosine^2 loses on smooth
// surfaces.
float ggx_distribution(float cosine, float sine2, float alpha)
{
    float a2 = alpha * alpha;
    float d = cosine * cosine * a2 + sine2;
    return a2 / (bsdf_pi * d * d);
}

float smith_root(float cosine, float alpha)
{
    float a2 = alpha * alpha;
    return sqrt(a2 + (1.0f - a2) * cosine * cosine);
}

float schlick_power(float cosine)
{
    float m = quick_clamp(1.0f - cosine, 0.0f, 1.0f);
    float m2 = m * m;
    return m2 * m2 * m;
}

// The coat over the diffuse base fades out towards roughness 1: matte surfaces have none. The material's share of it
// scales the whole reflectance, as specularFactor of glTF's KHR_materials_specular does.
float coat_strength(Surface s) { return (1.0f - s.coat_loss) * quick_clamp(5.0f * (1.0f - s.roughness), 0.0f, 1.0f); }

// Schlick's approximation; `power` = schlick_power of the cosine.
float dielectric_fresnel(Surface s, float power)
{
    return coat_strength(s) * (bsdf_dielectric_f0 + (1.0f - bsdf_dielectric_f0) * power);
}

vec3 specular_fresnel(Surface s, float power)
{
    vec3 metal = s.albedo + (vec3(1.0f) - s.albedo) * power;
    return mix(vec3(dielectric_fresnel(s, power)), metal, s.metallic);
}

// The coat reflects less towards grazing angles than Fresnel's formula has it, the rougher it is.
float coat_rise(Surface s) { return 1.0f - 0.9f * s.roughness * s.roughness; }

// The two factors of coupled_diffuse: what depends on the light's height, and all else.
float coupled_diffuse_share(Surface s, float nl)
{
    return 1.0f - dielectric_fresnel(s, coat_rise(s) * schlick_power(nl));
}

float coupled_diffuse_base(Surface s, float nv)
{
    float mean = dielectric_fresnel(s, coat_rise(s) / 21.0f);
    return (1.0f - s.metallic) * coupled_diffuse_share(s, nv) / ((1.0f - mean) * bsdf_pi);
}

// What passes the coat inwards, reflects, and passes it outwards, so that base and coat together never reflect more
// than they receive: (1 - F(l)) (1 - F(v)) / (1 - mean F), 1 / pi without a coat. F is the share that the coat
// reflects in all; towards grazing angles that rises less the rougher it is (the factor is fitted to the furnace).
float coupled_diffuse(Surface s, float nl, float nv)
{
    return coupled_diffuse_base(s, nv) * coupled_diffuse_share(s, nl);
}

vec3 half_vector(vec3 view, vec3 light, vec3 normal)
{
    vec3 sum = view + light;
    float len2 = dot(sum, sum);
    return len2 > 1e-12f ? sum * inversesqrt(len2) : normal;
}

// The reflectance itself, without the cosine and without asking whether `light` is above the horizon.
BsdfValue evaluate_brdf(Surface s, vec3 light)
{
    vec3 view = view_above_horizon(s);
    vec3 h = half_vector(view, light, s.normal);
    vec3 across = cross(s.normal, h);
    float alpha = ggx_alpha(s.roughness);
    float nv = dot(s.normal, view);
    float nl = quick_max(dot(s.normal, light), 1e-6f);
    float schlick = schlick_power(dot(view, h));
    float visibility = 0.5f / (nl * smith_root(nv, alpha) + nv * smith_root(nl, alpha));
    float lobe = ggx_distribution(dot(s.normal, h), dot(across, across), alpha) * visibility;

    BsdfValue value;
    value.diffuse = coupled_diffuse(s, nl, nv);
    value.specular = specular_fresnel(s, schlick) * lobe;
    return value;
}

// Reflectance times cosine.
BsdfValue evaluate_bsdf(Surface s, vec3 light)
{
    BsdfValue value;
    value.diffuse = 0.0f;
    value.specular = vec3(0.0f);
    float nl = dot(s.normal, light);
    if (nl <= 0.0f || dot(s.geometric_normal, light) <= 0.0f)
        return value;
    value = evaluate_brdf(s, light);
    value.diffuse *= nl;
    value.specular *= nl;
    return value;
}

vec3 reflected_radiance(Surface s, BsdfValue value, vec3 incoming)
{
    return (s.albedo * value.diffuse + value.specular) * incoming;
}

// How often sample_bsdf takes the specular lobe: by what each lobe reflects towards this viewer.
float specular_lobe_probability(Surface s)
{
    if (s.metallic >= 1.0f)
        return 1.0f;
    if (s.metallic <= 0.0f && coat_strength(s) <= 0.0f)
        return 0.0f;
    float power = schlick_power(dot(s.normal, view_above_horizon(s)));
    float specular = luminance(specular_fresnel(s, power));
    float diffuse = (1.0f - s.metallic) * (1.0f - dielectric_fresnel(s, power)) * luminance(s.albedo);
    return quick_clamp(specular / quick_max(specular + diffuse, 1e-6f), 0.1f, 0.9f);
}

// Density of sample_bsdf per solid angle; over the whole sphere it integrates to 1 (the specular lobe of a rough
// surface reaches below the horizon, where nothing is reflected).
float pdf_bsdf(Surface s, vec3 light)
{
    vec3 view = view_above_horizon(s);
    vec3 h = half_vector(view, light, s.normal);
    float nh = dot(s.normal, h);
    float alpha = ggx_alpha(s.roughness);
    float nv = dot(s.normal, view);
    vec3 across = cross(s.normal, h);
    float specular = 0.0f;
    if (nh > 0.0f) // visible normals: G1 D / (4 nv)
        specular = ggx_distribution(nh, dot(across, across), alpha) * 0.5f / (nv + smith_root(nv, alpha));
    float diffuse = quick_max(dot(s.normal, light), 0.0f) / bsdf_pi;
    return mix(diffuse, specular, specular_lobe_probability(s));
}

vec3 sample_cosine_direction(vec3 normal, vec2 xi)
{
    vec3 tangent = any_tangent(normal);
    vec3 bitangent = cross(normal, tangent);
    float radius = sqrt(xi.x);
    float phi = 2.0f * bsdf_pi * xi.y;
    float height = sqrt(quick_max(1.0f - xi.x, 0.0f));
    return normalize(tangent * (radius * cos(phi)) + bitangent * (radius * sin(phi)) + normal * height);
}

// A microfacet normal with density G1 D max(0, v.h) / nv.
vec3 sample_visible_normal(vec3 normal, vec3 view, float alpha, vec2 xi)
{
    vec3 tangent = any_tangent(normal);
    vec3 bitangent = cross(normal, tangent);
    vec3 stretched = normalize(vec3(alpha * dot(view, tangent), alpha * dot(view, bitangent), dot(view, normal)));
    float phi = 2.0f * bsdf_pi * xi.x;
    float z = (1.0f - xi.y) * (1.0f + stretched.z) - stretched.z;
    float sine = sqrt(quick_clamp(1.0f - z * z, 0.0f, 1.0f));
    vec3 m = vec3(sine * cos(phi), sine * sin(phi), z) + stretched;
    return normalize(tangent * (alpha * m.x) + bitangent * (alpha * m.y) + normal * quick_max(m.z, 1e-7f));
}

// Which lobe was drawn: BSDF_LOBE_*.
vec3 sample_bsdf_direction(Surface s, vec2 xi, float xi_lobe, INOUT(uint) lobe)
{
    lobe = xi_lobe < specular_lobe_probability(s) ? BSDF_LOBE_SPECULAR : BSDF_LOBE_DIFFUSE;
    if (lobe == BSDF_LOBE_DIFFUSE)
        return sample_cosine_direction(s.normal, xi);
    vec3 view = view_above_horizon(s);
    vec3 h = sample_visible_normal(s.normal, view, ggx_alpha(s.roughness), xi);
    return normalize(h * (2.0f * dot(view, h)) - view);
}

BsdfSample sample_bsdf(Surface s, vec2 xi, float xi_lobe)
{
    BsdfSample result;
    result.direction = sample_bsdf_direction(s, xi, xi_lobe, result.lobe);
    result.pdf = pdf_bsdf(s, result.direction);
    result.value = evaluate_bsdf(s, result.direction);
    return result;
}

#endif

#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Camera rays through mirrors, glass and water, and on from a security camera where they meet a screen, to the first
// surface that is shaded, written to the G-buffer.
#define VKPT_NORMAL_MAPS
#include "lib/frame.glsl"
#include "lib/camera_rays.glsl"
#include "lib/exposure.glsl"
#include "lib/fog.glsl"
#include "lib/light_cache.glsl"
#include "lib/media.glsl"
#include "lib/pixel_random.glsl"
#include "lib/reprojection.glsl"

const uint max_specular_segments = 12u;
// Sprites, beams and particles on the way do not count: of those at an opacity of 0.05, the 84th is hardly seen.
const uint max_unlit_segments = 128u;
// What is behind particles that let less than this through is not looked for.
const float min_throughput = 0.015;
const uint mask_reflected = MASK_OPAQUE | MASK_TRANSLUCENT | MASK_ALPHA_TEST | MASK_OWN_BODY | MASK_SKY;
// Panes no rougher than this mirror.
const float pane_roughness = 0.2;

// Unpolarised Fresnel reflectance of a smooth dielectric; `ratio` = index behind / index before. 1: total reflection.
float fresnel_dielectric(float cosine, float ratio)
{
    float g2 = ratio * ratio - 1.0 + cosine * cosine;
    if (g2 <= 0.0)
        return 1.0;
    float g = sqrt(g2), a = (g - cosine) / (g + cosine),
          b = (cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

vec2 wave_slope(vec4 wave, vec2 direction, vec2 place)
{
    return wave.w * cos(dot(place, wave.xy) + wave.z * frame.time) * direction;
}

// A few crossing waves; the gradient of their height turns the surface normal.
vec3 water_normal(vec3 position, vec3 normal)
{
    // The axes of the surface are the same seen from either side.
    bool lies_flat = abs(normal.z) >= 0.7;
    float side = lies_flat ? normal.z : (abs(normal.x) > abs(normal.y) ? normal.x : normal.y);
    vec3 outward = side < 0.0 ? -normal : normal;
    vec3 across = lies_flat ? vec3(1.0, 0.0, 0.0) : normalize(vec3(-outward.y, outward.x, 0.0));
    vec3 along = lies_flat ? vec3(0.0, 1.0, 0.0) : cross(outward, across);
    vec2 place = vec2(dot(position, across), dot(position, along));
    vec2 slope = wave_slope(WATER_WAVE_A, WATER_SLOPE_A, place) + wave_slope(WATER_WAVE_B, WATER_SLOPE_B, place)
        + wave_slope(WATER_WAVE_C, WATER_SLOPE_C, place);
    return normalize(normal - (across * slope.x + along * slope.y) * sign(side));
}

// Whether to follow the layer that is `share` of the whole rather than the one behind it; `weight`: what it then counts
// for.
bool choose_layer(inout Layers layers, float share, inout Random random, out float weight)
{
    weight = 1.0;
    if (layers.count == 1u || share <= 0.0 || share >= 1.0)
        return next_float(random) < share;
    uint nearer = layers.count == 3u && share >= 0.5 ? 2u : 1u, farther = layers.count - nearer;
    bool chosen = layers.own < layers.first + nearer;
    weight = float(layers.count) * (chosen ? share / float(nearer) : (1.0 - share) / float(farther));
    layers.first += chosen ? 0u : nearer;
    layers.count = chosen ? nearer : farther;
    return chosen;
}

struct Path {
    Ray ray;
    vec3 throughput;
    vec3 emitted;
    float path_length; // from the eye, or as far as it had to be for the pixel to cover as much
    float stretch; // how much that grows over a unit
    uint mask;
    uint medium; // MEDIUM_*
    float unlit_depth; // DEPTH_*: what the path ended on without a surface
    bool reached_surface;
    uint unlit_segments; // that ended on what is unlit
    HitSurface hit;
    vec3 mirror; // normal of the last mirror, 0: none
    vec3 moved; // from where the surface's point was in the last view
    float screen_depth; // along the camera's axis, of the screen that the path has met; 0: none
    Layers layers;
};

// A place of the image: what the camera's ray through it is called.
struct Sight {
    vec3 direction; // unit, as it leaves the eye
    uint index; // of the pixel in the screen buffers
    vec2 offset; // of the ray from the pixel's corner
    float cone_spread; // how much wider the pixel gets over a unit
};

void reflect_path(inout Path path, Surface s, vec3 normal)
{
    path.ray.direction = reflect(path.ray.direction, normal);
    if (dot(path.ray.direction, s.geometric_normal) < 1e-3)
        path.ray.direction = normalize(path.ray.direction + s.geometric_normal * 0.02);
    path.ray.origin = offset_ray_origin(s.position, s.geometric_normal);
    path.mask = mask_reflected;
    path.mirror = normal;
}

void pass_through(inout Path path, Surface s, vec3 direction)
{
    path.ray.direction = direction;
    path.ray.origin = offset_ray_origin(s.position, -s.geometric_normal);
}

// The surface of water or slime. False: the path has ended on it, as slime is murky: its image covers what is behind.
bool meet_liquid(inout Path path, HitSurface hit, inout Random random)
{
    Surface s = hit.surface;
    bool front = hit.front > 0.0;
    vec3 normal = water_normal(s.position, s.normal);
    float ratio = medium_before(hit.medium, front) != MEDIUM_NONE ? 1.0 / WATER_INDEX : WATER_INDEX;
    float reflectance = fresnel_dielectric(clamp(dot(normal, s.view), 0.0, 1.0), ratio), weight;
    bool reflected = choose_layer(path.layers, reflectance, random, weight);
    path.throughput *= weight;
    vec3 refracted = refract(path.ray.direction, normal, 1.0 / ratio);
    if (reflected || refracted == vec3(0.0)) {
        reflect_path(path, s, normal);
        return true;
    }
    if ((hit.medium & MEDIUM_MASK) == MEDIUM_SLIME && front) {
        bool covered = choose_layer(path.layers, hit.opacity, random, weight);
        path.throughput *= weight;
        if (covered)
            return false;
        path.throughput *= pane_transmittance(s.albedo, hit.opacity);
    }
    path.medium = medium_behind(hit.medium, front);
    pass_through(path, s, refracted);
    return true;
}

// The front of a translucent surface. True: the path goes on from it.
bool meet_pane(inout Path path, HitSurface hit, inout Random random)
{
    Surface s = hit.surface;
    bool is_glass = (hit.flags & MATERIAL_GLASS) != 0u;
    float weight;
    if (is_glass && s.roughness <= pane_roughness) {
        // Both sides reflect, back and forth: r + (1 - r)^2 (r + r^3 + ...).
        float once = fresnel_dielectric(clamp(dot(s.normal, s.view), 0.0, 1.0), GLASS_INDEX);
        bool reflected = choose_layer(path.layers, 2.0 * once / (1.0 + once), random, weight);
        path.throughput *= weight;
        if (reflected) {
            reflect_path(path, s, s.normal);
            return true;
        }
    }
    bool shown = choose_layer(path.layers, hit.opacity, random, weight);
    path.throughput *= weight;
    if (shown)
        return false;
    if (is_glass)
        path.throughput *= pane_transmittance(s.albedo, hit.opacity);
    pass_through(path, s, path.ray.direction);
    return true;
}

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer PreviousPositionBuffer { vec3 v[]; };

// How far a point of a triangle has come since the last view.
vec3 movement(RawHit raw, vec3 position)
{
    if (raw.triangle < frame.scene.first_moving)
        return vec3(0.0);
    PreviousPositionBuffer corners = PreviousPositionBuffer(frame.scene.previous_positions);
    uint first = (raw.triangle - frame.scene.first_moving) * 3u;
    vec2 b = raw.barycentrics;
    return position
        - (corners.v[first] * (1.0 - b.x - b.y) + corners.v[first + 1u] * b.x + corners.v[first + 2u] * b.y);
}

// Of what is unlit. The eye has adapted to the view (the last frame's exposure): particles are neither invisible in the
// sun nor blinding in the dark, but look as they do where exposure_of_unlit is right.
float unlit_scale(uint flags)
{
    const float exposure_of_unlit = 0.72, max_scale = 50.0;
    ExposureBuffer exposure = ExposureBuffer(frame.exposure);
    bool adapts = (flags & MATERIAL_PARTICLE) != 0u && exposure.v.valid != 0u;
    return adapts ? clamp(exposure_of_unlit / exposure.v.exposure, 1.0 / max_scale, max_scale) : 1.0;
}

// The direction as it looks in the mirror.
vec3 mirrored(Path path, vec3 direction) { return direction - path.mirror * (2.0 * dot(path.mirror, direction)); }

// Where `seen`, from the eye, was in the last view; the mirror shows that it has `moved` since.
void store_place(Sight sight, Path path, vec3 seen, vec3 moved)
{
    ScreenPoint before
        = project(frame.previous_camera, frame.camera.eye + seen - mirrored(path, moved), frame.previous_size);
    store_reprojected(sight.index, pack_place(place_in_last_view(before, sight.offset), before.depth));
}

// How depth changes over the image, of the plane there.
void store_slope(Sight sight, Path path, vec3 seen, vec3 normal)
{
    vec3 plane = mirrored(path, normal);
    vec2 slope = vec2(dot(plane, frame.camera.right), -dot(plane, frame.camera.up)) * 2.0 / vec2(frame.size)
        * dot(seen, frame.camera.forward) / dot(plane, seen);
    store_depth_gradient(sight.index, pack_upper_halves(clamp(slope, -8.0, 8.0)));
}

// Units of the surface for one of its texture's coordinates.
float texture_scale(Triangle t)
{
    vec2 u = t.uvs[1] - t.uvs[0], v = t.uvs[2] - t.uvs[0];
    float covered = length(cross(t.positions[1] - t.positions[0], t.positions[2] - t.positions[0]));
    return sqrt(covered / quick_max(abs(u.x * v.y - u.y * v.x), 1e-12));
}

// The front of a screen. False: its rim, which is a surface as any other. True: the path goes on from the camera. To
// the filters the picture lies where the screen is, and moves with it.
bool meet_screen(inout Path path, Sight sight, RawHit raw, HitSurface hit)
{
    Screen screen = frame.scene.screens[hit.flags >> MATERIAL_SCREEN_SHIFT];
    Triangle triangle = fetch_Triangle(frame.scene.triangles, raw.triangle);
    vec2 place = (fract(interpolate_uv(triangle, raw.barycentrics)) - screen.area_mins) / screen.area_size;
    if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(1.0))))
        return false;
    vec3 seen = sight.direction * path.path_length;
    path.screen_depth = dot(seen, frame.camera.forward);
    if ((frame.flags & FRAME_REPROJECTED) != 0u) {
        store_place(sight, path, seen, movement(raw, hit.surface.position));
        store_slope(sight, path, seen, hit.surface.geometric_normal);
    }
    vec3 way = screen.corner + screen.across * place.x + screen.down * place.y;
    path.ray = Ray(screen.eye, normalize(way), 0.0, ray_far);
    path.mask = mask_reflected;
    path.medium = screen.medium;
    path.mirror = vec3(0.0);
    float picture_width = texture_scale(triangle) * screen.area_size.x;
    path.stretch = path.path_length * length(screen.across) / (picture_width * length(way));
    path.path_length = 0.0;
    return true;
}

layout(constant_id = SCREENS_CONSTANT) const int fixed_screens = NOT_FIXED;

// Follows the path over one segment. False: it has ended.
bool follow_path(inout Path path, Sight sight, inout Random random)
{
    RawHit raw = trace_nearest(path.ray, path.mask);
    path.throughput *= medium_transmittance(path.medium, raw.t);
    if ((frame.flags & FRAME_FOG) != 0u && path.medium == MEDIUM_NONE) {
        FogOnRay fog = look_through_fog(path.ray, raw.t);
        path.emitted += path.throughput * fog.radiance;
        path.throughput *= fog.transmittance;
    }
    if (raw.triangle == TRACE_MISS) {
        path.emitted += path.throughput * sky_radiance(path.ray.direction);
        return false;
    }
    path.path_length += fixed_screens != 0 ? raw.t * path.stretch : raw.t;
    HitSurface hit = fetch_surface(raw, path.ray, path.path_length * sight.cone_spread, TEXTURE_SMOOTH);
    Surface s = hit.surface;
    if ((hit.flags & MATERIAL_SKY) != 0u) {
        path.emitted += path.throughput * sky_radiance(path.ray.direction);
        return false;
    }
    bool is_unlit = (hit.flags & MATERIAL_FULLBRIGHT) != 0u;
    if ((hit.flags & MATERIAL_TRANSLUCENT) != 0u) {
        bool is_liquid = (hit.flags & MATERIAL_WARP) != 0u;
        if (is_liquid || !is_unlit) {
            path.emitted += path.throughput * hit.emission * hit.opacity; // needs no choice
            hit.emission = vec3(0.0);
            if (is_liquid) {
                if (meet_liquid(path, hit, random))
                    return true;
            } else if (hit.front == 0.0) { // only fronts are shown
                pass_through(path, s, path.ray.direction);
                return true;
            } else if (meet_pane(path, hit, random)) {
                return true;
            }
        }
    }
    if (is_unlit) {
        path.emitted += path.throughput * s.albedo * (hit.opacity * unlit_scale(hit.flags));
        path.throughput *= 1.0 - hit.opacity;
        path.unlit_segments++;
        if (quick_max3(path.throughput) > min_throughput && path.unlit_segments < max_unlit_segments) {
            pass_through(path, s, path.ray.direction);
            return true;
        }
        path.unlit_depth = DEPTH_UNLIT;
        return false;
    }
    if (fixed_screens != 0 && (hit.flags & MATERIAL_SCREEN) != 0u && hit.front > 0.0 && path.screen_depth == 0.0
        && meet_screen(path, sight, raw, hit))
        return true;
    path.emitted += path.throughput * hit.emission;
    if (is_mirror(s)) {
        path.throughput *= s.albedo + (1.0 - s.albedo) * schlick_power(dot(s.normal, s.view));
        reflect_path(path, s, s.normal);
        return true;
    }
    path.hit = hit;
    path.moved = movement(raw, s.position);
    path.reached_surface = true;
    return false;
}

// What the mirror shows stands behind it, as far along the camera's ray as the path is long. Of what a screen shows,
// meet_screen has stored the place.
void store_reprojection(Sight sight, Path path)
{
    const float sky_distance = 1e5;
    float distance = path.reached_surface || path.unlit_depth == DEPTH_UNLIT ? path.path_length : sky_distance;
    vec3 seen = sight.direction * distance;
    bool is_on_screen = fixed_screens != 0 && path.screen_depth != 0.0;
    float depth = is_on_screen ? path.screen_depth : dot(seen, frame.camera.forward);
    Surface s = path.hit.surface;
    store_features(sight.index,
        path.reached_surface ? pack_features(mirrored(path, s.normal), material_key(s.roughness, s.metallic), depth)
                             : uvec2(0u));
    if (is_on_screen)
        return;
    store_place(sight, path, seen, path.moved);
    if (path.reached_surface)
        store_slope(sight, path, seen, s.geometric_normal);
    else
        store_depth_gradient(sight.index, 0u); // strata of such pixels ask for it, too
}

const uint lens_stream = 0x6c656e73u; // apart from the numbers of the pixel's other choices

// From a random point of a thin lens to where the ray through its middle, of length 1 along the camera's axis, meets
// the plane in focus (pbrt, 5.2.3). In other projections than perspective it is a sphere that is in focus, and the lens
// faces each direction.
Ray through_lens(vec3 direction, Random random)
{
    vec2 xi = next_vec2(random);
    float radius = 0.5 * frame.cvars.pt_aperture * sqrt(xi.x), angle = 2.0 * bsdf_pi * xi.y;
    vec3 across = normalize(frame.camera.right), upward = normalize(frame.camera.up);
    if (frame.cvars.pt_projection != PROJECTION_PERSPECTIVE) {
        across = any_tangent(direction);
        upward = cross(direction, across);
    }
    vec3 offset = radius * (cos(angle) * across + sin(angle) * upward);
    return Ray(frame.camera.eye + offset, normalize(direction * frame.cvars.pt_focus - offset), 0.0, ray_far);
}

void see_pixel(uvec2 pixel, uint index)
{
    Random random = make_pixel_random(pixel);
    bool averages = (frame.flags & FRAME_JITTER) != 0u;
    vec2 offset = averages ? next_vec2(random) : frame.pixel_offset;
    vec3 through_middle = camera_direction(pixel, offset);
    Path path;
    path.ray = Ray(frame.camera.eye, normalize(through_middle), 0.0, ray_far);
    if (averages && frame.cvars.pt_aperture > 0.0)
        path.ray = through_lens(through_middle, random_stream(random, lens_stream));
    path.throughput = vec3(1.0);
    path.emitted = vec3(0.0);
    path.path_length = 0.0;
    path.stretch = 1.0;
    path.mirror = vec3(0.0);
    path.moved = vec3(0.0);
    path.screen_depth = 0.0;
    path.mask = mask_camera;
    path.medium = frame.scene.eye_medium;
    path.reached_surface = false;
    path.unlit_depth = DEPTH_NOTHING;
    path.unlit_segments = 0u;
    path.layers = (frame.flags & FRAME_LAYERED) != 0u ? share_layers(pixel) : unshared_layers;
    Sight sight = Sight(path.ray.direction, index, offset, pixel_spread());

    ROLLED_FOR (uint segment = 0u; segment < max_specular_segments + path.unlit_segments; segment++)
        if (!follow_path(path, sight, random))
            break;
    store_traced_rays(index);

    if ((frame.flags & FRAME_REPROJECTED) != 0u)
        store_reprojection(sight, path);
    if ((frame.flags & FRAME_REPLAYED) != 0u)
        store_random_seed(index, uvec2(join_halves(pixel), frame.frame_index));
    store_emitted(index, pack_floats3(path.emitted));
    uint more_bits = other_layers_bits(path.layers) | brightness_bits(path.emitted);
    store_throughput(index, pack_light3(path.throughput) | uvec2(0u, more_bits));
    if (!path.reached_surface) {
        store_position(index, vec4(path.ray.direction, path.unlit_depth));
        return;
    }
    store_position(index, vec4(path.hit.surface.position, path.path_length));
    store_surface(index, path.hit);
    if (frame.cvars.pt_debug_view == DEBUG_VIEW_CACHE)
        store_emitted(index, pack_floats3(show_light_cache(path.hit)));
}

VKPT_RUN_OVER_PIXELS(see_pixel)

// SPDX-License-Identifier: GPL-2.0-or-later
// Where things stand on the screen, in this view and in the last one.
#ifndef VKPT_LIB_REPROJECTION
#define VKPT_LIB_REPROJECTION

#include "frame.glsl"
#include "packing.glsl"
#include "pixel_random.glsl"
#include "projection.glsl"

// Place in the last view, whole numbers being its pixels' samples, and depth there; see pack_place.
vec3 fetch_place(uint index) { return unpack_place(load_reprojected(index)); }

// From a pixel to where the last view showed the same, `place` as fetch_place has it; 1: over the whole screen.
vec2 way_back(uvec2 pixel, vec2 place)
{
    return (place + 0.5) / vec2(frame.previous_size) - (vec2(pixel) + 0.5) / vec2(frame.size);
}

// How much wider a pixel gets over a unit of its ray.
float pixel_spread() { return 2.0 * length(frame.camera.right) / float(frame.size.x); }

// From -1 to 1, y down: a place in a pixel, `offset` from its corner.
vec2 screen_place(uvec2 pixel, vec2 offset) { return (vec2(pixel) + offset) / vec2(frame.size) * 2.0 - 1.0; }

// Along a perspective camera's ray through a pixel, `offset` from its corner; 1 along the camera's axis. Images that
// are filtered have no other projection.
vec3 perspective_direction(uvec2 pixel, vec2 offset)
{
    vec2 screen = screen_place(pixel, offset);
    return frame.camera.forward + frame.camera.right * screen.x - frame.camera.up * screen.y;
}

// The same in any projection; of length 1 in others than a perspective one.
vec3 camera_direction(uvec2 pixel, vec2 offset)
{
    if (frame.cvars.pt_projection == PROJECTION_PERSPECTIVE)
        return perspective_direction(pixel, offset);
    vec2 screen = screen_place(pixel, offset);
    Camera camera = frame.camera;
    float across = length(camera.right), upward = length(camera.up);
    vec3 seen = unproject(frame.cvars.pt_projection, vec2(across, -upward) * screen);
    return camera.right * (seen.x / across) + camera.up * (seen.y / upward) + camera.forward * seen.z;
}

struct ScreenPoint {
    vec2 pixel; // (0, 0): the corner of the first pixel
    float depth; // along the camera's axis; <= 0: behind it
};

// On a screen of `size` pixels.
ScreenPoint project(Camera camera, vec3 point, uvec2 size)
{
    vec3 offset = point - camera.eye;
    float depth = dot(offset, camera.forward);
    vec2 screen = vec2(dot(offset, camera.right) / dot(camera.right, camera.right),
                      -dot(offset, camera.up) / dot(camera.up, camera.up))
        / quick_max(depth, 1e-3);
    return ScreenPoint((screen * 0.5 + 0.5) * vec2(size), depth);
}

// The pixel of the last view, whole numbers being pixels, whose middle shows what the middle of a pixel of this one
// does: `before` is where that pixel's ray, which passes `offset` from its corner, ended.
vec2 place_in_last_view(ScreenPoint before, vec2 offset)
{
    return before.depth > 0.0 ? before.pixel - 0.5 - (offset - 0.5) * frame.previous_scale : vec2(-1e6);
}

// Shading normal, material and depth, as filters compare them. `material`: see material_key.
uvec2 pack_features(vec3 normal, float material, float depth)
{
    return uvec2(pack_snorm4(vec4(normal, material)), floatBitsToUint(depth));
}
// Normal and material, times 127.
vec4 feature_bytes(uint bits) { return unpack_snorm4_times_127(bits); }
float feature_depth(uvec2 features) { return uintBitsToFloat(features.y); }

// One number for what tells materials apart: keys of two roughnesses differ by half their difference, those of a metal
// and another material by 1 at least.
float material_key(float roughness, float metallic) { return (0.5 + 0.5 * roughness) * (metallic > 0.5 ? -1.0 : 1.0); }

// Relative distance of a tap's depth from the plane through the pixel's surface; 0: on it. 1 / depth is linear on the
// screen.
float plane_distance(float depth, vec2 depth_gradient, vec2 pixels, float tap_depth)
{
    return abs(depth / quick_max(tap_depth, 1e-6) - 1.0 - dot(depth_gradient, pixels));
}

// How far from the plane a tap may lie, relative to depth: curved things lean away from it with the depth gradient.
float plane_tolerance(vec2 depth_gradient, vec2 pixels) { return 0.008 + 0.25 * dot(abs(depth_gradient), abs(pixels)); }

// What finds a pixel's surface in the last view: its features and depth gradient, and where it was then, with its depth
// there.
struct ReprojectionQuery {
    vec3 normal; // over 127^2, for taps' normals times 127
    float material; // times 127
    vec2 depth_gradient;
    vec3 shown;
};

ReprojectionQuery make_query(uvec2 features, vec2 depth_gradient, vec3 shown)
{
    vec4 kind = feature_bytes(features.x);
    return ReprojectionQuery(kind.xyz * (1.0 / (127.0 * 127.0)), kind.w, depth_gradient, shown);
}

// The pixel of the last view that is nearest to a place there, or one beyond its edge.
ivec2 nearest_in_last_view(vec2 place)
{
    return whole_to_int(floor(clamp(place, vec2(-2.0), vec2(frame.previous_size) + 2.0) + 0.5));
}

bool is_in_last_view(ivec2 place)
{
    return all(greaterThanEqual(place, ivec2(0))) && all(lessThan(place, ivec2(frame.previous_size)));
}

// Whether the last view's pixel `place` shows the surface; `there`: its index, 0 outside of that view.
bool shows_surface(ReprojectionQuery query, ivec2 place, out uint there)
{
    const float min_normal_cosine = 0.9, max_material_difference = 0.1; // of material_key
    bool inside = is_in_last_view(place);
    there = inside ? uint(place.y) * frame.previous_size.x + uint(place.x) : 0u;
    uvec2 old = load_previous_features(there);
    vec2 pixels = (vec2(place) + frame.offset_change - query.shown.xy) / frame.previous_scale;
    float distance = plane_distance(query.shown.z, query.depth_gradient, pixels, feature_depth(old));
    vec4 kind = feature_bytes(old.x);
    return inside && distance <= plane_tolerance(query.depth_gradient, vec2(1.0))
        && dot(query.normal, kind.xyz) >= min_normal_cosine
        && abs(query.material - kind.w) <= 127.0 * max_material_difference;
}

// What the buffer random_seed holds where the light is not the pixel's own sample alone.
const uvec2 no_random_seed = uvec2(0xffffffffu);
bool is_own_sample(uvec2 seed) { return seed.y != no_random_seed.y; }

// The generator of a pixel's light paths: its own, or the one of the older sample that it repeats.
Random random_of_pixel(uvec2 pixel, uint index)
{
    if ((frame.flags & FRAME_REPLAYED) == 0u)
        return make_pixel_random(pixel);
    uvec2 seed = load_random_seed(index);
    return make_pixel_random_of(split_halves(seed.x), seed.y);
}

#endif

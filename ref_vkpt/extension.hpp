// SPDX-License-Identifier: GPL-2.0-or-later
// What ref_vkpt.so offers beyond the engine's refresh API: images, timings, and facts about itself.
// A host gets it with dlsym(module, "vkpt_extension"). Everything is valid between Init and Shutdown, on the engine's
// thread. The host replaces the engine: it hands GetRefAPI its own imports and calls InitContext(nullptr) for "no
// window".
#pragma once

#include "shaders/shared/probes.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace vkpt {

using shared::InspectedLight;
using shared::InspectedSurface;
using shared::IrradianceProbe;
using shared::TracedHit;
using shared::TracedRay;

inline constexpr uint32_t extension_version = 8;

inline constexpr uint32_t view_count = 4; // that select_view can tell apart

struct ImageSize {
    int32_t width = 0, height = 0;
};

struct PassTime {
    const char* name; // the pass's shader file without its ending
    double milliseconds;
};

// Strings live until the next call or Shutdown. Lists end with nullptr.
struct ModuleInfo {
    const char* device;
    const char* driver;
    const char* vulkan_version;
    const char* trace_backend; // the one in use
    const char* const* trace_backends;
    const char* const* light_samplers;
    const uint32_t* light_sampler_traits; // one each: SAMPLER_* of shaders/shared/light_sampler.h
    const char* const* denoisers;
    int32_t api_versions[8]; // zero-terminated
    int32_t max_entities, max_dlights, max_particles, max_image_size;
    // counts of the current map
    uint64_t triangles, dynamic_triangles, clusters, emitters, light_list_entries, textures;
    // bytes by kind
    uint64_t texture_bytes, geometry_bytes, acceleration_bytes, light_bytes, image_bytes, staging_bytes;
    double structure_bytes_per_triangle; // of the map, in the trace backend in use
    // Rays of the last frame with pt_count_rays 1: for the nearest hit, for visibility.
    uint64_t nearest_rays, visibility_rays;
    double emitted_power[3]; // of all emitters of the last view: radiance * units^2 * sr, RGB
};

// SAMPLER_* of a light sampler; 0: the module has none of that name.
inline uint32_t find_sampler_traits(const ModuleInfo& info, std::string_view sampler)
{
    for (size_t i = 0; info.light_samplers[i]; i++)
        if (info.light_samplers[i] == sampler)
            return info.light_sampler_traits[i];
    return 0;
}

// Times of one pass, or of one of the CPU's tasks ("cpu scene"), over many frames.
struct PassSamples {
    const char* name;
    const float* milliseconds; // one a frame that was timed, oldest first
    uint64_t count;
};

struct TraceRequest {
    uint32_t ray_mask = 0xff; // MASK_* of shaders/shared/scene.h
    bool visibility = false; // whether anything is met, instead of the nearest
    uint32_t row_length = 1024; // rays are traced like pixels of an image so wide: in tiles of 8 x 8
    uint32_t rounds = 1; // how often, for timing; the first of several is preceded by one more that does not count
};

// The scene of the last view: Quake world units, z up; linear RGB.
struct SceneTriangle {
    float positions[3][3]; // cross(p1 - p0, p2 - p0) points to the front
    float uvs[3][2]; // texture coordinates, 1 = one texture width; v grows downwards
    float normals[3][3]; // for shading, unit, on the front's side
    uint32_t material; // index into SceneContents::materials
    // Index into SceneContents::emitters. -1: none. -2: shines only for those who see it, emitters of its face send its
    // light.
    int32_t emitter;
    uint32_t ray_mask; // MASK_* of shaders/shared/scene.h
};

struct SceneMaterial {
    const char* texture; // the file it was read from; empty: none
    float tint[3]; // multiplies the texture's colours
    float base_colour[3]; // the texture's average, tinted
    float opacity; // 1 opaque
    float emission_tint[3]; // radiance of the front, at this moment = this * the texture's colour
    float emission[3]; // its average
    float uv_scroll[2]; // added to texture coordinates, at this moment
    float roughness; // GGX alpha = roughness^2
    float metallic;
    float specular; // share that is left of the coat's reflectance, 1 usually
    uint32_t flags; // MATERIAL_* of shaders/shared/scene.h
};

struct SceneEmitter {
    uint32_t type; // EMITTER_* of shaders/shared/scene.h
    float positions[3][3]; // of triangles
    float centre[3], radius; // of spheres, and of suns, which are far away
    float radiance[3]; // average, at this moment; triangles: of the front
    float area;
    float reach; // no light farther than this from its place; 0: no limit
    // Of spots: with the cosine between axis and receiver the light goes from all of it at the first to none at the
    // second.
    float cone_axis[3] = {};
    float cone_cosines[2] = {}; // both 0: no cone
};

// Radiance along direction d: that of the textures' cube along (dot(d, rotation[0]), dot(d, rotation[1]), dot(d,
// rotation[2])), times `radiance`. Textures are of the sides +x, -x, +y, -y, +z, -z.
struct SceneSky {
    const char* textures[6]; // files; empty: a plain white side. All empty: `radiance` alone is the sky
    float rotation[3][3];
    float radiance[3];
};

struct SceneCamera {
    float eye[3], forward[3], right[3], up[3]; // right, up: scaled by the tangent of half the angle of sight
};

struct SceneContents {
    const SceneTriangle* triangles;
    size_t triangle_count;
    const SceneMaterial* materials;
    size_t material_count;
    const SceneEmitter* emitters; // dark ones, too: the place of a dynamic light that has gone is kept
    size_t emitter_count;
    SceneCamera camera;
    SceneSky sky;
    float time; // seconds of the game, which liquids move by
};

struct Extension {
    uint32_t version;
    uint32_t struct_size;
    // The size of the last frame's image.
    ImageSize (*frame_size)();
    // The last finished frame as shown (sRGB-encoded RGBA8, 4 * width * height bytes, top row first). False: no frame
    // yet.
    bool (*capture_display)(uint8_t* rgba);
    // The last 3D view as linear radiance before exposure (RGB float32, 3 * width * height, top row first). With
    // pt_accumulate 1: the average of all frames since the last change.
    bool (*capture_radiance)(float* rgb);
    // How many frames the accumulation holds.
    uint32_t (*accumulated_frames)();
    // Passes of the last finished frame that they were timed in, in order: the first frame and one of sixteen, with
    // pt_times 1 of two, from time_every_pass on each. On Mesa's CPU driver timing them makes a frame 1.5 ms longer.
    // The array lives until the next frame ends.
    const PassTime* (*pass_times)(size_t* count);
    void (*time_every_pass)();
    ModuleInfo (*info)();
    // Irradiance / pi (that is: the radiance of a white diffuse surface) at each probe, RGB, `samples` paths each,
    // in the map of the last frame with its lightstyles. False: no map.
    bool (*measure_irradiance)(const IrradianceProbe* probes, size_t count, uint32_t samples, float* rgb);
    // Traces rays through the scene of the last frame by the trace backend in use. Returns the seconds that one round
    // took on the device; negative: no map.
    double (*trace_rays)(const TracedRay* rays, size_t count, const TraceRequest* request, TracedHit* hits);
    // With pt_accumulate 1: the next view's things count instead of the frozen ones, and the average starts anew.
    void (*thaw_scene)();
    // With pt_times 1: all times since the start or the last forget_times, in order of their first appearance; "frame"
    // is that from one frame's completion to the next one's, of frames with a 3D view. Frames' passes and whole frames
    // are timed by turns, passes first after forget_times. Waits for the device, so that the last frame is among them.
    // The arrays live until the next frame begins. Of each the last 4096 samples are there at least.
    const PassSamples* (*collected_times)(size_t* count);
    void (*forget_times)();
    // What the last view was made of. Valid until the next frame or call. False: no map.
    bool (*read_scene)(SceneContents* contents);
    // Several images at once, drawn in turn: each of `view_count` views has its own accumulation, history of the
    // filters, exposure and frozen time. What is drawn, captured and inspected from here on is of view `view`; 0 at the
    // start. Between frames. A view's memory lives until the next map is registered. False: no such view.
    bool (*select_view)(uint32_t view);
    // The surface in pixel (x, y) of the last frame's image, and up to `capacity` lights of its list in list order,
    // by the settings of that frame. Runs the light sampler's shader: milliseconds, with the sampler `full` longer.
    // False: no 3D view of a map has been drawn, or it does not cover the pixel.
    bool (*inspect_pixel)(uint32_t x, uint32_t y, InspectedSurface* surface, InspectedLight* lights, size_t capacity);
    // With pt_accumulate 1: the next view, whatever has moved in it, goes into the same average (motion blur).
    void (*blend_next_view)();
};

// Signature of the exported symbol "vkpt_extension". Returns nullptr if `version` is not served.
using GetExtension = const Extension* (*)(uint32_t version);

} // namespace vkpt

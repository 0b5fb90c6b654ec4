// SPDX-License-Identifier: GPL-2.0-or-later
// A renderer that draws nothing and tells the console what it was asked: what exports.cpp and the host are tested with.
// Cvars steer it: "fake_throw" = "VERB KIND" makes one verb throw (level, fatal, format, memory, bug, number);
// "fake_lens" = 1 tells of the lens before each view.
#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/engine/exports.hpp"
#include "ref_vkpt/renderer.hpp"
#include "shaders/shared/light_sampler.h"

#include <new>
#include <vector>

namespace vkpt {

namespace {

int handle_target = 0; // handles only need to differ from nullptr
engine::VideoSize frame { 0, 0 };
uint32_t frames_done = 0, forgotten_frames = 0;
float last_eye[3] = {};

void throw_if_asked(std::string_view verb)
{
    const std::string wanted = engine::get_cvar("fake_throw", "", engine::CVAR_NONE)->text;
    if (!wanted.starts_with(fmt::format("{} ", verb)))
        return;
    const std::string kind = wanted.substr(verb.size() + 1);
    if (kind == "level")
        throw LevelError("the level is over");
    if (kind == "fatal")
        throw FatalError("the device is lost");
    if (kind == "format")
        throw formats::FormatError("maps/x.bsp", 12, "too short");
    if (kind == "memory")
        throw std::bad_alloc();
    if (kind == "bug")
        throw std::logic_error("a bug");
    throw 42;
}

template <class... Arguments> void note(std::string_view verb, Arguments... arguments)
{
    std::string line = fmt::format("call {}", verb);
    ((line += fmt::format(" {}", arguments)), ...);
    engine::print(std::string_view(line));
    throw_if_asked(verb);
}

float pixel_value(int x, int y, int channel) { return float(x + 10 * y + 100 * channel); }

bool capture_display(uint8_t* rgba)
{
    if (!frames_done)
        return false;
    for (int y = 0; y < frame.height; y++)
        for (int x = 0; x < frame.width; x++)
            for (int channel = 0; channel < 4; channel++)
                *rgba++ = channel == 3 ? 255 : uint8_t(pixel_value(x, y, channel));
    return true;
}

bool capture_radiance(float* rgb)
{
    if (!frames_done)
        return false;
    for (int y = 0; y < frame.height; y++)
        for (int x = 0; x < frame.width; x++)
            for (int channel = 0; channel < 3; channel++)
                *rgb++ = pixel_value(x, y, channel);
    return true;
}

constexpr const char* backends[] = { "software", nullptr };
constexpr const char* samplers[] = { "subset_pps", "uniform", nullptr };
constexpr uint32_t sampler_traits[] = { shared::SAMPLER_USES_SUBSET, 0 };
constexpr const char* denoisers[] = { "off", "asvgf", nullptr };

ModuleInfo info()
{
    ModuleInfo facts {};
    facts.device = "a device of paper";
    facts.driver = "pencil 2";
    facts.vulkan_version = "1.2.0";
    facts.trace_backend = "software";
    facts.trace_backends = backends;
    facts.light_samplers = samplers;
    facts.light_sampler_traits = sampler_traits;
    facts.denoisers = denoisers;
    for (int i = 0; i < 4; i++)
        facts.api_versions[i] = 5 + i;
    facts.max_entities = engine::max_entities;
    facts.max_dlights = engine::max_dlights;
    facts.max_particles = engine::max_particles;
    facts.max_image_size = 16384;
    facts.nearest_rays = 6;
    facts.visibility_rays = 2;
    return facts;
}

// Every frame took as long as every other.
const PassSamples* fake_times(size_t* count)
{
    static std::vector<float> whole, rays, scene;
    whole.assign(frames_done - forgotten_frames, 4.0f);
    rays.assign(frames_done - forgotten_frames, 2.0f);
    scene.assign(frames_done - forgotten_frames, 0.25f);
    static PassSamples samples[3];
    samples[0] = { "frame", whole.data(), whole.size() };
    samples[1] = { "rays", rays.data(), rays.size() };
    samples[2] = { "cpu scene", scene.data(), scene.size() };
    *count = rays.empty() ? 0 : 3;
    return samples;
}

bool inspect_pixel(uint32_t x, uint32_t y, InspectedSurface* surface, InspectedLight* lights, size_t capacity)
{
    *surface = { { float(x), float(y), 0 }, 1 };
    surface->light_count = surface->choices = 1;
    if (capacity > 0)
        lights[0] = { 7, 0, {}, 1, { 1, 1, 1 }, 0, 2, 1, 1 };
    return true;
}

} // namespace

const Extension& extension_table()
{
    static const Extension table { extension_version, sizeof(Extension),
        [] {
            return ImageSize { frame.width, frame.height };
        },
        capture_display, capture_radiance, [] { return frames_done; },
        [](size_t* count) -> const PassTime* {
            *count = 0;
            return nullptr;
        },
        [] {}, info, [](const IrradianceProbe*, size_t, uint32_t, float*) { return false; },
        [](const TracedRay*, size_t, const TraceRequest*, TracedHit*) { return -1.0; }, [] {}, fake_times,
        [] { forgotten_frames = frames_done; }, [](SceneContents*) { return false; },
        [](uint32_t view) { return view < view_count; }, inspect_pixel, [] { note("blend_next_view"); } };
    return table;
}

namespace renderer {

bool init()
{
    note("init");
    engine::get_cvar("fake_models", "0", engine::CVAR_NONE);
    engine::get_cvar("fake_lens", "0", engine::CVAR_NONE);
    cvars::register_all();
    engine::add_command("fake_command", [] { note("command", engine::argument(1)); });
    const auto size = engine::init_graphics(0, { cvars::values().r_customwidth, cvars::values().r_customheight });
    if (size)
        frame = *size;
    return size.has_value();
}
void shutdown() { note("shutdown"); }
int prepare_for_window()
{
    note("prepare_for_window");
    return 0x10000000;
}
bool init_context(void* window)
{
    note("init_context", window != nullptr);
    return true;
}
void shutdown_context() { note("shutdown_context"); }
bool is_vsync_active()
{
    note("is_vsync_active");
    return true;
}
void get_drawable_size(int* width, int* height)
{
    note("get_drawable_size");
    *width = 123;
    *height = 45;
}
std::string describe_lost_device() { return "in a fake pass"; }
void begin_registration(std::string_view map) { note("begin_registration", map); }
void* register_model(std::string_view name)
{
    note("register_model", name);
    return &handle_target;
}
void* register_skin(std::string_view name)
{
    note("register_skin", name);
    return &handle_target;
}
void set_sky(std::string_view name, float rotate, const float axis[3])
{
    note("set_sky", name, rotate, axis[0], axis[1], axis[2]);
}
void end_registration() { note("end_registration"); }
void begin_frame(float separation)
{
    note("begin_frame", separation);
    cvars::update();
}
void render_view(const engine::RefDef& refdef)
{
    for (int i = 0; i < 3; i++)
        last_eye[i] = refdef.view_origin[i];
    if (std::string_view(engine::get_cvar("fake_lens", "0", engine::CVAR_NONE)->text) == "1")
        note("lens", cvars::values().pt_aperture, cvars::values().pt_focus);
    note("render_view", refdef.width, refdef.height, last_eye[0], last_eye[1], last_eye[2], refdef.view_angles[0],
        refdef.view_angles[1], refdef.entity_count);
}
void end_frame()
{
    note("end_frame");
    frames_done++;
}
bool end_world_renderpass()
{
    note("end_world_renderpass");
    return true;
}
void* find_pic(std::string_view name)
{
    note("find_pic", name);
    return &handle_target;
}
void get_pic_size(std::string_view name, int* width, int* height)
{
    note("get_pic_size", name);
    *width = 12;
    *height = 34;
}
void draw_pic(int x, int y, std::string_view name, float scale, const float* tint)
{
    note("draw_pic", x, y, name, scale, tint ? tint[2] : -1);
}
void draw_stretched_pic(int x, int y, int width, int height, std::string_view name)
{
    note("draw_stretched_pic", x, y, width, height, name);
}
void draw_character(int x, int y, int code, float scale) { note("draw_character", x, y, code, scale); }
void draw_tiled(int x, int y, int width, int height, std::string_view name)
{
    note("draw_tiled", x, y, width, height, name);
}
void draw_fill(int x, int y, int width, int height, int index) { note("draw_fill", x, y, width, height, index); }
void draw_fade() { note("draw_fade"); }
void draw_raw(int x, int y, int width, int height, int columns, int rows, const uint8_t* pixels, int bits)
{
    note("draw_raw", x, y, width, height, columns, rows, pixels != nullptr, bits);
}
void set_palette(const uint8_t* rgb) { note("set_palette", rgb != nullptr); }

} // namespace renderer
} // namespace vkpt

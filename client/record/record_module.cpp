// SPDX-License-Identifier: GPL-2.0-or-later
// ref_record.so: a refresh module that draws nothing and writes what it is asked into the trace that $VKPT_TRACE names.
#include "client/record/recorder.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/renderer.hpp"

#include <algorithm>
#include <cstdlib>
#include <dlfcn.h>
#include <memory>
#include <system_error>

namespace vkpt {

using trace::Call;
using trace::CallKind;

namespace {

std::unique_ptr<Recorder> recorder;
engine::VideoSize screen { 640, 480 };

// A trace that cannot be written ends the engine: what it would play further is lost.
template <class Work> auto with_trace(Work work)
{
    try {
        return work(*recorder);
    } catch (const std::system_error& error) {
        throw FatalError(error.what());
    }
}

void write(Call call)
{
    with_trace([&](Recorder& r) { r.write(std::move(call)); });
}

template <class Function> Function* find_preloaded(const char* name)
{
    return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

// `vkpt record` preloads recording_clock.so; without it, time is the wall's. The engine's step is whole milliseconds.
// With sound it preloads recording_sound.so, too.
void advance_clock()
{
    static auto* const advance = find_preloaded<void(int64_t)>("vkpt_advance_clock");
    static auto* const advance_sound = find_preloaded<void(int64_t)>("vkpt_advance_sound");
    const int64_t step = int64_t(engine::get_cvar("fixedtime", "0", engine::CVAR_NONE)->number) / 1000 * 1000;
    for (auto* const function : { advance, advance_sound })
        if (function)
            function(step);
}

void call_preloaded(const char* name)
{
    if (auto* const function = find_preloaded<void()>(name))
        function();
}

engine::VideoSize wanted_size()
{
    const auto number = [](const char* name, const char* initial) {
        return int(engine::get_cvar(name, initial, engine::CVAR_ARCHIVE)->number);
    };
    if (const auto size = engine::mode_size(number("r_mode", "4")))
        return *size;
    return { std::clamp(number("r_customwidth", "1024"), 64, 16384),
        std::clamp(number("r_customheight", "768"), 64, 16384) };
}

} // namespace

namespace renderer {

int prepare_for_window() { return 0; }
bool init_context(void*) { return true; }
void shutdown_context() { }

bool init()
{
    const char* path = std::getenv("VKPT_TRACE");
    if (!path || !*path)
        throw FatalError("$VKPT_TRACE does not name the file to record into; `vkpt record` sets it");
    if (recorder)
        throw FatalError("one run of the engine makes one trace: restart the engine to make another");
    engine::init_video_menu();
    const auto size = engine::init_graphics(0, wanted_size());
    if (!size)
        throw FatalError("the engine could not open its window; SDL_VIDEODRIVER=dummy needs no display");
    screen = *size;
    try {
        recorder = std::make_unique<Recorder>(path);
    } catch (const std::system_error& error) {
        throw FatalError(error.what());
    }
    with_trace([](Recorder& r) { r.note_start(screen.width, screen.height); });
    return true;
}

void shutdown()
{
    if (!recorder)
        return;
    with_trace([](Recorder& r) { r.finish(); });
    call_preloaded("vkpt_finish_sound");
    engine::print("ref_record: {} views in {} frames", recorder->totals().views, recorder->totals().frames);
    recorder = nullptr;
}

bool is_vsync_active() { return false; }

std::string describe_lost_device() { return {}; } // it has none

void get_drawable_size(int* width, int* height)
{
    *width = screen.width;
    *height = screen.height;
}

void begin_registration(std::string_view map)
{
    write(make_call(CallKind::begin_registration, map));
    with_trace([&](Recorder& r) { r.begin_registration(map); });
}

void* register_model(std::string_view name)
{
    return with_trace([&](Recorder& r) { return r.register_model(name); });
}

void* register_skin(std::string_view name)
{
    return with_trace([&](Recorder& r) { return r.register_skin(name); });
}

void set_sky(std::string_view name, float rotate, const float axis[3])
{
    with_trace([&](Recorder& r) { r.find_sky(name); });
    write(make_call(CallKind::set_sky, name, {}, { rotate, axis[0], axis[1], axis[2] }));
}

void end_registration() { write(make_call(CallKind::end_registration)); }

void begin_frame(float camera_separation)
{
    advance_clock();
    with_trace([&](Recorder& r) { r.begin_frame(camera_separation); });
}

void render_view(const engine::RefDef& refdef)
{
    with_trace([&](Recorder& r) { r.write_view(refdef); });
    call_preloaded("vkpt_note_view");
}

void end_frame()
{
    with_trace([](Recorder& r) { r.end_frame(); });
}

bool end_world_renderpass()
{
    write(make_call(CallKind::end_world_renderpass));
    return true;
}

void* find_pic(std::string_view name)
{
    void* const handle = with_trace([&](Recorder& r) { return Recorder::picture_handle(r.find_pic(name)); });
    Call call = make_call(CallKind::find_pic, name);
    call.flag = handle != nullptr;
    write(std::move(call));
    return handle;
}

void get_pic_size(std::string_view name, int* width, int* height)
{
    const auto size = with_trace([&](Recorder& r) { return r.find_pic(name); });
    *width = size.width;
    *height = size.height;
    write(make_call(CallKind::picture_size, name, { size.width, size.height }));
}

void draw_pic(int x, int y, std::string_view name, float scale, const float* tint)
{
    with_trace([&](Recorder& r) { return r.find_pic(name); });
    Call call = make_call(CallKind::draw_pic, name, { x, y }, { scale });
    call.flag = tint != nullptr;
    for (size_t i = 0; tint && i < 3; i++)
        call.reals[1 + i] = tint[i];
    write(std::move(call));
}

void draw_stretched_pic(int x, int y, int width, int height, std::string_view name)
{
    with_trace([&](Recorder& r) { return r.find_pic(name); });
    write(make_call(CallKind::draw_stretched, name, { x, y, width, height }));
}

void draw_character(int x, int y, int code, float scale)
{
    write(make_call(CallKind::draw_character, "", { x, y, code }, { scale }));
}

void draw_tiled(int x, int y, int width, int height, std::string_view name)
{
    with_trace([&](Recorder& r) { return r.find_pic(name); });
    write(make_call(CallKind::draw_tiled, name, { x, y, width, height }));
}

void draw_fill(int x, int y, int width, int height, int palette_index)
{
    write(make_call(CallKind::draw_fill, "", { x, y, width, height, palette_index }));
}

void draw_fade() { write(make_call(CallKind::draw_fade)); }

void draw_raw(int x, int y, int width, int height, int columns, int rows, const uint8_t* pixels, int bits)
{
    Call call = make_call(CallKind::draw_raw, "", { x, y, width, height, columns, rows, bits });
    if (pixels && columns > 0 && rows > 0) {
        const auto* bytes = reinterpret_cast<const std::byte*>(pixels);
        call.data.assign(bytes, bytes + size_t(columns) * size_t(rows) * size_t(bits == 32 ? 4 : 1));
    }
    write(std::move(call));
}

void set_palette(const uint8_t* rgb)
{
    constexpr size_t palette_bytes = 768;
    Call call = make_call(CallKind::set_palette);
    const auto* bytes = reinterpret_cast<const std::byte*>(rgb);
    if (rgb)
        call.data.assign(bytes, bytes + palette_bytes);
    write(std::move(call));
}

} // namespace renderer
} // namespace vkpt

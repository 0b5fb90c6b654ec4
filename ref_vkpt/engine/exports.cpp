// SPDX-License-Identifier: GPL-2.0-or-later
// The module's door for the engine, GetRefAPI. No exception passes it, and
// nothing with a destructor is alive on this side of a call that makes the engine jump (engine.hpp, "errors").
#include "ref_vkpt/engine/exports.hpp"

#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/renderer.hpp"

#include <array>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <new>

// In front of every message.
#ifndef VKPT_MODULE_NAME
#define VKPT_MODULE_NAME "ref_vkpt"
#endif

namespace vkpt {

namespace {

enum class Failure { none, level, lost, fatal };

// Static, because it must outlive the stack that failed.
char failure_text[2048];

// The engine has been asked to start the module anew, which it does before its next frame. What it calls until then
// does nothing.
bool awaits_restart = false;

// Files the exception in flight. Says what kind of failure it is.
Failure note_failure(const char* entry)
{
    const auto note = [&](Failure kind, const char* format, const char* first, const char* second) {
        std::snprintf(failure_text, sizeof failure_text, format, first, second);
        return kind;
    };
    try {
        throw;
    } catch (const formats::FormatError& error) {
        return note(Failure::level, VKPT_MODULE_NAME ": %s%s", error.what(), "");
    } catch (const LevelError& error) {
        return note(Failure::level, VKPT_MODULE_NAME ": %s%s", error.what(), "");
    } catch (const DeviceLost& error) {
        return note(Failure::lost, VKPT_MODULE_NAME ": %s%s", error.what(), "");
    } catch (const FatalError& error) {
        return note(Failure::fatal, VKPT_MODULE_NAME ": %s%s", error.what(), "");
    } catch (const std::bad_alloc&) {
        return note(Failure::level, VKPT_MODULE_NAME ": out of memory in %s%s", entry,
            ": close other programs, or lower r_mode");
    } catch (const std::exception& error) {
        return note(Failure::fatal, VKPT_MODULE_NAME ": internal error in %s: %s", entry, error.what());
    } catch (...) {
        return note(Failure::fatal, VKPT_MODULE_NAME ": internal error in %s%s", entry, "");
    }
}

// A lost device: adds to failure_text what is known of it. True: the engine was asked for a new start, which it gets
// once as long as it runs; a card that is lost again would be lost for ever.
bool restart_instead(Failure failure)
{
    constexpr const char* counter
        = "vkpt_lost_devices"; // a cvar, because the module's own memory goes with the restart
    if (failure != Failure::lost)
        return false;
    try {
        const std::string what = renderer::describe_lost_device();
        const size_t length = std::strlen(failure_text);
        std::snprintf(failure_text + length, sizeof failure_text - length, " %s", what.c_str());
    } catch (const std::exception&) {
        // Said without.
    }
    const engine::Cvar* losses = engine::get_cvar(counter, "0", engine::CVAR_NONE);
    if (!losses || losses->number > 0)
        return false;
    engine::set_cvar(counter, 1);
    engine::print(std::string_view(failure_text));
    engine::print(VKPT_MODULE_NAME ": starting the renderer anew");
    engine::request_restart(engine::Restart::full);
    awaits_restart = true;
    return true;
}

[[noreturn]] void leave(Failure failure)
{
    if (failure == Failure::level)
        engine::drop_level(failure_text);
    engine::stop_engine(failure_text);
}

// Runs `call`. An exception drops the level or stops the engine, after its handler has been left: the engine jumps.
template <class Call> auto guard(const char* entry, Call call)
{
    using Result = decltype(call());
    if (awaits_restart)
        return Result();
    Failure failure = Failure::none;
    try {
        return call();
    } catch (...) {
        failure = note_failure(entry);
    }
    if (restart_instead(failure))
        return Result();
    leave(failure);
}

// The same for what every frame calls, level or not: if that fails over and over, dropping levels does not help.
template <class Call> void guard_frame(const char* entry, Call call)
{
    constexpr int max_failures = 10;
    static int failures = 0;
    if (awaits_restart)
        return;
    Failure failure = Failure::none;
    try {
        call();
    } catch (...) {
        failure = note_failure(entry);
    }
    if (restart_instead(failure))
        return;
    failures = failure == Failure::none ? 0 : failures + 1;
    if (failure != Failure::none)
        leave(failures < max_failures ? failure : Failure::fatal);
}

// The same where the engine expects to be told by the result: one console line, and `result_on_failure`.
template <class Call, class Result> Result guard_or(const char* entry, Result result_on_failure, Call call)
{
    try {
        return call();
    } catch (...) {
        note_failure(entry);
    }
    engine::print(std::string_view(failure_text));
    return result_on_failure;
}

std::string_view view(const char* text) { return text ? text : ""; }

using engine::QBoolean;
using engine::RefDef;

// ---- the engine's entry points, in the order of the export struct

QBoolean init()
{
    return guard_or("Init", QBoolean(0), [] { return QBoolean(renderer::init()); });
}

void shutdown()
{
    guard_or("Shutdown", 0, [] {
        renderer::shutdown();
        return 0;
    });
}

int prepare_for_window()
{
    return guard_or("PrepareForWindow", -1, [] { return renderer::prepare_for_window(); });
}

int init_context(void* window)
{
    return guard_or("InitContext", 0, [=] { return int(renderer::init_context(window)); });
}

void get_drawable_size(int* width, int* height)
{
    *width = *height = 0;
    guard("GetDrawableSize", [=] { renderer::get_drawable_size(width, height); });
}

void shutdown_context()
{
    guard_or("ShutdownContext", 0, [] {
        renderer::shutdown_context();
        return 0;
    });
}

QBoolean is_vsync_active()
{
    return guard("IsVSyncActive", [] { return QBoolean(renderer::is_vsync_active()); });
}

void begin_registration(const char* map)
{
    guard("BeginRegistration", [=] { renderer::begin_registration(view(map)); });
}

void* register_model(const char* name)
{
    return guard("RegisterModel", [=] { return renderer::register_model(view(name)); });
}

void* register_skin(const char* name)
{
    return guard("RegisterSkin", [=] { return renderer::register_skin(view(name)); });
}

void set_sky(const char* name, float rotate, const float* axis)
{
    guard("SetSky", [=] { renderer::set_sky(view(name), rotate, axis); });
}

void end_registration()
{
    guard("EndRegistration", [] { renderer::end_registration(); });
}

void render_frame(const RefDef* refdef)
{
    guard("RenderFrame", [=] { renderer::render_view(*refdef); });
}

void* draw_find_pic(const char* name)
{
    return guard("DrawFindPic", [=] { return renderer::find_pic(view(name)); });
}

void draw_get_pic_size(int* width, int* height, const char* name)
{
    *width = *height = -1;
    guard("DrawGetPicSize", [=] { renderer::get_pic_size(view(name), width, height); });
}

void draw_pic_scaled(int x, int y, const char* name, float scale)
{
    guard("DrawPicScaled", [=] { renderer::draw_pic(x, y, view(name), scale, nullptr); });
}

void draw_stretch_pic(int x, int y, int width, int height, const char* name)
{
    guard("DrawStretchPic", [=] { renderer::draw_stretched_pic(x, y, width, height, view(name)); });
}

void draw_char_scaled(int x, int y, int code, float scale)
{
    guard("DrawCharScaled", [=] { renderer::draw_character(x, y, code, scale); });
}

void draw_tile_clear(int x, int y, int width, int height, const char* name)
{
    guard("DrawTileClear", [=] { renderer::draw_tiled(x, y, width, height, view(name)); });
}

void draw_fill(int x, int y, int width, int height, int palette_index)
{
    guard("DrawFill", [=] { renderer::draw_fill(x, y, width, height, palette_index); });
}

void draw_fade_screen()
{
    guard("DrawFadeScreen", [] { renderer::draw_fade(); });
}

void draw_raw(int x, int y, int width, int height, int columns, int rows, const uint8_t* pixels, int bits)
{
    guard("DrawStretchRaw", [=] { renderer::draw_raw(x, y, width, height, columns, rows, pixels, bits); });
}

// API 5 passes no bits: what lies in their place is not an argument.
void draw_raw_8_bit(int x, int y, int width, int height, int columns, int rows, const uint8_t* pixels)
{
    draw_raw(x, y, width, height, columns, rows, pixels, 8);
}

void set_palette(const uint8_t* rgb)
{
    guard("SetPalette", [=] { renderer::set_palette(rgb); });
}

void begin_frame(float camera_separation)
{
    guard_frame("BeginFrame", [=] { renderer::begin_frame(camera_separation); });
}

void end_frame()
{
    guard_frame("EndFrame", [] { renderer::end_frame(); });
}

QBoolean end_world_renderpass()
{
    return guard("EndWorldRenderpass", [] { return QBoolean(renderer::end_world_renderpass()); });
}

void draw_pic_scaled_tinted(int x, int y, const char* name, float scale, const float* tint)
{
    guard("DrawPicScaledCol", [=] { renderer::draw_pic(x, y, view(name), scale, tint); });
}

// ---- the table

// The engine's release number says which struct it reserved; 0: none that we know.
int find_api(std::string_view version)
{
    int major = 0, minor = 0;
    const char* end = version.data() + version.size();
    const auto [dot, error] = std::from_chars(version.data(), end, major);
    if (error != std::errc() || dot == end || *dot != '.')
        return 0;
    if (std::from_chars(dot + 1, end, minor).ec != std::errc() || major != 8)
        return 0;
    return minor < 30 ? 5 : minor < 40 ? 6 : minor < 70 ? 7 : minor < 100 ? 8 : 0;
}

struct ExportTable {
    int32_t api;
    int32_t framework; // SDL's major version; padding in API 5 and 6
    std::array<void (*)(), engine::max_export_functions> functions;
};
static_assert(sizeof(ExportTable) == engine::export_struct_bytes(8));

ExportTable make_table(int api)
{
    ExportTable table { api, engine::sdl_major(), {} };
    size_t count = 0;
    const auto add = [&](auto* function) { table.functions[count++] = reinterpret_cast<void (*)()>(function); };
    add(init);
    add(shutdown);
    add(prepare_for_window);
    add(init_context);
    if (api >= 6)
        add(get_drawable_size);
    add(shutdown_context);
    add(is_vsync_active);
    add(begin_registration);
    add(register_model);
    add(register_skin);
    add(set_sky);
    add(end_registration);
    add(render_frame);
    add(draw_find_pic);
    add(draw_get_pic_size);
    add(draw_pic_scaled);
    add(draw_stretch_pic);
    add(draw_char_scaled);
    add(draw_tile_clear);
    add(draw_fill);
    add(draw_fade_screen);
    if (api >= 6)
        add(draw_raw);
    else
        add(draw_raw_8_bit);
    add(set_palette);
    add(begin_frame);
    add(end_frame);
    add(end_world_renderpass);
    if (api >= 8)
        add(draw_pic_scaled_tinted);
    return table;
}

int detect_api()
{
    const engine::Cvar* version = engine::get_cvar("version", "", engine::CVAR_NONE);
    const std::string_view text = version && version->text ? version->text : "";
    const int api = find_api(text);
    if (api == 0)
        engine::print(VKPT_MODULE_NAME
            ": the engine's version \"{}\" is not one of Yamagi Quake II 8.00 to 8.70; if the variable "
            "\"version\" was set by hand, leave it alone",
            text);
    return api;
}

// How a struct whose size is known only at run time is returned by value: as a class that is not trivially copyable its
// "this" is the caller's own slot (guaranteed since C++17), and its constructor writes as much as that caller reserved.
class ReturnedTable {
public:
    explicit ReturnedTable(const engine::Imports& imports)
    {
        engine::attach(imports);
        awaits_restart = false; // the library may have stayed in memory
        const int api = guard_or("GetRefAPI", 0, detect_api);
        // Until it hears of restarts, the engine itself watches vid_fullscreen, and restarts once right after the start
        // because the variable is new. From here on vid_restart works, and a change of the variable waits for it, as
        // with gl3.
        if (api)
            engine::request_restart(engine::Restart::none);
        const ExportTable table = make_table(api);
        const size_t bytes = api ? engine::export_struct_bytes(api) : engine::export_common_bytes;
        // Volatile: the compiler must not conclude from our own size how much lies behind the pointer.
        void* volatile slot = this;
        std::memcpy(slot, &table, bytes);
    }
    ReturnedTable(const ReturnedTable&) = delete;
    ReturnedTable& operator=(const ReturnedTable&) = delete;
    // Written out: this alone makes every ABI return the class through a pointer to the caller's slot.
    ~ReturnedTable() { }

private:
    [[maybe_unused]] std::array<std::byte, engine::export_common_bytes>
        common_; // left as the slot is; see the constructor
};

} // namespace

void run_command(void (*function)()) { guard("a console command", function); }

} // namespace vkpt

#ifdef __clang__
#pragma clang diagnostic ignored                                                                                       \
    "-Wreturn-type-c-linkage" // C has no such class; C callers see the struct it stands for
#endif
extern "C" [[gnu::visibility("default")]] vkpt::ReturnedTable GetRefAPI(vkpt::engine::Imports imports)
{
    return vkpt::ReturnedTable(imports);
}

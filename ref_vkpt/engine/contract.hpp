// SPDX-License-Identifier: GPL-2.0-or-later
// What Yamagi Quake II and a refresh module say to each other, as bytes: API numbers 5 (8.00..8.20), 6 (8.30),
// 7 (8.40..8.60) and 8 (8.70). 64-bit little-endian systems. Facts of the interface under our own names.
// Spaces: Quake units, x east, y north, z up; angles in degrees (pitch, yaw, roll), positive pitch looks down.
#pragma once

#include <cstdarg>
#include <cstddef>
#include <cstdint>

namespace vkpt::engine {

// ---- limits of one refdef

inline constexpr int max_entities = 128;
inline constexpr int max_dlights = 32;
inline constexpr int max_particles = 4096;
inline constexpr int max_lightstyles = 256;

// ---- flags

// Entity::flags
enum EntityFlags : int32_t {
    RF_MINLIGHT = 0x1, // never wholly dark
    RF_VIEWERMODEL = 0x2, // the player's own body: not in the camera's view, but in mirrors and shadows
    RF_WEAPONMODEL = 0x4, // the first-person weapon: the camera's view only
    RF_FULLBRIGHT = 0x8, // shown as its image, unlit
    RF_DEPTHHACK = 0x10, // first-person weapon: nearer than every wall
    RF_TRANSLUCENT = 0x20, // Entity::alpha counts
    RF_FRAMELERP = 0x40,
    RF_BEAM = 0x80, // no model: a cylinder from origin to previous_origin, diameter = frame, colour = skin_number & 255
    RF_CUSTOMSKIN = 0x100, // Entity::skin counts
    RF_GLOW = 0x200, // items pulse
    RF_SHELL_RED = 0x400, // power-up shells: the model once more, slightly inflated
    RF_SHELL_GREEN = 0x800,
    RF_SHELL_BLUE = 0x1000,
    RF_NOSHADOW = 0x2000,
    RF_IR_VISIBLE = 0x8000, // bright red with RDF_IRGOGGLES
    RF_SHELL_DOUBLE = 0x10000,
    RF_SHELL_HALF_DAM = 0x20000,
    RF_USE_DISGUISE = 0x40000,
};
inline constexpr int32_t RF_SHELLS
    = RF_SHELL_RED | RF_SHELL_GREEN | RF_SHELL_BLUE | RF_SHELL_DOUBLE | RF_SHELL_HALF_DAM;

// RefDef::flags
enum ViewFlags : int32_t {
    RDF_UNDERWATER = 0x1, // the eye is in a liquid
    RDF_NOWORLDMODEL = 0x2, // entities alone, on what 2D has drawn so far (the menus' player preview)
    RDF_IRGOGGLES = 0x4,
    RDF_UVGOGGLES = 0x8,
};

// Cvar::flags
enum CvarFlags : int32_t {
    CVAR_NONE = 0,
    CVAR_ARCHIVE = 0x1, // saved in the player's configuration
    CVAR_USERINFO = 0x2,
    CVAR_SERVERINFO = 0x4,
    CVAR_NOSET = 0x8, // from the command line only
    CVAR_LATCH = 0x10, // takes effect later
};

enum PrintLevel : int32_t { PRINT_ALL = 0, PRINT_DEVELOPER = 1, PRINT_ALERT = 2 };

// First argument of Imports::error.
enum ErrorLevel : int32_t {
    ERR_FATAL = 0, // the engine shuts down and exits
    ERR_DROP = 1, // the engine leaves the level (longjmp) and shows its console
    ERR_QUIT = 2,
};

// First argument of Imports::execute_text.
enum ExecuteWhen : int32_t { EXEC_NOW = 0, EXEC_INSERT = 1, EXEC_APPEND = 2 };

// Argument of Imports::request_restart: what the engine does before its next frame.
enum class Restart : int32_t {
    undefined = 0, // where it starts: the engine restarts by itself when vid_fullscreen is marked as modified
    none = 1,
    full = 2, // as vid_restart: the module is loaded anew
    partial = 3, // the map is registered anew
};

// The engine's qboolean. It is an int, except where 8.50 was built as C23: then it is one byte, and the rest of the
// register that carries a returned one is undefined. So: mask what the engine returns with is_true(); what we return is
// 0 or 1 in a full int, which reads the same either way.
using QBoolean = int32_t;
inline constexpr bool is_true(QBoolean returned_by_engine) { return (returned_by_engine & 0xff) != 0; }

// ---- data

// A console variable, owned by the engine; lives as long as the engine. The engine replaces `text` on every change.
struct Cvar {
    char* name;
    char* text;
    char* latched_text; // nullptr: none
    int32_t flags; // CvarFlags
    QBoolean modified;
    float number; // `text` as a number, 0 where it is none
    Cvar* next;
    char* default_text;
};

struct Entity {
    void* model; // what RegisterModel returned
    float angles[3];
    float origin[3];
    int32_t frame;
    float previous_origin[3];
    int32_t previous_frame;
    float backlerp; // weight of the previous frame and origin, 0..1
    int32_t skin_number; // index of the model's own skins
    int32_t lightstyle;
    float alpha; // with RF_TRANSLUCENT
    void* skin; // what RegisterSkin returned; nullptr: skin_number counts
    int32_t flags; // EntityFlags
};

// Contribution at a distance: color * (intensity - distance), in lightmap units of 0..255, never below 0 for a positive
// colour.
struct DynamicLight {
    float origin[3];
    float color[3]; // may be negative
    float intensity; // Quake units: the light's reach
};

struct Particle {
    float origin[3];
    int32_t color; // palette index
    float alpha;
};

struct Lightstyle {
    float rgb[3]; // 0..2, 1 = as compiled
    float white; // r + g + b
};

// One 3D view. Pointers live until RenderFrame returns.
struct RefDef {
    int32_t x, y, width, height; // window pixels
    float fov_x, fov_y; // degrees
    float view_origin[3];
    float view_angles[3];
    float blend[4]; // RGBA over the whole view
    float time; // seconds
    int32_t flags; // ViewFlags
    const uint8_t* area_bits; // one bit per area that can be seen through open doors; nullptr: all
    const Lightstyle* lightstyles; // max_lightstyles of them; nullptr in the menus' views
    int32_t entity_count;
    const Entity* entities;
    int32_t dlight_count;
    const DynamicLight* dlights;
    int32_t particle_count;
    const Particle* particles;
};

// What the engine gives: passed by value to GetRefAPI, the same in API 5..8.
struct Imports {
    void (*error)(int level, const char* format, ...); // does not return
    void (*add_command)(const char* name, void (*function)());
    void (*remove_command)(const char* name);
    int (*argument_count)();
    const char* (*argument)(int index);
    void (*execute_text)(int when, const char* text);
    void (*print)(int level, const char* format, va_list arguments);
    int (*load_file)(const char* path, void** buffer_or_null); // size in bytes, -1: no such file
    void (*free_file)(void* buffer);
    const char* (*game_directory)(); // where files may be written
    Cvar* (*get_cvar)(const char* name, const char* default_text, int flags);
    Cvar* (*set_cvar)(const char* name, const char* text);
    void (*set_cvar_number)(const char* name, float number);
    QBoolean (*mode_info)(int* width, int* height, int mode);
    void (*init_video_menu)();
    void (*write_screenshot)(int width, int height, int bytes_per_pixel, const void* pixels); // 3 or 4, top row first
    QBoolean (*init_graphics)(int fullscreen, int* width, int* height);
    QBoolean (*desktop_mode)(int* width, int* height);
    void (*request_restart)(int kind);
};

// ---- what the module gives back
//
// GetRefAPI returns, by value, one int API number, one int (the SDL major version from API 7 on, padding before), and
// then function pointers, in this order: Init, Shutdown, PrepareForWindow, InitContext, GetDrawableSize (from API 6
// on), ShutdownContext, IsVSyncActive, BeginRegistration, RegisterModel, RegisterSkin, SetSky, EndRegistration,
// RenderFrame, DrawFindPic, DrawGetPicSize, DrawPicScaled, DrawStretchPic, DrawCharScaled, DrawTileClear, DrawFill,
// DrawFadeScreen, DrawStretchRaw (from API 6 on with one more argument), SetPalette, BeginFrame, EndFrame,
// EndWorldRenderpass and DrawPicScaledCol (from API 8 on). The engine reserved the bytes of its own version for it, no
// more.

// The whole of it as API 8 has it, for hosts that play the engine of 8.70.
struct Exports8 {
    int32_t api;
    int32_t framework;
    QBoolean (*init)();
    void (*shutdown)();
    int (*prepare_for_window)(); // flags of the SDL window, -1: failed
    int (*init_context)(void* sdl_window); // 1: done
    void (*get_drawable_size)(int* width, int* height);
    void (*shutdown_context)();
    QBoolean (*is_vsync_active)();
    void (*begin_registration)(const char* map); // "base1"
    void* (*register_model)(const char* name);
    void* (*register_skin)(const char* name);
    void (*set_sky)(const char* name, float rotate, const float* axis);
    void (*end_registration)();
    void (*render_frame)(const RefDef* refdef);
    void* (*draw_find_pic)(const char* name);
    void (*draw_get_pic_size)(int* width, int* height, const char* name);
    void (*draw_pic_scaled)(int x, int y, const char* name, float scale);
    void (*draw_stretch_pic)(int x, int y, int width, int height, const char* name);
    void (*draw_char_scaled)(int x, int y, int code, float scale);
    void (*draw_tile_clear)(int x, int y, int width, int height, const char* name);
    void (*draw_fill)(int x, int y, int width, int height, int palette_index);
    void (*draw_fade_screen)();
    void (*draw_stretch_raw)(
        int x, int y, int width, int height, int columns, int rows, const uint8_t* pixels, int bits);
    void (*set_palette)(const uint8_t* rgb);
    void (*begin_frame)(float camera_separation);
    void (*end_frame)();
    QBoolean (*end_world_renderpass)();
    void (*draw_pic_scaled_tinted)(int x, int y, const char* name, float scale, const float* rgb);
};

inline constexpr size_t export_header_bytes = 8;
// Number, Init and Shutdown: the part that lies at the same place in every version.
inline constexpr size_t export_common_bytes = 24;
inline constexpr size_t max_export_functions = 27;

// 0: not an API number we know.
constexpr size_t export_struct_bytes(int api)
{
    constexpr size_t base_functions = 25;
    const size_t functions = base_functions + (api >= 6 ? 1 : 0) + (api >= 8 ? 1 : 0);
    return api < 5 || api > 8 ? 0 : export_header_bytes + functions * sizeof(void*);
}

static_assert(sizeof(void*) == 8, "the layouts below are those of 64-bit systems");
static_assert(sizeof(Cvar) == 56 && offsetof(Cvar, flags) == 24 && offsetof(Cvar, number) == 32
    && offsetof(Cvar, default_text) == 48);
static_assert(sizeof(Entity) == 88 && offsetof(Entity, origin) == 20 && offsetof(Entity, previous_origin) == 36
    && offsetof(Entity, backlerp) == 52 && offsetof(Entity, alpha) == 64 && offsetof(Entity, skin) == 72
    && offsetof(Entity, flags) == 80);
static_assert(sizeof(DynamicLight) == 28 && sizeof(Particle) == 20 && sizeof(Lightstyle) == 16);
static_assert(sizeof(RefDef) == 136 && offsetof(RefDef, view_origin) == 24 && offsetof(RefDef, blend) == 48
    && offsetof(RefDef, flags) == 68 && offsetof(RefDef, area_bits) == 72 && offsetof(RefDef, entities) == 96
    && offsetof(RefDef, dlights) == 112 && offsetof(RefDef, particles) == 128);
static_assert(sizeof(Imports) == 19 * sizeof(void*));
static_assert(export_struct_bytes(5) == 208 && export_struct_bytes(6) == 216 && export_struct_bytes(7) == 216
    && export_struct_bytes(8) == sizeof(Exports8) && sizeof(Exports8) == 224 && export_struct_bytes(4) == 0
    && export_struct_bytes(9) == 0);

} // namespace vkpt::engine

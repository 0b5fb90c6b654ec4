// SPDX-License-Identifier: GPL-2.0-or-later
// What Quake II's server and a game library say to each other, as bytes: game interface version 3, which every Yamagi
// Quake II has. 64-bit little-endian systems. Facts of the interface under our own names.
// Spaces: Quake units, x east, y north, z up; angles in degrees (pitch, yaw, roll), positive pitch looks down.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vkpt::game {

inline constexpr int32_t game_api_version = 3;
inline constexpr int max_edicts = 1024; // the protocol's limit on entity numbers

// The engine's qboolean: an int whose upper bytes may be left undefined (see ref_vkpt/engine/contract.hpp).
using QBoolean = int32_t;
inline constexpr bool is_true(QBoolean value) { return (value & 0xff) != 0; }

// ---- what clients see

// EntityState::effects, those that we use
enum Effects : uint32_t {
    EF_ROCKET = 0x10, // trail and a dynamic light
    EF_GRENADE = 0x20, // trail of smoke while it moves
};

// EntityState::render_flags
enum RenderFlags : int32_t { RF_FULLBRIGHT = 0x8 };

struct EntityState {
    int32_t number;
    float origin[3];
    float angles[3];
    float old_origin[3]; // where clients begin to blend from when the entity is new to them
    int32_t model, model2, model3, model4; // indices of config strings
    int32_t frame;
    int32_t skin;
    uint32_t effects;
    int32_t render_flags;
    int32_t solid; // packed bounds, for prediction
    int32_t sound;
    int32_t event; // for one frame
};

enum MoveType : int32_t { PM_NORMAL, PM_SPECTATOR, PM_DEAD, PM_GIB, PM_FREEZE };

enum MoveFlags : uint8_t {
    PMF_DUCKED = 1,
    PMF_JUMP_HELD = 2,
    PMF_ON_GROUND = 4,
    PMF_NO_PREDICTION = 64, // the client shows what the server tells, blended
};

// In eighths of a unit.
struct MoveState {
    int32_t type; // MoveType
    int16_t origin[3];
    int16_t velocity[3];
    uint8_t flags; // MoveFlags
    uint8_t time;
    int16_t gravity;
    int16_t delta_angles[3]; // added to those of a command; 65536 is a full turn
};

struct PlayerState {
    MoveState move;
    float view_angles[3];
    float view_offset[3];
    float kick_angles[3];
    float gun_angles[3];
    float gun_offset[3];
    int32_t gun_model;
    int32_t gun_frame;
    float blend[4];
    float fov;
    int32_t view_flags;
    int16_t stats[32];
};

inline constexpr int stat_health = 1; // in PlayerState::stats

// ---- the head of each entity, which server and game share; the game's own fields follow

inline constexpr int max_entity_clusters = 16;

enum ServerFlags : int32_t {
    SVF_NOCLIENT = 1, // not sent
    SVF_DEADMONSTER = 2,
    SVF_MONSTER = 4,
};

enum Solid : int32_t { SOLID_NOT, SOLID_TRIGGER, SOLID_BBOX, SOLID_BSP };

// The head of a player's record; more follows.
struct Client {
    PlayerState state;
    int32_t ping;
};

struct AreaLink {
    AreaLink* previous;
    AreaLink* next;
};

struct Edict {
    EntityState state;
    Client* client; // players only
    QBoolean in_use;
    int32_t link_count;
    AreaLink area;
    int32_t cluster_count; // -1: `head_node` tells
    int32_t clusters[max_entity_clusters];
    int32_t head_node;
    int32_t area_number, area_number2;
    int32_t server_flags;
    float mins[3], maxs[3]; // relative to the origin
    float absolute_mins[3], absolute_maxs[3], size[3];
    int32_t solid; // Solid
    int32_t clip_mask;
    Edict* owner;
};

// ---- collision

enum Contents : int32_t {
    CONTENTS_SOLID = 0x1,
    CONTENTS_WINDOW = 0x2,
    CONTENTS_LAVA = 0x8,
    CONTENTS_SLIME = 0x10,
    CONTENTS_WATER = 0x20,
    CONTENTS_PLAYERCLIP = 0x10000,
    CONTENTS_MONSTER = 0x2000000,
    CONTENTS_LADDER = 0x20000000,
};
inline constexpr int32_t mask_solid = CONTENTS_SOLID | CONTENTS_WINDOW;
inline constexpr int32_t mask_player_solid = mask_solid | CONTENTS_PLAYERCLIP | CONTENTS_MONSTER;
inline constexpr int32_t mask_liquid = CONTENTS_LAVA | CONTENTS_SLIME | CONTENTS_WATER;

struct Plane {
    float normal[3];
    float dist;
    uint8_t type, sign_bits, padding[2];
};

struct Trace {
    QBoolean all_solid;
    QBoolean start_solid;
    float fraction; // of the way, 1: free
    float end[3];
    Plane plane;
    const void* surface;
    int32_t contents;
    Edict* entity;
};

// ---- commands

enum Buttons : uint8_t { BUTTON_ATTACK = 1, BUTTON_USE = 2, BUTTON_ANY = 128 };

// One client frame's input.
struct UserCommand {
    uint8_t milliseconds;
    uint8_t buttons; // Buttons
    int16_t angles[3]; // 65536 is a full turn
    int16_t forward, side, up; // units a second
    uint8_t impulse;
    uint8_t light_level;
};

enum CvarFlags : int32_t { CVAR_NONE = 0, CVAR_NOSET = 8, CVAR_LATCH = 16 };

// Owned by the engine, which replaces `text` on every change.
struct Cvar {
    char* name;
    char* text;
    char* latched_text;
    int32_t flags;
    QBoolean modified;
    float number;
    Cvar* next;
};

enum PrintLevel : int32_t { PRINT_HIGH = 2 };

// Where a message goes: to clients that see or hear the place.
enum Multicast : int32_t { MULTICAST_ALL, MULTICAST_PHS, MULTICAST_PVS };

// First byte of a message from the server.
enum ServerMessage : int32_t { svc_temp_entity = 3, svc_stuff_text = 11 };

// Second byte of svc_temp_entity.
enum TemporaryEntity : int32_t { TE_SPARKS = 9, TE_WELDING_SPARKS = 25, TE_CHAINFIST_SMOKE = 45 };

// Functions of the server. `error` does not return: it jumps out of the game, past destructors.
struct Imports {
    void (*broadcast_print)(int level, const char* format, ...);
    void (*debug_print)(const char* format, ...); // to the server's console
    void (*client_print)(const Edict* entity, int level, const char* format, ...); // nullptr: to the console
    void (*center_print)(const Edict* entity, const char* format, ...);
    void (*sound)(const Edict*, int channel, int sound, float volume, float attenuation, float delay);
    void (*positioned_sound)(
        const float* origin, const Edict*, int channel, int sound, float volume, float attenuation, float delay);
    void (*config_string)(int number, const char* text);
    void (*error)(const char* format, ...);
    int (*model_index)(const char* name);
    int (*sound_index)(const char* name);
    int (*image_index)(const char* name);
    void (*set_model)(Edict*, const char* name);
    Trace (*trace)(const float* start, const float* mins, const float* maxs, const float* end, const Edict* ignored,
        int contents_mask);
    int (*point_contents)(const float* point);
    QBoolean (*in_pvs)(const float* a, const float* b);
    QBoolean (*in_phs)(const float* a, const float* b);
    void (*set_area_portal_state)(int portal, QBoolean open);
    QBoolean (*areas_connected)(int a, int b);
    void (*link_entity)(Edict*);
    void (*unlink_entity)(Edict*);
    int (*box_edicts)(const float* mins, const float* maxs, Edict** list, int most, int area_type);
    void (*player_move)(void* move);
    void (*multicast)(const float* origin, int to); // sends what the write functions have gathered
    void (*unicast)(const Edict*, QBoolean reliable);
    void (*write_char)(int);
    void (*write_byte)(int);
    void (*write_short)(int);
    void (*write_long)(int);
    void (*write_float)(float);
    void (*write_string)(const char*);
    void (*write_position)(const float*);
    void (*write_direction)(const float*);
    void (*write_angle)(float);
    void* (*tag_malloc)(int size, int tag);
    void (*tag_free)(void*);
    void (*free_tags)(int tag);
    Cvar* (*cvar)(const char* name, const char* value, int flags);
    Cvar* (*cvar_set)(const char* name, const char* value);
    Cvar* (*cvar_force_set)(const char* name, const char* value);
    int (*argument_count)();
    char* (*argument)(int number);
    char* (*arguments)(); // all but the first, as one text
    void (*add_command)(const char* text);
    void (*debug_graph)(float value, int colour);
};

// What a game library's GetGameAPI(Imports*) returns a pointer to. The server reads the last four fields after every
// call.
struct Exports {
    int32_t api_version;
    void (*init)();
    void (*shutdown)();
    void (*spawn_entities)(const char* map, char* entity_text, const char* spawn_point);
    void (*write_game)(const char* file, QBoolean is_autosave);
    void (*read_game)(const char* file);
    void (*write_level)(const char* file);
    void (*read_level)(const char* file); // after spawn_entities for the same map
    QBoolean (*client_connect)(Edict*, char* user_info);
    void (*client_begin)(Edict*);
    void (*client_user_info_changed)(Edict*, char* user_info);
    void (*client_disconnect)(Edict*);
    void (*client_command)(Edict*);
    void (*client_think)(Edict*, UserCommand*);
    void (*run_frame)(); // a tenth of a second
    void (*server_command)(); // "sv WORD ..." on the server's console
    Edict* edicts; // edict_size bytes apart
    int32_t edict_size;
    int32_t edict_count; // all in use have lower numbers
    int32_t max_edicts;
};

using GetGameApi = Exports* (*)(Imports*);

static_assert(sizeof(EntityState) == 84 && sizeof(MoveState) == 28 && sizeof(PlayerState) == 184);
static_assert(offsetof(Edict, client) == 88 && offsetof(Edict, area) == 104 && offsetof(Edict, server_flags) == 200);
static_assert(offsetof(Edict, owner) == 272 && sizeof(Edict) == 280);
static_assert(sizeof(Trace) == 72 && sizeof(UserCommand) == 16 && sizeof(Cvar) == 48);
static_assert(sizeof(Imports) == 44 * sizeof(void*) && offsetof(Exports, edicts) == 128 && sizeof(Exports) == 152);

} // namespace vkpt::game

// SPDX-License-Identifier: GPL-2.0-or-later
// A game library for tests that hands every call to another one and notes what happens. Names come from the
// environment:
//   VKPT_PROBE_OUTSIDE   the library to load, for the copy that the engine loads
//   VKPT_PROBE_INSIDE    the same for the copy that our module loads (its file is called inside.so)
//   VKPT_PROBE_STATES    outside: a line per server frame is added to this file: a hash of all that the server sees of
//                        the entities, their number, and the first player's place and health
//   VKPT_PROBE_OWN       outside: a line per server frame and entity of our module is added to this file: the frame,
//                        the slot, the place, model, skin and render flags
//   VKPT_PROBE_CALLS     inside: every call is added to this file. outside, with VKPT_PROBE_REPLAY=1: the calls about
//                        players in this file are made again, in the same order between the server's own calls
//   VKPT_PROBE_SCRIPT    outside: lines "FRAME COMMAND" for the server's console, and "FRAME player ADDRESS COMMAND",
//                        by a player who is connected from there; what he is told is printed as "to ADDRESS: ..."
//   VKPT_PROBE_NO_MODELS=1   model numbers are left out of the hash
// A library is loaded anew with each saved game: so files are appended to, and what has to outlast it is in the
// environment.
#include "game/contract.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

using namespace vkpt::game;

namespace {

enum class Call : int32_t {
    init,
    shutdown,
    spawn_entities,
    write_game,
    read_game,
    write_level,
    read_level,
    run_frame,
    server_command,
    // about players:
    client_connect,
    client_begin,
    client_user_info_changed,
    client_disconnect,
    client_command,
    client_think,
};
constexpr Call first_player_call = Call::client_connect;

struct Record {
    Call call;
    int32_t edict = 0;
    UserCommand command {};
    std::array<char, 512> user_info {}; // or a command's word
};

constexpr int hashed_edicts = 700; // those of our module have higher numbers

std::string variable(const char* name)
{
    const char* value = std::getenv(name);
    return value ? value : "";
}

struct Probe {
    bool is_inside = false;
    bool replays = false, no_models = false;
    Imports engine {}, for_game {};
    Exports* game = nullptr;
    Exports table {};
    std::ofstream states, own, calls;
    std::ifstream recorded;
    std::vector<std::pair<long, std::string>> script;
    char* typed = nullptr; // a player's command that is repeated
    std::vector<std::string> words; // of a scripted player's command
    std::string address; // of the scripted player
};
Probe* probe = nullptr;

Edict* edict_of(int number)
{
    return reinterpret_cast<Edict*>(
        reinterpret_cast<char*>(probe->game->edicts) + size_t(number) * size_t(probe->game->edict_size));
}
int number_of(const Edict* edict)
{
    return edict ? int((reinterpret_cast<const char*>(edict) - reinterpret_cast<const char*>(probe->game->edicts))
               / probe->game->edict_size)
                 : -1;
}

// ---- hashing

struct Hash {
    uint64_t value = 14695981039346656037u;
    void add(const void* data, size_t size)
    {
        for (size_t i = 0; i < size; i++)
            value = (value ^ static_cast<const unsigned char*>(data)[i]) * 1099511628211u;
    }
    template <typename T> void add(const T& field) { add(&field, sizeof field); }
};

void add_player(Hash& hash, PlayerState state)
{
    if (probe->no_models)
        state.gun_model = 0;
    constexpr size_t move_bytes = offsetof(MoveState, delta_angles) + sizeof state.move.delta_angles;
    hash.add(&state.move, move_bytes);
    hash.add(&state.view_angles, sizeof state - offsetof(PlayerState, view_angles));
}

void add_edict(Hash& hash, const Edict& edict)
{
    EntityState state = edict.state;
    if (probe->no_models)
        state.model = state.model2 = state.model3 = state.model4 = 0;
    hash.add(state);
    hash.add(edict.cluster_count);
    for (int i = 0; i < edict.cluster_count; i++)
        hash.add(edict.clusters[i]);
    hash.add(edict.area_number);
    hash.add(edict.area_number2);
    hash.add(edict.server_flags);
    hash.add(&edict.mins, sizeof(float) * 15);
    hash.add(edict.solid);
    hash.add(edict.clip_mask);
    hash.add(number_of(edict.owner));
    if (edict.client)
        add_player(hash, edict.client->state);
}

void note_state()
{
    if (!probe->states.is_open())
        return;
    Hash hash;
    int count = 0;
    // As the server looks: through the table that it was given.
    for (int number = 0; number < std::min(probe->table.edict_count, hashed_edicts); number++) {
        const Edict& edict = *edict_of(number);
        if (!is_true(edict.in_use))
            continue;
        hash.add(number);
        add_edict(hash, edict);
        count++;
    }
    int own = 0;
    for (int number = hashed_edicts; number < probe->table.edict_count; number++)
        own += is_true(edict_of(number)->in_use);
    const Edict& player = *edict_of(1);
    char line[200];
    std::snprintf(line, sizeof line, "%016llx %d %.3f %.3f %.3f %d %d\n", static_cast<unsigned long long>(hash.value),
        count, double(player.state.origin[0]), double(player.state.origin[1]), double(player.state.origin[2]),
        player.client && is_true(player.in_use) ? player.client->state.stats[stat_health] : -999, own);
    probe->states << line << std::flush;
}

void note_own_entities(long frame)
{
    if (!probe->own.is_open())
        return;
    for (int number = hashed_edicts; number < probe->table.edict_count; number++) {
        const Edict& edict = *edict_of(number);
        if (!is_true(edict.in_use))
            continue;
        const EntityState& state = edict.state;
        probe->own << frame << ' ' << number << ' ' << state.origin[0] << ' ' << state.origin[1] << ' '
                   << state.origin[2] << ' ' << state.model << ' ' << state.skin << ' ' << state.render_flags << '\n';
    }
    probe->own.flush();
}

// ---- calls

void copy_table()
{
    probe->table.edicts = probe->game->edicts;
    probe->table.edict_size = probe->game->edict_size;
    probe->table.edict_count = probe->game->edict_count;
    probe->table.max_edicts = probe->game->max_edicts;
}

void note_call(Record record)
{
    if (probe->is_inside && probe->calls.is_open())
        probe->calls.write(reinterpret_cast<const char*>(&record), sizeof record) << std::flush;
}

void repeat(Record& record)
{
    Edict* edict = edict_of(record.edict);
    switch (record.call) {
    case Call::client_connect:
        edict->state.number = record.edict;
        probe->game->client_connect(edict, record.user_info.data());
        break;
    case Call::client_begin:
        probe->game->client_begin(edict);
        break;
    case Call::client_disconnect:
        probe->game->client_disconnect(edict);
        break;
    case Call::client_command:
        probe->typed = record.user_info.data();
        probe->game->client_command(edict);
        probe->typed = nullptr;
        break;
    case Call::client_think:
        probe->game->client_think(edict, &record.command);
        break;
    default:
        std::fprintf(stderr, "probe: a call that is not repeated: %d\n", int(record.call));
        std::abort();
    }
}

// The recorded calls about players that came before this one of the server's.
void catch_up(Call call)
{
    if (!probe->replays)
        return;
    Record record {};
    while (probe->recorded.read(reinterpret_cast<char*>(&record), sizeof record)) {
        setenv("VKPT_PROBE_POSITION", std::to_string(probe->recorded.tellg()).c_str(), 1);
        if (record.call >= first_player_call) {
            repeat(record);
            continue;
        }
        if (record.call != call) {
            std::fprintf(stderr, "probe: the server calls %d where it called %d\n", int(call), int(record.call));
            std::abort();
        }
        return;
    }
}

template <auto member, Call call, typename... Arguments> void pass(Arguments... arguments)
{
    catch_up(call);
    note_call({ call });
    (probe->game->*member)(arguments...);
    copy_table();
}

QBoolean client_connect(Edict* edict, char* user_info)
{
    Record record { Call::client_connect, number_of(edict) };
    std::strncpy(record.user_info.data(), user_info, record.user_info.size() - 1);
    note_call(record);
    const QBoolean result = probe->game->client_connect(edict, user_info);
    copy_table();
    return result;
}

template <auto member, Call call> void pass_player(Edict* edict)
{
    note_call({ call, number_of(edict) });
    (probe->game->*member)(edict);
    copy_table();
}

void client_command(Edict* edict)
{
    Record record { Call::client_command, number_of(edict) };
    std::strncpy(record.user_info.data(), probe->engine.argument(0), record.user_info.size() - 1);
    note_call(record);
    probe->game->client_command(edict);
    copy_table();
}

void client_user_info_changed(Edict* edict, char* user_info)
{
    probe->game->client_user_info_changed(edict, user_info);
    copy_table();
}

void client_think(Edict* edict, UserCommand* command)
{
    note_call({ Call::client_think, number_of(edict), *command });
    probe->game->client_think(edict, command);
    copy_table();
}

// ---- a scripted player

bool is_scripted_player(const std::string& command) { return command.starts_with("player "); }

void type_as_player(const std::string& command)
{
    const int number = int(probe->engine.cvar("maxclients", "1", 0)->number); // the last to be taken
    std::istringstream text(command);
    std::string address, word;
    text >> word >> address;
    Edict* edict = edict_of(number);
    if (probe->address.empty()) {
        probe->address = address;
        edict->state.number = number;
        std::string user_info = "\\name\\scripted\\skin\\male/grunt\\ip\\" + address;
        user_info.resize(512);
        probe->game->client_connect(edict, user_info.data());
        probe->game->client_begin(edict);
    }
    probe->words.clear();
    while (text >> word)
        probe->words.push_back(word);
    probe->game->client_command(edict);
    probe->words.clear();
    copy_table();
}

void run_frame()
{
    pass<&Exports::run_frame, Call::run_frame>();
    if (probe->is_inside)
        return;
    note_state();
    const long frame = std::atol(variable("VKPT_PROBE_FRAME").c_str()) + 1;
    note_own_entities(frame);
    setenv("VKPT_PROBE_FRAME", std::to_string(frame).c_str(), 1);
    // What is typed while a level is changed waits for a player of the server's: the end is asked for again and again.
    constexpr long again = 20;
    for (const auto& [at, command] : probe->script)
        if (at == frame || (command == "quit" && frame > at && (frame - at) % again == 0)) {
            if (is_scripted_player(command))
                type_as_player(command);
            else
                probe->engine.add_command((command + "\n").c_str());
        }
}

// ---- what the game may not say to players that the server has no connection for: there are no others

void drop_client_print(const Edict* edict, int level, const char* format, ...)
{
    if (edict && probe->address.empty())
        return;
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (edict)
        probe->engine.client_print(nullptr, level, "to %s: %s", probe->address.c_str(), text);
    else
        probe->engine.client_print(nullptr, level, "%s", text);
}
void drop_centre_print(const Edict*, const char*, ...) { }
void drop_unicast(const Edict*, QBoolean)
{
    const float outside[3] = { 65536, 65536, 65536 };
    probe->engine.multicast(outside, MULTICAST_PVS);
}

int argument_count()
{
    return probe->typed ? 1 : !probe->words.empty() ? int(probe->words.size()) : probe->engine.argument_count();
}
char* argument(int number)
{
    static char none[] = "";
    if (!probe->words.empty())
        return size_t(number) < probe->words.size() ? probe->words[size_t(number)].data() : none;
    return !probe->typed ? probe->engine.argument(number) : number == 0 ? probe->typed : none;
}

void open_files()
{
    if (!probe->is_inside) {
        if (!variable("VKPT_PROBE_STATES").empty())
            probe->states.open(variable("VKPT_PROBE_STATES"), std::ios::app);
        if (!variable("VKPT_PROBE_OWN").empty())
            probe->own.open(variable("VKPT_PROBE_OWN"), std::ios::app);
        std::ifstream script(variable("VKPT_PROBE_SCRIPT"));
        for (std::string line; std::getline(script, line);) {
            std::istringstream words(line);
            long frame = 0;
            std::string command;
            if (words >> frame && std::getline(words >> std::ws, command))
                probe->script.emplace_back(frame, command);
        }
    }
    if (probe->replays) {
        probe->recorded.open(variable("VKPT_PROBE_CALLS"), std::ios::binary);
        probe->recorded.seekg(std::atoll(variable("VKPT_PROBE_POSITION").c_str()));
    } else if (probe->is_inside) {
        probe->calls.open(variable("VKPT_PROBE_CALLS"), std::ios::binary | std::ios::app);
    }
}

} // namespace

extern "C" __attribute__((visibility("default"))) void* GetGameAPI(Imports* imports)
{
    delete probe;
    probe = new Probe;
    Dl_info self {};
    dladdr(reinterpret_cast<const void*>(&GetGameAPI), &self);
    probe->is_inside = std::string(self.dli_fname).ends_with("inside.so");
    probe->replays = !probe->is_inside && variable("VKPT_PROBE_REPLAY") == "1";
    probe->no_models = variable("VKPT_PROBE_NO_MODELS") == "1";
    probe->engine = probe->for_game = *imports;
    open_files();
    if (probe->replays
        || std::ranges::any_of(probe->script, is_scripted_player, &std::pair<long, std::string>::second)) {
        probe->for_game.client_print = drop_client_print;
        probe->for_game.center_print = drop_centre_print;
        probe->for_game.unicast = drop_unicast;
        probe->for_game.argument_count = argument_count;
        probe->for_game.argument = argument;
    }
    const std::string path = variable(probe->is_inside ? "VKPT_PROBE_INSIDE" : "VKPT_PROBE_OUTSIDE");
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto get_api = library ? reinterpret_cast<GetGameApi>(dlsym(library, "GetGameAPI")) : nullptr;
    if (!get_api) {
        std::fprintf(stderr, "probe: cannot load '%s': %s\n", path.c_str(), dlerror());
        return nullptr;
    }
    probe->game = get_api(&probe->for_game);
    if (!probe->game)
        return nullptr;
    Exports& table = probe->table;
    table.api_version = probe->game->api_version;
    table.init = pass<&Exports::init, Call::init>;
    table.shutdown = pass<&Exports::shutdown, Call::shutdown>;
    table.spawn_entities = pass<&Exports::spawn_entities, Call::spawn_entities, const char*, char*, const char*>;
    table.write_game = pass<&Exports::write_game, Call::write_game, const char*, QBoolean>;
    table.read_game = pass<&Exports::read_game, Call::read_game, const char*>;
    table.write_level = pass<&Exports::write_level, Call::write_level, const char*>;
    table.read_level = pass<&Exports::read_level, Call::read_level, const char*>;
    table.client_connect = client_connect;
    table.client_begin = pass_player<&Exports::client_begin, Call::client_begin>;
    table.client_user_info_changed = client_user_info_changed;
    table.client_disconnect = pass_player<&Exports::client_disconnect, Call::client_disconnect>;
    table.client_command = client_command;
    table.client_think = client_think;
    table.run_frame = run_frame;
    table.server_command = pass<&Exports::server_command, Call::server_command>;
    copy_table();
    return &table;
}

// SPDX-License-Identifier: GPL-2.0-or-later
// A mod for tests: the stock game with a server command of its own. With VKPT_INCOMPLETE it lacks a function of the
// interface, as a game that cannot be wrapped.
#include "game/contract.hpp"

#include <cstring>
#include <dlfcn.h>
#include <filesystem>

using namespace vkpt::game;

namespace {

Imports engine;
Exports* stock = nullptr;
Exports table;

void copy_entities()
{
    table.edicts = stock->edicts;
    table.edict_size = stock->edict_size;
    table.edict_count = stock->edict_count;
    table.max_edicts = stock->max_edicts;
}

template <auto member, typename... Arguments> auto hand_on(Arguments... arguments)
{
    if constexpr (std::is_void_v<decltype((stock->*member)(arguments...))>) {
        (stock->*member)(arguments...);
        copy_entities();
    } else {
        const auto result = (stock->*member)(arguments...);
        copy_entities();
        return result;
    }
}

[[maybe_unused]] void run_command()
{
    if (std::strcmp(engine.argument(1), "stand_in") == 0)
        engine.debug_print("stand-in: %d entities\n", stock->edict_count);
    else
        hand_on<&Exports::server_command>();
}

} // namespace

extern "C" __attribute__((visibility("default"))) void* GetGameAPI(Imports* imports)
{
    engine = *imports;
    const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    void* library = dlopen((folder / "baseq2/game.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto get_api = library ? reinterpret_cast<GetGameApi>(dlsym(library, "GetGameAPI")) : nullptr;
    stock = get_api ? get_api(imports) : nullptr;
    if (!stock)
        return nullptr;
    table.api_version = stock->api_version;
    table.init = hand_on<&Exports::init>;
    table.shutdown = hand_on<&Exports::shutdown>;
    table.spawn_entities = hand_on<&Exports::spawn_entities, const char*, char*, const char*>;
    table.write_game = hand_on<&Exports::write_game, const char*, QBoolean>;
    table.read_game = hand_on<&Exports::read_game, const char*>;
    table.write_level = hand_on<&Exports::write_level, const char*>;
    table.read_level = hand_on<&Exports::read_level, const char*>;
    table.client_connect = hand_on<&Exports::client_connect, Edict*, char*>;
    table.client_begin = hand_on<&Exports::client_begin, Edict*>;
    table.client_user_info_changed = hand_on<&Exports::client_user_info_changed, Edict*, char*>;
    table.client_disconnect = hand_on<&Exports::client_disconnect, Edict*>;
    table.client_command = hand_on<&Exports::client_command, Edict*>;
    table.client_think = hand_on<&Exports::client_think, Edict*, UserCommand*>;
    table.run_frame = hand_on<&Exports::run_frame>;
#ifndef VKPT_INCOMPLETE
    table.server_command = run_command;
#endif
    copy_entities();
    return &table;
}

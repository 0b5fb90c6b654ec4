// SPDX-License-Identifier: GPL-2.0-or-later
// The door: GetGameAPI, the table that the server gets, and the one that the game gets.
#include "game/library.hpp"
#include "game/module.hpp"

#include <cstdarg>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <utility>

namespace vkpt::game {

namespace {

std::unique_ptr<Module> module;

// ---- what the server calls

// A call that is handed on as it is.
template <auto member, typename... Arguments> void hand_on(Arguments... arguments)
{
    module->enter();
    (module->host().game->*member)(arguments...);
    module->leave();
}

// A call that the module has something to do with.
template <auto member, typename... Arguments> auto treat(Arguments... arguments)
{
    module->enter();
    if constexpr (std::is_void_v<decltype((module.get()->*member)(arguments...))>) {
        (module.get()->*member)(arguments...);
        module->leave();
    } else {
        const auto result = (module.get()->*member)(arguments...);
        module->leave();
        return result;
    }
}

void fill_exports(Exports& table)
{
    table.api_version = game_api_version;
    table.init = treat<&Module::init>;
    table.shutdown = treat<&Module::shutdown>;
    table.spawn_entities = treat<&Module::spawn_entities, const char*, char*, const char*>;
    table.write_game = hand_on<&Exports::write_game, const char*, QBoolean>;
    table.read_game = hand_on<&Exports::read_game, const char*>;
    table.write_level = treat<&Module::write_level, const char*>;
    table.read_level = treat<&Module::read_level, const char*>;
    table.client_connect = treat<&Module::client_connect, Edict*, char*>;
    table.client_begin = treat<&Module::client_begin, Edict*>;
    table.client_user_info_changed = hand_on<&Exports::client_user_info_changed, Edict*, char*>;
    table.client_disconnect = treat<&Module::client_disconnect, Edict*>;
    table.client_command = treat<&Module::client_command, Edict*>;
    table.client_think = treat<&Module::client_think, Edict*, UserCommand*>;
    table.run_frame = treat<&Module::run_frame>;
    table.server_command = treat<&Module::server_command>;
}

// ---- what the game calls

constexpr size_t longest_print = 1024; // the server's own limit

void print_to_client(const Edict* client, int level, const char* format, ...)
{
    if (module->fake_client().is_fake(client))
        return;
    char text[longest_print];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    module->host().engine.client_print(client, level, "%s", text);
}

void print_in_centre(const Edict* client, const char* format, ...)
{
    if (module->fake_client().is_fake(client))
        return;
    char text[longest_print];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    module->host().engine.center_print(client, "%s", text);
}

void unicast(const Edict* client, QBoolean reliable)
{
    if (module->fake_client().is_fake(client))
        module->fake_client().drop_message();
    else
        module->host().engine.unicast(client, reliable);
}

int argument_count() { return module->fake_client().typed_word() ? 1 : module->host().engine.argument_count(); }

char* argument(int number)
{
    static char none[] = "";
    const char* typed = module->fake_client().typed_word();
    if (!typed)
        return module->host().engine.argument(number);
    return number == 0 ? const_cast<char*>(typed) : none; // games only read it
}

char* arguments()
{
    static char none[] = "";
    return module->fake_client().typed_word() ? none : module->host().engine.arguments();
}

Imports make_imports_for_game(Imports table)
{
    table.client_print = print_to_client;
    table.center_print = print_in_centre;
    table.unicast = unicast;
    table.argument_count = argument_count;
    table.argument = argument;
    table.arguments = arguments;
    return table;
}

// ---- loading

void say(const Imports& engine, const std::string& text) { engine.debug_print("vkpt: %s\n", text.c_str()); }

std::optional<GameLibrary> load_named(const Imports& engine, Imports& for_game)
{
    const std::string name = engine.cvar("vkpt_game_library", "", CVAR_NOSET)->text;
    if (name.empty())
        return std::nullopt;
    std::string reason;
    const auto path = resolve_library_name(name, find_engine_folder(), read_command_line(), reason);
    std::optional<GameLibrary> library;
    if (path)
        library = GameLibrary::load(*path, for_game, reason);
    if (!library)
        say(engine, fmt::format("vkpt_game_library: {}. The stock game is played instead.", reason));
    return library;
}

std::optional<GameLibrary> load_stock(const Imports& engine, Imports& for_game)
{
    std::string reasons;
    for (const std::filesystem::path& path : list_stock_libraries(find_engine_folder())) {
        std::string reason;
        if (auto library = GameLibrary::load(path, for_game, reason))
            return library;
        reasons += "\n  " + reason;
    }
    say(engine,
        "no game library to play with; name one: +set vkpt_game_library PATH, or a mod's folder beside the engine."
            + reasons);
    return std::nullopt;
}

// Whether the table and the entities are such as we can work with.
bool is_wrappable(const Exports& game, std::string& reason)
{
    if (game.edict_size < int(sizeof(Edict)) || game.edict_size % int(alignof(Edict)) != 0) {
        reason = fmt::format(
            "its entities are {} bytes long; at least {} are shared with the server", game.edict_size, sizeof(Edict));
        return false;
    }
    if (!game.init || !game.shutdown || !game.spawn_entities || !game.write_level || !game.read_level
        || !game.client_connect || !game.client_begin || !game.client_disconnect || !game.client_command
        || !game.client_think || !game.run_frame || !game.server_command) {
        reason = "it lacks functions of the interface";
        return false;
    }
    return true;
}

} // namespace

Exports* start(const Imports& engine)
{
    module.reset();
    module = std::make_unique<Module>(engine, make_imports_for_game(engine));
    std::optional<GameLibrary> library = load_named(engine, *module->imports_for_game());
    if (!library)
        library = load_stock(engine, *module->imports_for_game());
    if (!library)
        return nullptr;
    Exports* game = library->exports();
    std::string reason;
    const bool wrappable = is_wrappable(*game, reason);
    const std::string path = library->path().string();
    module->wrap(std::move(*library));
    if (!wrappable) {
        say(engine, fmt::format("{} is played as it is, without lights, flares and walks: {}", path, reason));
        return game;
    }
    say(engine, fmt::format("around the game of {}", path));
    fill_exports(*module->exports());
    module->leave();
    return module->exports();
}

} // namespace vkpt::game

extern "C" {

// By this name the module knows itself.
__attribute__((visibility("default"))) extern const int vkpt_game_module;
const int vkpt_game_module = 1;

__attribute__((visibility("default"))) void* GetGameAPI(vkpt::game::Imports* imports)
{
    return vkpt::game::start(*imports);
}
}

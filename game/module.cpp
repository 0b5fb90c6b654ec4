// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/module.hpp"

#include "game/commands.hpp"

#include <algorithm>
#include <exception>
#include <fmt/format.h>
#include <utility>

namespace vkpt::game {

namespace {

constexpr int max_clients = 256;
constexpr int start_frame = 20; // of a level: its things have settled, and players are there

// Of a "\key\value\key\value" text.
std::string_view find_value(std::string_view user_info, std::string_view key)
{
    size_t at = 0;
    while (at < user_info.size() && user_info[at] == '\\') {
        const size_t key_end = user_info.find('\\', at + 1);
        if (key_end == std::string_view::npos)
            break;
        const size_t value_end = std::min(user_info.find('\\', key_end + 1), user_info.size());
        if (user_info.substr(at + 1, key_end - at - 1) == key)
            return user_info.substr(key_end + 1, value_end - key_end - 1);
        at = value_end;
    }
    return {};
}

} // namespace

Module::Module(const Imports& imports, const Imports& for_game)
    : for_game_(for_game)
    , fake_client_(host_)
    , lights_(host_)
    , walker_(host_, fake_client_)
    , flares_(host_)
    , stress_(host_)
    , is_client_(max_clients + 1)
    , is_local_(max_clients + 1)
{
    host_.engine = imports;
}

void Module::wrap(GameLibrary library)
{
    library_ = std::move(library);
    host_.game = library_.exports();
}

void Module::enter()
{
    walker_.hide_view();
    if (std::exchange(was_frame_, false)) // its message is sent
        host_.entities.begin_frame();
    host_.entities.hide(*host_.game);
}

void Module::leave()
{
    const Exports& game = *host_.game;
    exports_.edict_size = game.edict_size;
    exports_.edicts = game.edicts;
    exports_.max_edicts = game.max_edicts;
    exports_.edict_count = game.edict_count;
    if (!is_running_) // the entities' memory may be gone
        return;
    exports_.edict_count = host_.entities.show(game, host_.engine);
    walker_.show_view();
}

void Module::init()
{
    // Ours are numbered from the highest number that the protocol has; the game is to have as many as ever below.
    if (host_.cvar_number("maxentities", "1024") < max_edicts)
        host_.engine.cvar_force_set("maxentities", std::to_string(max_edicts).c_str());
    const std::string game = host_.engine.cvar("game", "", 0)->text;
    if (const auto folder = find_write_folder(read_surroundings(), game))
        host_.write_folder = *folder;
    else
        host_.say(
            nullptr, "vkpt: the engine's writable folder was not found: lights and walks cannot be saved or loaded");
    host_.game->init();
    is_running_ = true;
}

void Module::shutdown()
{
    is_running_ = false;
    host_.entities.clear();
    host_.game->shutdown();
}

void Module::spawn_entities(const char* map, char* entity_text, const char* spawn_point)
{
    host_.entities.clear();
    host_.replies.forget(nullptr);
    host_.frame = 0;
    host_.map = map;
    is_full_ = false;
    host_.game->spawn_entities(map, entity_text, spawn_point);
    lights_.begin_level();
    walker_.begin_level(entity_text);
    flares_.begin_level();
    stress_.begin_level();
}

void Module::write_level(const char* file)
{
    host_.game->write_level(file);
    lights_.write_level(file);
}

void Module::read_level(const char* file)
{
    host_.game->read_level(file);
    lights_.read_level(file);
}

QBoolean Module::client_connect(Edict* client, char* user_info)
{
    if (fake_client_.is_fake(client))
        fake_client_.disconnect();
    const size_t number = size_t(host_.number_of(client));
    // The server sets the key itself; only here: later changes of the text are the client's word.
    const bool is_local = find_value(user_info, "ip") == "loopback";
    const QBoolean result = host_.game->client_connect(client, user_info);
    is_client_[number] = is_true(result);
    is_local_[number] = is_true(result) && is_local;
    return result;
}

void Module::client_begin(Edict* client) { host_.game->client_begin(client); }

void Module::client_disconnect(Edict* client)
{
    is_client_[size_t(host_.number_of(client))] = is_local_[size_t(host_.number_of(client))] = false;
    host_.replies.forget(client);
    host_.game->client_disconnect(client);
}

void Module::client_command(Edict* client)
{
    if (!run_command(client, 0))
        host_.game->client_command(client);
}

void Module::server_command()
{
    if (!run_command(nullptr, 1))
        host_.game->server_command();
}

void Module::client_think(Edict* client, UserCommand* command)
{
    if (walker_.swallows(client))
        return;
    host_.game->client_think(client, command);
    walker_.record_input(client, *command);
}

void Module::run_frame()
{
    was_frame_ = true;
    host_.frame++;
    host_.replies.begin_frame(host_.engine);
    run_start_commands();
    walker_.drive();
    host_.game->run_frame();
    lights_.update(first_player());
    flares_.update();
    stress_.update();
    report_full_array();
}

void Module::report_full_array()
{
    const bool is_full = host_.entities.without_slot() > 0;
    if (is_full && !is_full_)
        host_.say(nullptr,
            fmt::format("vkpt: the game uses {} of {} entities: {} of the lights, flares and emitters are not shown "
                        "until it frees some",
                host_.game->edict_count, host_.game->max_edicts, host_.entities.without_slot()));
    is_full_ = is_full;
}

bool Module::is_operator(const Edict* client) const
{
    if (!client || is_local_[size_t(host_.number_of(client))])
        return true;
    // The one player of a game of one sits here, unless the server has no screen.
    return host_.client_count() == 1 && host_.cvar_number("dedicated", "0") == 0;
}

Edict* Module::first_player() const
{
    if (Edict* fake = fake_client_.edict())
        return fake;
    for (int number = 1; number <= host_.client_count(); number++)
        if (is_client_[size_t(number)] && is_true(host_.edict(number)->in_use) && host_.edict(number)->client)
            return host_.edict(number);
    return nullptr;
}

// Commands of ours that a level begins with: of the variable vkpt_start, parted by commas. A server without players has
// no other moment for them.
void Module::run_start_commands()
{
    if (host_.frame != start_frame)
        return;
    try {
        std::string text = host_.engine.cvar("vkpt_start", "", 0)->text;
        text += ',';
        for (size_t at = 0, end = 0; (end = text.find(',', at)) != std::string::npos; at = end + 1) {
            std::vector<std::string> words = split_words(text.substr(at, end - at));
            if (words.empty())
                continue;
            const CommandHandler handler = find_command(words[0]);
            if (!handler)
                throw TextError(fmt::format("vkpt_start: '{}' is none of this module's commands", words[0]));
            words.erase(words.begin());
            handler(*this, { std::move(words), nullptr, first_player() });
        }
    } catch (const std::exception& error) {
        host_.say(nullptr, fmt::format("vkpt: {}", error.what()));
    }
}

bool Module::run_command(Edict* sender, int first_word)
{
    const Imports& engine = host_.engine;
    if (engine.argument_count() <= first_word)
        return false;
    const CommandHandler handler = find_command(engine.argument(first_word));
    if (!handler)
        return false;
    if (!is_operator(sender)) {
        host_.say(sender, "vkpt: only the player at the server's machine, or its console, may do that");
        return true;
    }
    try {
        Command command;
        for (int i = first_word + 1; i < engine.argument_count(); i++)
            command.words.emplace_back(engine.argument(i));
        command.sender = sender;
        command.player = sender ? sender : first_player();
        handler(*this, command);
    } catch (const std::exception& error) {
        host_.say(sender, fmt::format("vkpt: {}", error.what()));
    }
    return true;
}

} // namespace vkpt::game

// SPDX-License-Identifier: GPL-2.0-or-later
// The module: every call of the server's is handed to the real game, with what we add before and after it.
//
// The engine and the game leave calls by jumping out of them (Imports::error). So what stands between the server's call
// and the game's owns nothing that has to be cleaned up, and the state in between is one that the next call can start
// from: our entities hidden.
#pragma once

#include "game/fake_client.hpp"
#include "game/flares.hpp"
#include "game/host.hpp"
#include "game/library.hpp"
#include "game/lights.hpp"
#include "game/stress.hpp"
#include "game/walker.hpp"

namespace vkpt::game {

class Module {
public:
    // `imports` of the server; `library` got imports_for_game().
    Module(const Imports& imports, const Imports& for_game);
    // Once; the game is loaded then.
    void wrap(GameLibrary library);

    Exports* exports() { return &exports_; }
    Host& host() { return host_; }
    FakeClient& fake_client() { return fake_client_; }
    Lights& lights() { return lights_; }
    Walker& walker() { return walker_; }
    Flares& flares() { return flares_; }
    Stress& stress() { return stress_; }
    // By number: whether the server has a player there.
    const std::vector<bool>& is_client() const { return is_client_; }
    Imports* imports_for_game() { return &for_game_; }
    const GameLibrary& library() const { return library_; }

    // Around each call into the game.
    void enter();
    void leave();

    void init();
    void shutdown();
    void spawn_entities(const char* map, char* entity_text, const char* spawn_point);
    void write_level(const char* file);
    void read_level(const char* file);
    QBoolean client_connect(Edict* client, char* user_info);
    void client_begin(Edict* client);
    void client_disconnect(Edict* client);
    void client_command(Edict* client);
    void client_think(Edict* client, UserCommand* command);
    void run_frame();
    void server_command();

private:
    bool is_operator(const Edict* client) const;
    // False: it is none of ours.
    bool run_command(Edict* sender, int first_word);
    void run_start_commands();
    Edict* first_player() const;
    void report_full_array();

    Host host_;
    Imports for_game_;
    Exports exports_ {};
    GameLibrary library_;
    FakeClient fake_client_;
    Lights lights_;
    Walker walker_;
    Flares flares_;
    Stress stress_;
    std::vector<bool> is_client_, is_local_; // by number
    bool is_running_ = false, was_frame_ = false, is_full_ = false;
};

} // namespace vkpt::game

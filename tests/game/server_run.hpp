// SPDX-License-Identifier: GPL-2.0-or-later
// A run of the engine's dedicated server on our game module, watched by probes (probe.cpp).
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <vector>

namespace vkpt::tests {

struct ServerOptions {
    std::string map = "vkpt1";
    std::vector<std::string> settings; // NAME, VALUE, ...
    std::map<long, std::string> script; // console commands by frame; the run ends at `frames`
    long frames = 100; // server frames, over all levels
    std::map<std::string, std::string> files; // contents by path in the writable game folder
    std::map<std::string, std::filesystem::path> links; // where symbolic ones point to, by path in that folder
    std::vector<std::filesystem::path> maps; // copied to the writable game folder, by their names
    std::string game_library; // for vkpt_game_library; empty: the stock game
    bool probe_inside = false; // between our module and the stock game: notes calls
    bool replay = false; // without our module: what the probe noted in `replayed`, again
    std::filesystem::path replayed;
    bool ignore_models = false;
    bool sanitized = false; // our module built with sanitizers
    double cpu_seconds = 300;
};

struct ServerState {
    std::string text; // the probe's line, all that has to be equal
    glm::vec3 origin { 0 };
    int health = 0, own_entities = 0;
    bool has_player = false;
};

// An entity of our module as the server sees it in one frame.
struct OwnEntity {
    long frame = 0; // as in ServerOptions::script
    int slot = 0;
    glm::vec3 origin { 0 };
    int model = 0, skin = 0, render_flags = 0;
    bool operator==(const OwnEntity&) const = default;
};

class ServerRun {
public:
    explicit ServerRun(const ServerOptions& options);
    ~ServerRun();
    ServerRun(const ServerRun&) = delete;
    ServerRun& operator=(const ServerRun&) = delete;

    const std::string& console() const { return console_; }
    const std::vector<ServerState>& states() const { return states_; }
    std::vector<glm::vec3> way() const;
    const std::vector<OwnEntity>& own_entities() const { return own_entities_; }
    std::vector<OwnEntity> own_entities_at(long frame) const;
    std::filesystem::path calls() const { return folder_ / "calls"; }
    std::filesystem::path game_folder() const { return folder_ / "home/.yq2/vkpt"; }
    // Where the server found the game library that the options name.
    const std::string& library() const { return library_; }
    // Ended by itself, after all frames.
    void expect_clean() const;

private:
    void make_folder(const ServerOptions& options);
    int start(const ServerOptions& options);
    std::string bring(const std::string& library);
    void read_states();
    void read_own_entities();

    std::filesystem::path folder_;
    std::string library_;
    int libraries_ = 0; // that were copied
    long frames_;
    int status_ = -1;
    std::string console_;
    std::vector<ServerState> states_;
    std::vector<OwnEntity> own_entities_;
};

} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/game/server_run.hpp"

#include "common/read_text.hpp"
#include "common/temporary_folder.hpp"
#include "tests/runner/process_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace vkpt::tests {

namespace {

namespace fs = std::filesystem;

fs::path stock_game() { return "/usr/lib/yamagi-quake2/baseq2/game.so"; }

} // namespace

ServerRun::ServerRun(const ServerOptions& options)
    : frames_(options.frames)
{
    make_folder(options);
    const int process = start(options);
    int status = 0;
    bool took_too_long = false;
    for (int look = 1; waitpid(process, &status, WNOHANG) == 0; look++) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        // A server that has found no game stays, and does nothing.
        if (look % 50 == 0
            && (measure_cpu_seconds(process) > options.cpu_seconds
                || read_text(game_folder() / "qconsole.log").find("failed to load game DLL") != std::string::npos)) {
            took_too_long = true;
            kill(-process, SIGKILL);
        }
    }
    status_ = took_too_long ? -1 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    console_ = read_text(folder_ / "output.txt");
    read_states();
    read_own_entities();
}

ServerRun::~ServerRun()
{
    std::error_code error;
    fs::remove_all(folder_, error);
}

void ServerRun::make_folder(const ServerOptions& options)
{
    folder_ = make_temporary_folder("vkpt-server-");
    // The server's user, who may be another than ours, has to come in and to write its files there.
    fs::permissions(folder_, fs::perms(0777));
    const fs::path files = folder_ / "files";
    fs::create_directories(files / "maps");
    for (const auto& [path, contents] : options.files) {
        fs::create_directories((files / path).parent_path());
        std::ofstream(files / path, std::ios::binary) << contents;
    }
    for (const auto& [path, target] : options.links) {
        fs::create_directories((files / path).parent_path());
        fs::create_symlink(target, files / path);
    }
    for (const fs::path& map : options.maps)
        fs::copy_file(map, files / "maps" / map.filename());
    fs::copy_file(VKPT_PROBE, files / "game.so");
    fs::copy_file(VKPT_PROBE, folder_ / "inside.so");
    std::ofstream script(folder_ / "script");
    for (const auto& [frame, command] : options.script)
        script << frame << ' ' << command << '\n';
    script << options.frames << " quit\n";
}

// The server's user may not look into the build folder: what it loads from there is copied.
std::string ServerRun::bring(const std::string& library)
{
    if (!library.starts_with(VKPT_TEST_BUILD_DIR))
        return library;
    const fs::path copy = folder_ / fmt::format("library{}.so", ++libraries_);
    fs::copy_file(library, copy);
    return copy.string();
}

int ServerRun::start(const ServerOptions& options)
{
    library_ = options.probe_inside ? (folder_ / "inside.so").string() : bring(options.game_library);
    std::vector<std::string> words { VKPT_SOURCE_DIR "/scripts/run_server.sh", folder_.string(), "+set", "fixedtime",
        "100000" }; // a server frame in every loop
    if (!library_.empty())
        words.insert(words.end(), { "+set", "vkpt_game_library", library_ });
    for (size_t i = 0; i + 1 < options.settings.size(); i += 2)
        words.insert(words.end(), { "+set", options.settings[i], options.settings[i + 1] });
    words.insert(words.end(), { "+map", options.map });
    std::vector<char*> argv;
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);

    const std::string module = bring(options.sanitized ? VKPT_SANITIZED_GAME : VKPT_GAME_MODULE);
    const int process = fork();
    if (process != 0)
        return process;
    setsid();
    setenv("VKPT_BUILD_DIR", VKPT_TEST_BUILD_DIR, 1);
    setenv("VKPT_PROBE_OUTSIDE", (options.replay ? stock_game().string() : module).c_str(), 1);
    setenv("VKPT_PROBE_INSIDE", stock_game().c_str(), 1);
    setenv("VKPT_PROBE_STATES", (folder_ / "states").c_str(), 1);
    setenv("VKPT_PROBE_OWN", (folder_ / "own").c_str(), 1);
    setenv("VKPT_PROBE_CALLS", (options.replay ? options.replayed : folder_ / "calls").c_str(), 1);
    setenv("VKPT_PROBE_SCRIPT", (folder_ / "script").c_str(), 1);
    if (options.replay)
        setenv("VKPT_PROBE_REPLAY", "1", 1);
    if (options.ignore_models)
        setenv("VKPT_PROBE_NO_MODELS", "1", 1);
    if (options.sanitized) {
        // The server itself is C: without the C++ library the sanitizer finds nothing to throw with.
        setenv("VKPT_SERVER_PRELOAD", VKPT_SANITIZER_LIBRARY ":libstdc++.so.6", 1);
        setenv("ASAN_OPTIONS", "detect_leaks=0:abort_on_error=1", 1);
        setenv("UBSAN_OPTIONS", "print_stacktrace=1:halt_on_error=1:abort_on_error=1", 1);
    }
    const int output = open((folder_ / "output.txt").c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
}

void ServerRun::read_states()
{
    std::ifstream file(folder_ / "states");
    for (std::string line; std::getline(file, line);) {
        ServerState state;
        std::istringstream words(line);
        std::string hash;
        int entities = 0;
        words >> hash >> entities >> state.origin.x >> state.origin.y >> state.origin.z >> state.health
            >> state.own_entities;
        state.text = line.substr(0, line.rfind(' '));
        state.has_player = state.health != -999;
        states_.push_back(state);
    }
}

void ServerRun::read_own_entities()
{
    std::ifstream file(folder_ / "own");
    OwnEntity entity;
    while (file >> entity.frame >> entity.slot >> entity.origin.x >> entity.origin.y >> entity.origin.z >> entity.model
        >> entity.skin >> entity.render_flags)
        own_entities_.push_back(entity);
}

std::vector<OwnEntity> ServerRun::own_entities_at(long frame) const
{
    std::vector<OwnEntity> found;
    std::ranges::copy_if(
        own_entities_, std::back_inserter(found), [frame](const OwnEntity& entity) { return entity.frame == frame; });
    return found;
}

std::vector<glm::vec3> ServerRun::way() const
{
    std::vector<glm::vec3> places;
    for (const ServerState& state : states_)
        if (state.has_player)
            places.push_back(state.origin);
    return places;
}

void ServerRun::expect_clean() const
{
    EXPECT_EQ(status_, 0) << console_.substr(console_.size() - std::min<size_t>(console_.size(), 3000));
    EXPECT_GE(long(states_.size()), frames_);
    for (const char* sign : { "ERROR", "AddressSanitizer", "runtime error", "probe:" })
        EXPECT_EQ(console_.find(sign), std::string::npos)
            << console_.substr(std::min(console_.find(sign), console_.size()), 3000);
}

} // namespace vkpt::tests

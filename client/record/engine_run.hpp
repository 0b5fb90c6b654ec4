// SPDX-License-Identifier: GPL-2.0-or-later
// Runs Yamagi Quake II with the recording module, without a display, in a folder of its own that vanishes afterwards.
// Nothing is played; with `with_sound` what would be heard is written.
#pragma once

#include "client/host/session_folder.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace vkpt::client {

struct EngineRunOptions {
    std::filesystem::path engine; // empty: $VKPT_ENGINE, then the usual places
    std::filesystem::path data_folder; // holds "baseq2"
    std::string game; // a folder beside baseq2, empty: none
    std::string demo; // name in the game's demos/, with ending
    std::vector<std::byte> demo_file; // where it is not in the game data; else empty
    std::vector<std::pair<std::string, std::string>> settings; // console variables
    bool with_sound = false;
    std::function<void(const std::filesystem::path& trace)> on_progress; // now and then
};

// Owns the folder, and the trace in it.
class EngineRun {
public:
    // Plays the demo to its end. Throws Failure with the engine's words.
    explicit EngineRun(const EngineRunOptions& options);
    EngineRun(const EngineRun&) = delete;
    EngineRun& operator=(const EngineRun&) = delete;

    const std::filesystem::path& trace() const { return trace_; }
    // For write_sound (sound.hpp).
    const std::filesystem::path& sound() const { return sound_; }

private:
    struct User {
        unsigned id = 0, group = 0;
    };
    void choose_user();
    bool can_user_read(const std::filesystem::path& path) const;
    void make_folder(const EngineRunOptions& options);
    void write_files(const EngineRunOptions& options) const;
    int start(const EngineRunOptions& options) const;
    void watch(int process, const EngineRunOptions& options) const;
    [[noreturn]] void fail(const std::string& reason) const;

    SessionFolder temporary_folder_;
    std::filesystem::path folder_, home_, data_, trace_, sound_, engine_;
    User user_;
    bool changes_user_ = false;
};

} // namespace vkpt::client

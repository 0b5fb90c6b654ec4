// SPDX-License-Identifier: GPL-2.0-or-later
// One run of the real engine on our module: started through scripts/run_engine.sh, watched, and ended if it takes too
// much CPU time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <ios>
#include <map>
#include <string>
#include <vector>

namespace vkpt::tests {

inline constexpr const char* own_map = "vkpt1";
inline constexpr const char* own_demo = "vkpt1.dm2";

inline constexpr const char* capture_name = "shots"; // for pt_capture_dir

struct EngineOptions {
    std::vector<std::string> arguments; // the engine's, in order
    std::string script; // console commands, one a line; run with "+exec test.cfg"
    std::string game = "baseq2"; // game directory
    std::map<std::string, std::string> files; // contents by path in the writable game folder
    std::vector<std::string> environment; // NAME=VALUE
    std::vector<std::string> display_commands; // one for each `display_mark`; run by a shell on the engine's display
    int width = 320, height = 180;
    int render_scale = 25; // pt_render_scale: a CPU renders the frames, and most tests do not look at them
    double cpu_seconds = 300; // of the engine with display and scripts; then it is ended
    std::string end_at; // a console line with this text ends it, too, without an error
    // Called again and again while the engine runs, with its writable game folder.
    std::function<void(const std::filesystem::path&)> while_running;
    bool validation = true; // Vulkan's validation layers
};

struct EngineResult {
    int status = -1; // exit status; 128 + signal
    bool took_too_long = false;
    std::string console;
    std::string output; // stdout and stderr
    std::filesystem::path game_folder; // the engine's writable one; gone with the EngineRun
    // At each console line "memory mark":
    std::vector<uint64_t> marked_memory; // resident bytes
    std::vector<size_t> marked_handles; // open files
};

// Console aliases wait_5, wait_25, wait_100: each wait is a frame and at least 16 ms.
std::string wait_aliases();
// Lines for it that capture for as long as a few frames take.
inline constexpr const char* capture_some = "set pt_capture_every 1\nwait_5\nset pt_capture_every 0\nwait\n";
// A line for EngineOptions::script that makes the harness note the engine's memory and open files.
inline constexpr const char* memory_mark = "echo memory mark\nwait_25\n";

// A line for EngineOptions::script: here the harness runs the next of EngineOptions::display_commands, and the engine
// goes on drawing until it has. (In other files the engine goes on with its script after some frames.)
inline constexpr const char* display_mark = "echo display mark\nwait_25\nwait_25\n";

// A command for EngineOptions::display_commands: the engine's window has the keys, and gets these one at a time, as the
// engine looks once a frame.
std::string press_keys(const std::vector<std::string>& keys);

// Owns the run's folder; the result is valid as long as it lives.
class EngineRun {
public:
    explicit EngineRun(const EngineOptions& options);
    ~EngineRun();
    EngineRun(const EngineRun&) = delete;
    EngineRun& operator=(const EngineRun&) = delete;

    const EngineResult& result() const { return outcome; }

    // Exit status 0 within its CPU time, our module loaded every time a renderer was, no message of the validation
    // layers.
    void expect_clean() const;
    // Where the renderer's first start captured frames under `capture_name`, its second one with any, and so on.
    std::filesystem::path captures(int start = 1) const;
    // The lines of the console that contain `text`.
    std::vector<std::string> lines_with(const std::string& text) const;

private:
    void make_folder(const EngineOptions& options);
    int start(const EngineOptions& options);
    void watch(int process, const EngineOptions& options);
    // What the console says since the last time.
    void follow_console(const EngineOptions& options);
    void obey(const std::string& line, const EngineOptions& options);
    void note_mark();
    void run_on_display(const std::string& command);

    std::filesystem::path folder;
    EngineResult outcome;
    size_t display_marks = 0;
    std::streamoff console_read = 0; // bytes of the console's log
    std::string console_line; // not ended yet
    bool is_over = false; // EngineOptions::end_at was met
};

} // namespace vkpt::tests

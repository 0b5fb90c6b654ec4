// SPDX-License-Identifier: GPL-2.0-or-later
// Plays the engine of release 8.70 for one refresh module: imports, files, cvars, commands; no window, no game.
#pragma once

#include "client/host/cvar_store.hpp"
#include "client/host/file_system.hpp"
#include "client/host/session_folder.hpp"
#include "ref_vkpt/extension.hpp"

#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vkpt::client {

struct HostOptions {
    std::filesystem::path module; // empty: $VKPT_MODULE, then beside the program
    int width = 640, height = 480;
    std::vector<std::pair<std::string, std::string>> cvars; // set before the module starts
    bool verbose = false; // console lines to stderr as they come
    std::function<void(const std::string& line)> on_line; // every console line as it comes
};

// One at a time: the refresh API has no place for a context pointer.
class Host {
public:
    // Loads and starts the module. files: nullptr where nothing but facts about the module is wanted; must outlive the
    // host. Throws Failure with the module's own words, WrongUse for a cvar that the module does not know.
    Host(const HostOptions& options, FileSystem* files);
    ~Host();
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;

    const engine::Exports8& module() const { return exports_; }
    const Extension& extension() const { return *extension_; }
    const std::filesystem::path& module_path() const { return module_path_; }
    CvarStore& cvars() { return cvars_; }
    // Of the picture.
    int width() const { return options_.width; }
    int height() const { return options_.height; }

    // One frame without 2D. Runs console text that the module left first.
    void draw_frame(const engine::RefDef& refdef);
    // For who draws a frame's parts by module(): first of all.
    void run_left_text() { run_text(std::exchange(pending_text_, {})); }
    // The user's own choice (HostOptions::cvars).
    bool is_chosen(std::string_view cvar) const;
    void run_text(std::string_view text);

    // What the module said, oldest first; the last hundred lines.
    const std::deque<std::string>& console() const { return console_; }

private:
    friend struct HostImports;

    void choose_write_folder();
    void load_module(const std::filesystem::path& wanted);
    void start_module();
    void check_wanted_cvars();
    void add_console_text(std::string_view text);
    void run_line(const std::vector<std::string>& words);
    std::string console_tail() const;

    HostOptions options_;
    FileSystem* files_;
    CvarStore cvars_;
    std::map<std::string, void (*)(), std::less<>> commands_;
    std::vector<std::string> arguments_; // of the command that runs
    std::string pending_text_;
    std::deque<std::string> console_;
    std::string console_line_; // not ended yet
    std::unique_ptr<SessionFolder> temporary_folder_; // where there is no place for caches
    std::filesystem::path write_folder_;
    std::string write_folder_text_;
    int screenshots_ = 0;

    std::filesystem::path module_path_;
    void* library_ = nullptr;
    engine::Exports8 exports_ {};
    const Extension* extension_ = nullptr;
    bool is_started_ = false;
    bool keeps_context_ = false; // while the module starts once more, in another size
};

} // namespace vkpt::client

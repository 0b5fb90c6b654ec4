// SPDX-License-Identifier: GPL-2.0-or-later
// What the subcommands of `vkpt` share on the command line.
#pragma once

#include "client/host/host.hpp"

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vkpt::client {

struct ModuleOptions {
    std::string module;
    std::vector<std::string> settings; // NAME=VALUE
    bool verbose = false;
};
void add_module_options(CLI::App& command, ModuleOptions& options);

struct SceneOptions {
    std::string scene;
    std::string size = "1280x720";
    std::string base_folder, game;
    int seed = 0;
};
void add_scene_options(CLI::App& command, SceneOptions& options);

void add_data_options(CLI::App& command, std::string& base_folder, std::string& game);

// Command lines for the end of --help.
void add_examples(CLI::App& command, std::initializer_list<const char*> lines);

// All throw WrongUse.
// "NAME=VALUE" each; `option` is named in the message.
std::vector<std::pair<std::string, std::string>> parse_settings(
    const std::vector<std::string>& texts, std::string_view option);
HostOptions make_host_options(const ModuleOptions& options);
struct Size {
    int width = 0, height = 0;
};
Size parse_size(const std::string& text);

// Each subcommand is one file: it adds itself to the program and runs as its callback.
void add_compare_command(CLI::App& program);
void add_diff_command(CLI::App& program);
void add_export_command(CLI::App& program);
void add_film_command(CLI::App& program);
void add_info_command(CLI::App& program);
void add_record_command(CLI::App& program);
void add_render_command(CLI::App& program);
void add_report_command(CLI::App& program);
void add_bench_command(CLI::App& program);
void add_view_command(CLI::App& program);

} // namespace vkpt::client

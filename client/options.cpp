// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/options.hpp"

#include "client/host/errors.hpp"
#include "common/numbers.hpp"
#include "formats/image.hpp"

#include <fmt/format.h>

namespace vkpt::client {

void add_module_options(CLI::App& command, ModuleOptions& options)
{
    command
        .add_option(
            "--module", options.module, "The ref_vkpt.so to use (default: $VKPT_MODULE, then beside this program)")
        ->type_name("PATH");
    command
        .add_option(
            "--set", options.settings, "Set a console variable; may be repeated (`vkpt info --cvars` lists them)")
        ->type_name("NAME=VALUE")
        ->take_all()
        ->expected(1);
    command.add_flag("--verbose", options.verbose, "Print the module's console output on stderr");
}

void add_scene_options(CLI::App& command, SceneOptions& options)
{
    command
        .add_option("SCENE", options.scene,
            "maps/NAME.bsp[@x,y,z,pitch,yaw] (default camera: the first player start) or FILE.rtrace[@frame]")
        ->required();
    command.add_option("--size", options.size, "Picture size in pixels")->type_name("WxH")->capture_default_str();
    command.add_option("--seed", options.seed, "Seed of the random numbers; 0: a new one each frame")
        ->type_name("N")
        ->check(CLI::Range(0, 16777215));
    add_data_options(command, options.base_folder, options.game);
}

void add_data_options(CLI::App& command, std::string& base_folder, std::string& game)
{
    command.add_option("--basedir", base_folder, "The folder that contains \"baseq2\" (default: the usual places)")
        ->type_name("DIR");
    command.add_option("--game", game, "A game folder beside baseq2, searched first")->type_name("NAME");
}

void add_examples(CLI::App& command, std::initializer_list<const char*> lines)
{
    std::string text = "Examples:";
    for (const char* line : lines)
        text += fmt::format("\n  {}", line);
    command.footer(text);
}

std::vector<std::pair<std::string, std::string>> parse_settings(
    const std::vector<std::string>& texts, std::string_view option)
{
    std::vector<std::pair<std::string, std::string>> settings;
    for (const std::string& text : texts) {
        const size_t equals = text.find('=');
        if (equals == 0 || equals == std::string::npos)
            throw WrongUse(fmt::format("{0} {1}: write {0} NAME=VALUE", option, text));
        settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
    return settings;
}

HostOptions make_host_options(const ModuleOptions& options)
{
    HostOptions host;
    host.module = options.module;
    host.verbose = options.verbose;
    host.cvars = parse_settings(options.settings, "--set");
    return host;
}

Size parse_size(const std::string& text)
{
    const size_t x = text.find('x');
    const auto parse_side = [](std::string_view side) { return parse_number<int>(side).value_or(0); };
    const Size size = x == std::string::npos
        ? Size {}
        : Size { parse_side(std::string_view(text).substr(0, x)), parse_side(std::string_view(text).substr(x + 1)) };
    const auto is_possible = [](int n) { return n >= 1 && n <= formats::max_image_size; };
    if (x == std::string::npos || !is_possible(size.width) || !is_possible(size.height))
        throw WrongUse(
            fmt::format("--size {}: write WIDTHxHEIGHT, each 1 to {}, e.g. 1280x720", text, formats::max_image_size));
    return size;
}

} // namespace vkpt::client

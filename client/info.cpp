// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt info: what the module found on this machine.
#include "client/cvar_table.hpp"
#include "client/host/name_list.hpp"
#include "client/options.hpp"
#include "client/pass_table.hpp"
#include "client/trace_info.hpp"
#include "ref_vkpt/cvars_rows.hpp"

#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace vkpt::client {

namespace {

using Json = nlohmann::ordered_json;

constexpr int info_schema = 1;

struct InfoOptions {
    ModuleOptions module;
    std::string trace;
    bool json = false, cvars = false, passes = false;
};

const char* text(const char* text_or_null) { return text_or_null ? text_or_null : ""; }

Json make_info(const Host& host)
{
    const ModuleInfo info = host.extension().info();
    Json json;
    json["schema"] = info_schema;
    json["module"] = host.module_path().string();
    json["device"] = text(info.device);
    json["driver"] = text(info.driver);
    json["vulkan"] = text(info.vulkan_version);
    json["api_versions"] = Json::array();
    for (const int32_t api : info.api_versions) {
        if (api == 0)
            break;
        json["api_versions"].push_back(api);
    }
    json["trace_backend"] = text(info.trace_backend);
    json["trace_backends"] = list_names(info.trace_backends);
    json["light_samplers"] = list_names(info.light_samplers);
    json["denoisers"] = list_names(info.denoisers);
    json["limits"] = { { "entities", info.max_entities }, { "dlights", info.max_dlights },
        { "particles", info.max_particles }, { "image_size", info.max_image_size } };
    return json;
}

Json make_cvar_list()
{
    Json list = Json::array();
    for (const CvarRow& row : cvar_rows) {
        Json cvar { { "name", row.name }, { "default", row.initial }, { "help", row.help } };
        if (row.owner == CvarOwner::module && row.type != CvarType::text)
            cvar["range"] = { row.lowest, row.highest };
        if (*row.choices)
            cvar["choices"] = row.choices;
        list.push_back(std::move(cvar));
    }
    return list;
}

std::string join(const Json& list)
{
    std::string line;
    for (const Json& item : list)
        line += (line.empty() ? "" : ", ") + (item.is_string() ? item.get<std::string>() : item.dump());
    return line.empty() ? "none" : line;
}

void print_text(const Json& info)
{
    const auto line = [](const char* name, const std::string& value) { fmt::print("{:<16}{}\n", name, value); };
    line("module", info["module"]);
    line("device", info["device"]);
    line("driver", info["driver"]);
    line("Vulkan", info["vulkan"]);
    line("engine API", join(info["api_versions"]));
    line("rays by",
        fmt::format(
            "{} (this device can: {})", info["trace_backend"].get<std::string>(), join(info["trace_backends"])));
    line("light samplers", join(info["light_samplers"]));
    line("denoisers", join(info["denoisers"]));
    for (const auto& [name, value] : info["limits"].items())
        line(("max " + name).c_str(), value.dump());
}

void run_info(const InfoOptions& options)
{
    if (options.passes) {
        fmt::print("{}", make_pass_page());
        return;
    }
    if (options.cvars && !options.json) {
        fmt::print("{}", make_cvar_page());
        return;
    }
    if (!options.trace.empty()) {
        const Json info = make_trace_info(options.trace);
        if (options.json)
            fmt::print("{}\n", info.dump(2, ' ', false, Json::error_handler_t::replace));
        else
            print_trace_info(info);
        return;
    }
    const Host host(make_host_options(options.module), nullptr);
    Json info = make_info(host);
    if (options.cvars)
        info["cvars"] = make_cvar_list();
    if (options.json)
        fmt::print("{}\n", info.dump(2, ' ', false, Json::error_handler_t::replace));
    else
        print_text(info);
}

} // namespace

void add_info_command(CLI::App& program)
{
    const auto options = std::make_shared<InfoOptions>();
    CLI::App* command = program.add_subcommand(
        "info", "Show device, driver, ray backends, light samplers and limits; or the contents of a trace");
    command->add_option("TRACE", options->trace, "A FILE.rtrace");
    command->add_flag("--json", options->json, "Machine-readable, with a schema number");
    command->add_flag(
        "--cvars", options->cvars, "List the console variables (Markdown; with --json added to the rest)");
    command->add_flag("--passes", options->passes, "List the passes of a frame (Markdown)");
    add_module_options(*command, options->module);
    add_examples(*command, { "vkpt info", "vkpt info --json --cvars", "vkpt info game.rtrace" });
    command->callback([options] { run_info(*options); });
}

} // namespace vkpt::client

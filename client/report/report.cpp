// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt report: what this machine makes of the renderer, for a bug report.
#include "client/output_folder.hpp"
#include "client/report/apart.hpp"
#include "client/report/measurements.hpp"
#include "client/report/page.hpp"

#include <array>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace vkpt::client {

namespace {

constexpr int report_schema = 1;
constexpr std::array presets { "low", "medium", "high", "ultra" };

void say(const std::string& what) { std::fprintf(stderr, "vkpt: %s\n", what.c_str()); }

Json with_keys(Json part, std::initializer_list<std::pair<std::string, std::string>> keys)
{
    for (const auto& [key, value] : keys)
        if (!part.contains(key))
            part[key] = value;
    return part;
}

void run_report(const ReportOptions& options)
{
    for (const std::string& size : options.sizes)
        parse_size(size);
    FileSystem(options.base_folder, options.game); // throws what is wrong with it
    OutputFolder output(options.output, { "report.json", "report.html" });
    Json report { { "schema", report_schema }, { "scene", options.scene } };
    say("device, and ways to trace");
    report["device"] = run_apart([&] { return describe_device(options); });
    report["times"] = Json::array();
    for (const std::string& size : options.sizes)
        for (const char* preset : presets) {
            say(fmt::format("preset {} at {}", preset, size));
            report["times"].push_back(with_keys(run_apart([&] { return time_preset(options, preset, size); }),
                { { "preset", preset }, { "size", size } }));
        }
    report["validation"] = report["pictures"] = Json::array();
    for (const Json& backend : report["device"].value("trace_backends", Json::array({ "auto" }))) {
        const std::string name = backend;
        say(fmt::format("rays by {}: validation, pictures", name));
        report["validation"].push_back(
            with_keys(run_apart([&] { return validate_frames(options, name); }), { { "backend", name } }));
        report["pictures"].push_back(
            with_keys(run_apart([&] { return check_pictures(options, name); }), { { "backend", name } }));
    }
    report["problems"] = list_problems(report);
    output.write(1, make_report_page(report));
    for (Json& check : report["pictures"])
        if (check.contains("pictures"))
            for (Json& picture : check["pictures"])
                picture.erase("png"); // the page has them
    output.write(0, report.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    output.commit();
    fmt::print("{}{}/report.json and report.html: nothing was sent anywhere; attach both where you tell of it\n",
        make_report_text(report), options.output);
}

} // namespace

void add_report_command(CLI::App& program)
{
    const auto options = std::make_shared<ReportOptions>();
    CLI::App* command = program.add_subcommand("report",
        "What this machine's GPU makes of the renderer: times, validation and pictures, as a page and as JSON");
    command->add_option("SCENE", options->scene, "What is timed: FILE.rtrace or maps/NAME.bsp")->required();
    command->add_option("-o,--output", options->output, "The folder for report.json and report.html")
        ->required()
        ->type_name("DIR");
    command->add_option("--size", options->sizes, "Sizes of pictures that are timed")
        ->type_name("WxH")
        ->capture_default_str();
    command->add_option("--seconds", options->seconds, "How long each preset is timed, at least four frames")
        ->type_name("N")
        ->check(CLI::Range(0.0, 600.0))
        ->capture_default_str();
    add_data_options(*command, options->base_folder, options->game);
    add_module_options(*command, options->module);
    add_examples(
        *command, { "vkpt report demo.rtrace -o report", "vkpt report maps/vkpt1.bsp --size 640x360 -o report" });
    command->callback([options] { run_report(*options); });
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/report/page.hpp"

#include "client/compare/plot.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace vkpt::client {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view style = R"(
:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em; }
table { border-collapse: collapse; margin: 1em 0; }
th, td { text-align: left; padding: .2em 1em .2em 0; border-bottom: 1px solid #8884; vertical-align: top; }
td.number { text-align: right; font-variant-numeric: tabular-nums; }
figure { display: inline-block; margin: 0 1em 1em 0; }
figure img { display: block; width: 320px; }
.bad { color: #d33; font-weight: 600; }
pre { overflow-x: auto; padding: 1em; background: #8882; }
)";

std::string text_of(const Json& json, const char* key)
{
    const auto found = json.find(key);
    if (found == json.end() || found->is_null())
        return "-";
    return found->is_string() ? found->get<std::string>() : found->dump();
}

std::string milliseconds(const Json& json, const char* key)
{
    const auto found = json.find(key);
    return found != json.end() && found->is_number() ? fmt::format("{:.2f}", found->get<double>()) : "-";
}

bool has_failed(const Json& part) { return part.contains("error"); }

std::string make_row(std::initializer_list<std::string> cells, bool is_head = false)
{
    std::string row = "<tr>";
    for (const std::string& cell : cells)
        row += fmt::format("<{0}>{1}</{0}>", is_head ? "th" : "td", cell);
    return row + "</tr>\n";
}

std::string make_device_table(const Json& device)
{
    std::string table = "<table>\n";
    if (has_failed(device))
        return fmt::format("<p class=bad>{}</p>\n", escape_markup(text_of(device, "error")));
    for (const char* key : { "device", "driver", "vulkan", "trace_backend" })
        table += make_row({ key, escape_markup(text_of(device, key)) });
    for (const auto& [backend, time] : device["ns_per_ray"].items())
        table += make_row({ escape_markup(backend), fmt::format("{} ns a ray", time.dump()) });
    return table + "</table>\n";
}

std::string make_times_table(const Json& times)
{
    std::string table = "<table>\n"
        + make_row({ "size", "preset", "frame, ms", "a second", "first frame, s", "MiB", "passes, ms" }, true);
    for (const Json& time : times) {
        const std::string size = escape_markup(text_of(time, "size")), preset = escape_markup(text_of(time, "preset"));
        if (has_failed(time)) {
            table += make_row({ size, preset, "<span class=bad>" + escape_markup(text_of(time, "error")) + "</span>" });
            continue;
        }
        std::vector<std::pair<double, std::string>> passes;
        for (const auto& [name, value] : time["passes"].items())
            passes.emplace_back(value.get<double>(), name);
        std::ranges::sort(passes, std::greater());
        std::string list;
        for (const auto& [value, name] : passes)
            list += fmt::format("{}{} {:.2f}", list.empty() ? "" : ", ", escape_markup(name), value);
        const bool is_timed = time["frame_ms"].is_number() && time["frame_ms"].get<double>() > 0;
        table += make_row({ size, preset, milliseconds(time, "frame_ms"),
            is_timed ? fmt::format("{:.0f}", 1000 / time["frame_ms"].get<double>()) : "-",
            milliseconds(time, "first_frame_seconds"), text_of(time, "gpu_mib"), list });
    }
    return table + "</table>\n";
}

std::string make_validation_list(const Json& validation)
{
    std::string list = "<table>\n";
    for (const Json& run : validation) {
        const std::string backend = escape_markup(text_of(run, "backend"));
        if (has_failed(run)) {
            list += make_row({ backend, escape_markup(text_of(run, "error")) });
            continue;
        }
        std::string texts = text_of(run, "messages") + " messages";
        for (const Json& text : run["texts"])
            texts += "<pre>" + escape_markup(text.get<std::string>()) + "</pre>";
        list += make_row({ backend, texts });
    }
    return list + "</table>\n";
}

std::string make_pictures(const Json& checks)
{
    std::string page;
    for (const Json& check : checks) {
        page += fmt::format("<h3>{}</h3>\n", escape_markup(text_of(check, "backend")));
        if (has_failed(check)) {
            page += fmt::format("<p class=bad>{}</p>\n", escape_markup(text_of(check, "error")));
            continue;
        }
        for (const Json& picture : check["pictures"])
            page += fmt::format("<figure><img src=\"data:image/png;base64,{}\" alt=\"{}\"><figcaption{}>{}: off by "
                                "{:.1f}, at most {:.1f} of 255</figcaption></figure>\n",
                text_of(picture, "png"), escape_markup(text_of(picture, "name")),
                picture["is_right"].get<bool>() ? "" : " class=bad", escape_markup(text_of(picture, "name")),
                picture["mean_difference"].get<double>(), picture["max_difference"].get<double>());
    }
    return page;
}

std::string make_problem_list(const std::vector<std::string>& problems)
{
    if (problems.empty())
        return "<p>Nothing is wrong.</p>\n";
    std::string list = "<ul>\n";
    for (const std::string& problem : problems)
        list += fmt::format("<li class=bad>{}</li>\n", escape_markup(problem));
    return list + "</ul>\n";
}

// The validation layer is not part of a player's machine.
bool lacks_layer(const Json& run) { return text_of(run, "error").find("validation layers") != std::string::npos; }

} // namespace

std::vector<std::string> list_problems(const Json& report)
{
    std::vector<std::string> problems;
    const auto note = [&](const Json& part, const std::string& what) {
        if (has_failed(part))
            problems.push_back(what + ": " + text_of(part, "error"));
    };
    note(report["device"], "device");
    for (const Json& time : report["times"])
        note(time, fmt::format("{} at {}", text_of(time, "preset"), text_of(time, "size")));
    for (const Json& run : report["validation"]) {
        if (!lacks_layer(run))
            note(run, "validation, rays by " + text_of(run, "backend"));
        if (run.value("messages", 0) > 0)
            problems.push_back(fmt::format(
                "{} messages of the validation layer, rays by {}", run["messages"].dump(), text_of(run, "backend")));
    }
    for (const Json& check : report["pictures"]) {
        note(check, "pictures, rays by " + text_of(check, "backend"));
        for (const Json& picture : check.value("pictures", Json::array()))
            if (!picture["is_right"].get<bool>())
                problems.push_back(fmt::format("the picture {} with rays by {} is off by {:.1f}, at most {:.1f} of 255",
                    text_of(picture, "name"), text_of(check, "backend"), picture["mean_difference"].get<double>(),
                    picture["max_difference"].get<double>()));
    }
    return problems;
}

std::string make_report_page(const Json& report)
{
    std::string console;
    for (const Json& line : report["device"].value("console", Json::array()))
        console += escape_markup(line.get<std::string>()) + "\n";
    return fmt::format("<!doctype html>\n<html lang=en><meta charset=utf-8>\n<title>ref_vkpt on {0}</title>\n"
                       "<style>{1}</style>\n<h1>ref_vkpt on {0}</h1>\n{2}<h2>Device</h2>\n{3}<h2>Time of a frame</h2>\n"
                       "<p>{4}, medians.</p>\n{5}<h2>Validation layer</h2>\n{6}<h2>Pictures</h2>\n<p>Brightness in a "
                       "grid of 16 x 9, compared with Mesa's CPU driver.</p>\n{7}<h2>Console</h2>\n<pre>{8}</pre>\n"
                       "</html>\n",
        escape_markup(text_of(report["device"], "device")), style, make_problem_list(list_problems(report)),
        make_device_table(report["device"]), escape_markup(text_of(report, "scene")), make_times_table(report["times"]),
        make_validation_list(report["validation"]), make_pictures(report["pictures"]), console);
}

std::string make_report_text(const Json& report)
{
    std::string text
        = fmt::format("{} ({})\n", text_of(report["device"], "device"), text_of(report["device"], "driver"));
    for (const Json& time : report["times"])
        text += has_failed(time)
            ? fmt::format("{:>9}  {:<7} {}\n", text_of(time, "size"), text_of(time, "preset"), text_of(time, "error"))
            : fmt::format("{:>9}  {:<7} {:>8} ms\n", text_of(time, "size"), text_of(time, "preset"),
                milliseconds(time, "frame_ms"));
    const std::vector<std::string> problems = list_problems(report);
    for (const std::string& problem : problems)
        text += "wrong: " + problem + "\n";
    return text + (problems.empty() ? "Nothing is wrong.\n" : "");
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/bench/bench_report.hpp"

#include "client/host/errors.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>

namespace vkpt::client {

namespace {

using Json = nlohmann::ordered_json;

TimedTask task_from_json(const Json& json)
{
    return { json.at("name"), json.value("samples_ms", std::vector<float> { json.at("median_ms").get<float>() }) };
}

// The tasks that both have, in the first one's order.
template <class Visit> void visit_shared(const BenchResult& first, const BenchResult& second, Visit visit)
{
    visit("frame", first.frame_ms, second.frame_ms);
    for (const auto list : { &BenchResult::passes, &BenchResult::cpu })
        for (const TimedTask& task : first.*list) {
            const auto other = std::ranges::find(second.*list, task.name, &TimedTask::name);
            if (other == (second.*list).end())
                continue;
            visit(list == &BenchResult::cpu ? "cpu " + task.name : task.name, task.ms, other->ms);
        }
}

bool has_ratio(const std::vector<float>& ms)
{
    return !ms.empty() && std::ranges::all_of(ms, [](float value) { return value > 0; });
}

std::string describe_rays(const BenchResult& result)
{
    return fmt::format("{:.3f} M a frame ({:.3f} for the nearest hit, {:.3f} for visibility), {:.2f} M/s",
        result.rays_per_frame() / 1e6, result.nearest_rays / 1e6, result.visibility_rays / 1e6,
        result.mrays_per_second());
}

} // namespace

BenchResult read_bench_json(const std::filesystem::path& path)
{
    std::ifstream stream(path);
    if (!stream)
        throw Failure(
            fmt::format("cannot read {}: `vkpt bench SCENE --json {}` makes it", path.string(), path.string()));
    try {
        const Json json = Json::parse(stream);
        if (json.at("schema") > bench_schema)
            throw Failure(fmt::format("{} has schema {}, this program reads up to {}: use a newer vkpt", path.string(),
                json.at("schema").dump(), bench_schema));
        BenchResult result;
        result.scene = json.at("scene");
        result.width = json.at("size").at(0);
        result.height = json.at("size").at(1);
        const Json& frame = json.at("frame_ms");
        result.frame_ms = frame.value("samples", std::vector<float> { frame.at("median").get<float>() });
        for (const Json& pass : json.at("passes"))
            result.passes.push_back(task_from_json(pass));
        for (const Json& task : json.at("cpu"))
            result.cpu.push_back(task_from_json(task));
        return result;
    } catch (const nlohmann::json::exception& error) {
        throw Failure(fmt::format("{} is no result of `vkpt bench --json`: {}", path.string(), error.what()));
    }
}

void print_table(const BenchResult& result)
{
    const float median = find_median(result.frame_ms);
    fmt::print("scene    {}, {} x {}, {} frames\n", result.scene, result.width, result.height, result.frames);
    fmt::print("device   {} ({}), rays by {}\n", result.device, result.driver, result.trace_backend);
    for (const auto& [name, text] : result.settings)
        fmt::print("setting  {} {}\n", name, text);
    fmt::print("start    first frame after {:.2f} s\n\n", result.first_frame_seconds);
    fmt::print("{:<28}{:>10}{:>10}{:>10}{:>8}\n", "ms", "median", "p5", "p95", "share");
    const auto row = [&](const std::string& name, const std::vector<float>& ms, bool share) {
        fmt::print("{:<28}{:>10.3f}{:>10.3f}{:>10.3f}{:>8}\n", name, find_median(ms), find_quantile(ms, 0.05),
            find_quantile(ms, 0.95),
            share && median > 0 ? fmt::format("{:.0f} %", 100 * find_median(ms) / median) : "");
    };
    row("frame", result.frame_ms, false);
    for (const TimedTask& pass : result.passes)
        row(pass.name, pass.ms, true);
    for (const TimedTask& task : result.cpu)
        row("cpu " + task.name, task.ms, true);
    fmt::print("\nspeed    {:.2f} frames a second\n", median > 0 ? 1000 / median : 0);
    fmt::print("rays     {}\n", describe_rays(result));
    fmt::print(
        "memory   {:.0f} MiB of the device, {:.0f} MiB at most of the process\n", result.gpu_mib, result.peak_rss_mib);
}

void print_comparison(const BenchResult& first, const std::string& first_title, const BenchResult& second,
    const std::string& second_title, size_t block)
{
    fmt::print("{:<28}{:>14}{:>14}{:>9}   95 % interval\n", "ms, medians", first_title, second_title, "ratio");
    visit_shared(
        first, second, [&](const std::string& name, const std::vector<float>& before, const std::vector<float>& now) {
            fmt::print("{:<28}{:>14.3f}{:>14.3f}", name, find_median(before), find_median(now));
            if (has_ratio(before) && has_ratio(now)) {
                const Ratio ratio = find_ratio(before, now, block);
                fmt::print("{:>9.3f}   {:.3f} to {:.3f}", ratio.value, ratio.low, ratio.high);
            }
            fmt::print("\n");
        });
}

Json compare_to_json(const BenchResult& first, const BenchResult& second, size_t block)
{
    Json list = Json::array();
    visit_shared(
        first, second, [&](const std::string& name, const std::vector<float>& before, const std::vector<float>& now) {
            if (!has_ratio(before) || !has_ratio(now))
                return;
            const Ratio ratio = find_ratio(before, now, block);
            list.push_back({ { "name", name }, { "ratio", round_time(ratio.value) }, { "low", round_time(ratio.low) },
                { "high", round_time(ratio.high) } });
        });
    return list;
}

} // namespace vkpt::client

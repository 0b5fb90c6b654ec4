// SPDX-License-Identifier: GPL-2.0-or-later
#include "common/bench_result.hpp"

#include "common/quantile.hpp"

#include <cmath>

namespace vkpt {

namespace {

using Json = nlohmann::ordered_json;

Json samples_to_json(const std::vector<float>& ms)
{
    Json list = Json::array();
    for (const float sample : ms)
        list.push_back(round_time(sample));
    return list;
}

Json task_to_json(const TimedTask& task, bool with_p95, BenchSamples samples)
{
    Json json { { "name", task.name }, { "median_ms", round_time(find_median(task.ms)) } };
    if (with_p95)
        json["p95_ms"] = round_time(find_quantile(task.ms, 0.95));
    if (samples == BenchSamples::written)
        json["samples_ms"] = samples_to_json(task.ms);
    return json;
}

} // namespace

double round_time(double value) { return std::round(value * 1e4) / 1e4; }

double BenchResult::mrays_per_second() const
{
    const double median = find_median(frame_ms);
    return median > 0 ? rays_per_frame() / (median * 1000) : 0;
}

Json to_json(const BenchResult& result, BenchSamples samples)
{
    Json json;
    json["schema"] = bench_schema;
    json["scene"] = result.scene;
    json["size"] = { result.width, result.height };
    json["frames"] = result.frames;
    json["settings"] = Json::object();
    for (const auto& [name, text] : result.settings)
        json["settings"][name] = text;
    json["device"] = result.device;
    json["driver"] = result.driver;
    json["trace_backend"] = result.trace_backend;
    json["frame_ms"] = { { "median", round_time(find_median(result.frame_ms)) },
        { "p5", round_time(find_quantile(result.frame_ms, 0.05)) },
        { "p95", round_time(find_quantile(result.frame_ms, 0.95)) } };
    if (samples == BenchSamples::written)
        json["frame_ms"]["samples"] = samples_to_json(result.frame_ms);
    json["passes"] = Json::array();
    for (const TimedTask& pass : result.passes)
        json["passes"].push_back(task_to_json(pass, true, samples));
    json["cpu"] = Json::array();
    for (const TimedTask& task : result.cpu)
        json["cpu"].push_back(task_to_json(task, false, samples));
    const bool has_rays = result.rays_per_frame() > 0;
    json["rays_per_frame"] = has_rays ? Json(std::round(result.rays_per_frame())) : Json();
    json["mrays_per_s"] = has_rays ? Json(round_time(result.mrays_per_second())) : Json();
    json["rays"]
        = { { "nearest", std::round(result.nearest_rays) }, { "visibility", std::round(result.visibility_rays) } };
    json["peak_rss_mib"] = std::round(result.peak_rss_mib * 10) / 10;
    json["gpu_mib"] = std::round(result.gpu_mib * 10) / 10;
    json["start"] = { { "first_frame_s", round_time(result.first_frame_seconds) } };
    return json;
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/bench_report.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <sys/resource.h>

namespace vkpt {

namespace {

constexpr int schema = 1;

std::string quote(std::string_view text)
{
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            quoted += '\\';
        if (uint8_t(c) < 0x20)
            quoted += fmt::format("\\u{:04x}", int(c));
        else
            quoted += c;
    }
    return quoted + '"';
}

std::string join(const std::vector<std::string>& items)
{
    std::string text;
    for (const std::string& item : items)
        text += (text.empty() ? "\n    " : ",\n    ") + item;
    return text.empty() ? text : text + "\n  ";
}

double peak_resident_mib()
{
    rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_maxrss) / 1024; // Linux counts in KiB
}

} // namespace

std::string make_bench_report(const PassStatistics& statistics, const ModuleInfo& info, const BenchFacts& facts)
{
    std::vector<std::string> passes, cpu, settings;
    std::vector<float> frames;
    size_t timed_by_pass = 0;
    for (const PassStatistics::Pass& pass : statistics.passes()) {
        const float median = find_quantile(pass.milliseconds, 0.5), p95 = find_quantile(pass.milliseconds, 0.95);
        if (pass.name == whole_frame)
            frames = pass.milliseconds;
        else if (pass.name.starts_with(cpu_task))
            cpu.push_back(fmt::format(
                R"({{"name": {}, "median_ms": {:.4f}}})", quote(pass.name.substr(cpu_task.size())), median));
        else {
            passes.push_back(
                fmt::format(R"({{"name": {}, "median_ms": {:.4f}, "p95_ms": {:.4f}}})", quote(pass.name), median, p95));
            timed_by_pass = std::max(timed_by_pass, pass.milliseconds.size());
        }
    }
    const size_t frame_count = frames.size() + timed_by_pass;
    if (frames.empty())
        frames.push_back(0);
    for (const auto& [name, text] : facts.settings)
        settings.push_back(fmt::format("{}: {}", quote(name), quote(text)));
    const uint64_t rays = info.nearest_rays + info.visibility_rays;
    const float median = find_quantile(frames, 0.5);
    const uint64_t bytes = info.texture_bytes + info.geometry_bytes + info.acceleration_bytes + info.light_bytes
        + info.image_bytes + info.staging_bytes;
    std::string json
        = fmt::format("{}{},\n  \"scene\": {},\n  \"size\": [{}, {}],\n  \"frames\": {},\n", bench_report_head,
            schema, quote(facts.scene), facts.width, facts.height, frame_count);
    json += fmt::format("  \"settings\": {{{}}},\n  \"device\": {},\n  \"driver\": {},\n  \"trace_backend\": {},\n",
        join(settings), quote(info.device), quote(info.driver), quote(info.trace_backend));
    json += fmt::format("  \"frame_ms\": {{\"median\": {:.4f}, \"p5\": {:.4f}, \"p95\": {:.4f}}},\n", median,
        find_quantile(frames, 0.05), find_quantile(frames, 0.95));
    json += fmt::format("  \"passes\": [{}],\n  \"cpu\": [{}],\n", join(passes), join(cpu));
    // Rays are counted with pt_count_rays 1 only.
    json += rays == 0 || median <= 0 ? "  \"rays_per_frame\": null,\n  \"mrays_per_s\": null,\n"
                                     : fmt::format("  \"rays_per_frame\": {},\n  \"mrays_per_s\": {:.4f},\n", rays,
                                         double(rays) / (double(median) * 1000));
    json += fmt::format(
        "  \"peak_rss_mib\": {:.1f},\n  \"gpu_mib\": {:.1f},\n  \"start\": {{\"first_frame_s\": {:.3f}}}\n}}\n",
        peak_resident_mib(), double(bytes) / (1 << 20), facts.first_frame_seconds);
    return json;
}

} // namespace vkpt

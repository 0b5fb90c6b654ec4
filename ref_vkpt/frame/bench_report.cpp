// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/bench_report.hpp"

#include "common/bench_result.hpp"

#include <algorithm>
#include <sys/resource.h>

namespace vkpt {

namespace {

double peak_resident_mib()
{
    rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_maxrss) / 1024; // Linux counts in KiB
}

} // namespace

std::string make_bench_report(const PassStatistics& statistics, const ModuleInfo& info, const BenchFacts& facts)
{
    BenchResult result { facts.scene, facts.width, facts.height, facts.settings, info.device, info.driver,
        info.trace_backend };
    size_t timed_by_pass = 0;
    for (const auto& [name, milliseconds] : statistics.passes())
        if (name == whole_frame)
            result.frame_ms = milliseconds;
        else if (name.starts_with(cpu_task))
            result.cpu.push_back({ name.substr(cpu_task.size()), milliseconds });
        else {
            result.passes.push_back({ name, milliseconds });
            timed_by_pass = std::max(timed_by_pass, milliseconds.size());
        }
    result.frames = int(result.frame_ms.size() + timed_by_pass);
    result.nearest_rays = double(info.nearest_rays);
    result.visibility_rays = double(info.visibility_rays);
    result.peak_rss_mib = peak_resident_mib();
    result.gpu_mib = double(info.texture_bytes + info.geometry_bytes + info.acceleration_bytes + info.light_bytes
                         + info.image_bytes + info.staging_bytes)
        / (1 << 20);
    result.first_frame_seconds = facts.first_frame_seconds;
    return to_json(result, BenchSamples::left_out).dump(2) + '\n';
}

} // namespace vkpt

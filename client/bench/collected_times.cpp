// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/bench/collected_times.hpp"

#include <algorithm>
#include <string_view>

namespace vkpt::client {

namespace {

constexpr std::string_view cpu_task = "cpu "; // what the module calls its CPU's tasks

void add_samples(std::vector<TimedTask>& tasks, std::string_view name, const PassSamples& samples)
{
    auto task = std::ranges::find(tasks, name, &TimedTask::name);
    if (task == tasks.end())
        task = tasks.insert(tasks.end(), { std::string(name), {} });
    task->ms.insert(task->ms.end(), samples.milliseconds, samples.milliseconds + samples.count);
}

} // namespace

void add_collected_times(const Extension& extension, BenchResult& result)
{
    size_t count = 0;
    const PassSamples* samples = extension.collected_times(&count);
    for (size_t i = 0; i < count; i++) {
        const std::string_view name = samples[i].name;
        if (name.starts_with(cpu_task))
            add_samples(result.cpu, name.substr(cpu_task.size()), samples[i]);
        else if (name == "frame")
            result.frame_ms.insert(
                result.frame_ms.end(), samples[i].milliseconds, samples[i].milliseconds + samples[i].count);
        else
            add_samples(result.passes, name, samples[i]);
    }
}

double find_device_mib(const ModuleInfo& info)
{
    return double(info.texture_bytes + info.geometry_bytes + info.acceleration_bytes + info.light_bytes
               + info.image_bytes + info.staging_bytes)
        / (1 << 20);
}

} // namespace vkpt::client

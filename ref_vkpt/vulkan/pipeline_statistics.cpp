// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/pipeline_statistics.hpp"

#include "ref_vkpt/engine/engine.hpp"

#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <vector>

namespace vkpt {

namespace {

std::string to_text(const VkPipelineExecutableStatisticKHR& statistic)
{
    switch (statistic.format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
        return statistic.value.b32 ? "1" : "0";
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
        return fmt::format("{}", statistic.value.i64);
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
        return fmt::format("{}", statistic.value.u64);
    default:
        return fmt::format("{}", statistic.value.f64);
    }
}

std::vector<VkPipelineExecutablePropertiesKHR> executables_of(const Device& device, VkPipeline pipeline)
{
    const VkPipelineInfoKHR info { VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, nullptr, pipeline };
    uint32_t count = 0;
    VKPT_CHECK(vkGetPipelineExecutablePropertiesKHR(device.handle, &info, &count, nullptr));
    std::vector<VkPipelineExecutablePropertiesKHR> executables(
        count, { VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR, nullptr, 0, {}, {}, 0 });
    VKPT_CHECK(vkGetPipelineExecutablePropertiesKHR(device.handle, &info, &count, executables.data()));
    return executables;
}

std::vector<VkPipelineExecutableStatisticKHR> statistics_of(
    const Device& device, VkPipeline pipeline, uint32_t executable)
{
    const VkPipelineExecutableInfoKHR info { VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, pipeline,
        executable };
    uint32_t count = 0;
    VKPT_CHECK(vkGetPipelineExecutableStatisticsKHR(device.handle, &info, &count, nullptr));
    std::vector<VkPipelineExecutableStatisticKHR> statistics(
        count, { VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR, nullptr, {}, {}, {}, {} });
    VKPT_CHECK(vkGetPipelineExecutableStatisticsKHR(device.handle, &info, &count, statistics.data()));
    return statistics;
}

} // namespace

std::string wanted_statistics_file()
{
    const char* file = std::getenv("VKPT_PIPELINE_STATISTICS");
    return file ? file : "";
}

void write_pipeline_statistics(const std::string& file, const Device& device, Pipelines& pipelines)
{
    if (!device.has_pipeline_statistics) {
        engine::print(
            "ref_vkpt: {} tells nothing of its pipelines (VKPT_PIPELINE_STATISTICS)", device.properties.deviceName);
        return;
    }
    std::ofstream out(file, std::ios::trunc);
    for (const auto& [shader, pipeline] : pipelines.all()) {
        const auto executables = executables_of(device, pipeline);
        for (uint32_t i = 0; i < executables.size(); i++)
            for (const VkPipelineExecutableStatisticKHR& statistic : statistics_of(device, pipeline, i))
                out << fmt::format("{}\t{}\t{}\t{}\n", shader, executables[i].name, statistic.name, to_text(statistic));
    }
    out.close();
    if (!out)
        engine::print("ref_vkpt: cannot write {} (VKPT_PIPELINE_STATISTICS)", file);
}

} // namespace vkpt

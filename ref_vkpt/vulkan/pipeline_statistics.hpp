// SPDX-License-Identifier: GPL-2.0-or-later
// What the driver tells of compiled shaders (VK_KHR_pipeline_executable_properties): registers, spills, code size. For
// scripts/check_gpu_drivers.sh.
#pragma once

#include "ref_vkpt/vulkan/pipelines.hpp"

#include <string>

namespace vkpt {

// Where the user wants them: $VKPT_PIPELINE_STATISTICS, a file; empty: nowhere.
std::string wanted_statistics_file();

// Writes a line for each figure of each pipeline that there is: shader, executable, name, value, with tabs between.
// Says so on the console where the device has none, or the file cannot be written.
void write_pipeline_statistics(const std::string& file, const Device& device, Pipelines& pipelines);

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The ways to trace rays. Which one runs is pt_trace's to say, and for "auto" TraceChoice's.
#pragma once

#include "ref_vkpt/vulkan/device.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace vkpt {

enum class TraceBackend { software, query, pipeline };

// As in pt_trace and in the names of shaders.
std::string_view name_of(TraceBackend backend);
std::optional<TraceBackend> find_trace_backend(std::string_view name);
// What this device can do; "software" always.
std::vector<TraceBackend> offered_backends(const Device& device);

} // namespace vkpt

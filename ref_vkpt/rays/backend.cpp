// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/rays/backend.hpp"

namespace vkpt {

constexpr TraceBackend all_backends[] = { TraceBackend::software, TraceBackend::query, TraceBackend::pipeline };

std::string_view name_of(TraceBackend backend)
{
    switch (backend) {
    case TraceBackend::software:
        return "software";
    case TraceBackend::query:
        return "query";
    case TraceBackend::pipeline:
        return "pipeline";
    }
    return "";
}

std::optional<TraceBackend> find_trace_backend(std::string_view name)
{
    for (const TraceBackend backend : all_backends)
        if (name == name_of(backend))
            return backend;
    return std::nullopt;
}

std::vector<TraceBackend> offered_backends(const Device& device)
{
    std::vector<TraceBackend> offered { TraceBackend::software };
    if (device.has_ray_query)
        offered.push_back(TraceBackend::query);
    if (device.has_ray_pipeline)
        offered.push_back(TraceBackend::pipeline);
    return offered;
}

} // namespace vkpt

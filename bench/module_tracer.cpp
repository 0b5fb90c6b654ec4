// SPDX-License-Identifier: GPL-2.0-or-later
#include "bench/module_tracer.hpp"

#include "ref_vkpt/engine/contract.hpp"

#include <fmt/format.h>
#include <stdexcept>
#include <unistd.h>

namespace vkpt::tests {

ModuleTracer::ModuleTracer(const std::filesystem::path& map)
    : folder_(std::filesystem::temp_directory_path() / fmt::format("vkpt_trace_bench.{}", getpid()))
{
    std::filesystem::create_directories(folder_ / "baseq2");
    files_ = std::make_unique<client::FileSystem>(folder_, "");
    files_->add_file("maps/bench.bsp", map);
    client::HostOptions options;
    options.module = VKPT_BENCHED_MODULE;
    options.width = options.height = 8;
    options.cvars = { { "pt_trace", "software" } };
    host_ = std::make_unique<client::Host>(options, files_.get());
    const float axis[3] = { 0, 0, 1 };
    host_->module().begin_registration("bench");
    host_->module().set_sky("none", 0, axis);
    host_->module().end_registration();
    draw();
}

ModuleTracer::~ModuleTracer()
{
    host_ = nullptr;
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

// The map alone, from anywhere: nothing moves.
void ModuleTracer::draw()
{
    engine::RefDef view {};
    view.width = view.height = 8;
    view.fov_x = view.fov_y = 90;
    host_->draw_frame(view);
}

std::vector<std::string> ModuleTracer::backends() const
{
    std::vector<std::string> names;
    for (auto name = host_->extension().info().trace_backends; *name; name++)
        names.emplace_back(*name);
    return names;
}

void ModuleTracer::choose(const std::string& backend)
{
    host_->cvars().set("pt_trace", backend);
    draw();
}

std::vector<TracedHit> ModuleTracer::trace(const std::vector<TracedRay>& rays, const TraceRequest& request) const
{
    std::vector<TracedHit> hits(rays.size());
    if (host_->extension().trace_rays(rays.data(), rays.size(), &request, hits.data()) < 0)
        throw std::runtime_error("the module has no map to trace in");
    return hits;
}

double ModuleTracer::bytes_per_triangle() const { return host_->extension().info().structure_bytes_per_triangle; }

} // namespace vkpt::tests

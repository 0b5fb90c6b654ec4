// SPDX-License-Identifier: GPL-2.0-or-later
// Traces rays by the trace backends of the real module, with the map registered as the engine does it.
#pragma once

#include "client/host/host.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace vkpt::tests {

class ModuleTracer {
public:
    explicit ModuleTracer(const std::filesystem::path& map);
    ~ModuleTracer();

    std::vector<std::string> backends() const;
    void choose(const std::string& backend);
    // `rays`: a picture, row by row.
    std::vector<TracedHit> trace(const std::vector<TracedRay>& rays, const TraceRequest& request) const;
    double bytes_per_triangle() const;

private:
    void draw();

    std::filesystem::path folder_; // stands for the game's; removed in the end
    std::unique_ptr<client::FileSystem> files_;
    std::unique_ptr<client::Host> host_;
};

} // namespace vkpt::tests

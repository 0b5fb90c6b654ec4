// SPDX-License-Identifier: GPL-2.0-or-later
// Runs `vkpt` as a user does, in a folder of its own that vanishes afterwards.
#pragma once

#include "common/temporary_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace vkpt::tests {

struct ProgramResult {
    int status = -1; // -1: it did not exit by itself
    std::string output, errors;
    double cpu_seconds = 0;
    double peak_mib = 0; // of memory in use
};

class ScratchFolder {
public:
    const std::filesystem::path& path() const { return folder_.path(); }
    // Creates the folders on the way.
    void write(const std::string& name, const std::string& text) const;
    std::string read(const std::string& name) const;
    std::vector<std::string> names() const; // of everything in it, hidden files too

private:
    TemporaryFolder folder_ { "vkpt-test-" };
};

// environment: "NAME=VALUE" entries added to ours.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
    const std::filesystem::path& folder, const std::vector<std::string>& environment = {});

// A folder with baseq2/maps/NAME.bsp, a small valid map with this entity text.
void write_sample_map(const ScratchFolder& folder, const std::string& name, const std::string& entity_text);

} // namespace vkpt::tests

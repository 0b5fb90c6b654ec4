// SPDX-License-Identifier: GPL-2.0-or-later
// Shaders compiled from a folder of sources (pt_shader_dir) with the options of the build. Reads nothing outside the
// folder, and writes nothing but a temporary folder of its own.
#pragma once

#include "ref_vkpt/vulkan/shaders.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

// Text for who edits shaders: a missing file, a missing compiler, the compiler's own words.
class ShaderError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

class ShaderFolder {
public:
    // A shader's source and all that it includes, each with the time of its last change.
    using Files = std::map<std::string, std::filesystem::file_time_type>;

    // Throws ShaderError: there is no such folder.
    explicit ShaderFolder(const std::filesystem::path& folder);

    std::string path() const { return folder_.string(); }
    // Throws ShaderError where one lies outside the folder.
    Files find_files(std::string_view shader);
    // SPIR-V. Throws ShaderError.
    std::vector<uint32_t> compile(std::string_view shader) const;

private:
    struct File {
        std::filesystem::file_time_type changed;
        std::vector<std::string> includes; // as written
    };
    void collect(const std::filesystem::path& path, const ShaderBuild& build, Files& found);
    const File& look_at(const std::filesystem::path& path);

    std::filesystem::path folder_; // without links
    std::map<std::string, File> known_; // as they were when last looked at
};

} // namespace vkpt

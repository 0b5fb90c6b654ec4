// SPDX-License-Identifier: GPL-2.0-or-later
// A new folder among the temporary files ($TMPDIR), removed with all that is in it at the end of life.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace vkpt {

// Empty, and only its owner may enter. The name begins with `prefix`. Throws std::filesystem::filesystem_error.
inline std::filesystem::path make_temporary_folder(const std::string& prefix)
{
    std::string name = (std::filesystem::temp_directory_path() / (prefix + "XXXXXX")).string();
    if (!mkdtemp(name.data()))
        throw std::filesystem::filesystem_error(
            "cannot make a folder", name, std::error_code(errno, std::generic_category()));
    return name;
}

class TemporaryFolder {
public:
    explicit TemporaryFolder(const std::string& prefix)
        : path_(make_temporary_folder(prefix))
    {
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

} // namespace vkpt

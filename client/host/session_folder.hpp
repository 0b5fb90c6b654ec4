// SPDX-License-Identifier: GPL-2.0-or-later
// A folder among the temporary files that vanishes with its owner, however that ends.
#pragma once

#include <filesystem>
#include <string>

namespace vkpt::client {

class SessionFolder {
public:
    // The name begins with `prefix`. Throws Failure.
    explicit SessionFolder(const std::string& prefix);
    ~SessionFolder();
    SessionFolder(const SessionFolder&) = delete;
    SessionFolder& operator=(const SessionFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    int end_ = -1, cleaner_ = -1;
};

} // namespace vkpt::client

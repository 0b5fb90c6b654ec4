// SPDX-License-Identifier: GPL-2.0-or-later
// Folders for what driver and module compile, for tests about these folders.
#pragma once

#include <filesystem>
#include <string>

namespace vkpt::tests {

// Makes the next session's module use a cache of its own, until the end of life. Where it is new it begins as a copy of
// the one that all sessions share, so that no shader is compiled twice for the tests.
class OwnCache {
public:
    explicit OwnCache(const std::string& name);
    ~OwnCache();
    OwnCache(const OwnCache&) = delete;
    OwnCache& operator=(const OwnCache&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

// For sessions without an own one.
void use_shared_cache();

} // namespace vkpt::tests

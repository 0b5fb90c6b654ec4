// SPDX-License-Identifier: GPL-2.0-or-later
// Files that are only worth something when they are whole: a signal that ends the program (hang-up, interrupt,
// termination) removes them.
#pragma once

#include <filesystem>

namespace vkpt::client {

// From construction to destruction the path is one of them. An empty folder may be one, too; what is in it has to be
// noted later than itself.
class UnfinishedFile {
public:
    explicit UnfinishedFile(const std::filesystem::path& path);
    ~UnfinishedFile();
    UnfinishedFile(const UnfinishedFile&) = delete;
    UnfinishedFile& operator=(const UnfinishedFile&) = delete;

private:
    size_t place_;
};

} // namespace vkpt::client

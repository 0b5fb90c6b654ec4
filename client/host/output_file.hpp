// SPDX-License-Identifier: GPL-2.0-or-later
// A file that appears under its name only when it is whole.
#pragma once

#include "client/host/unfinished_files.hpp"
#include "formats/byte_reader.hpp"

#include <filesystem>
#include <optional>

namespace vkpt::client {

class OutputFile {
public:
    // Creates a hidden neighbour of `path`, so that a place where nothing can be written is found before the work is
    // done. A symbolic link is followed: the file that it leads to is replaced, with its permissions. What is no
    // regular file (a device, a pipe) is opened itself. Throws Failure.
    explicit OutputFile(const std::filesystem::path& path);
    // Removes the neighbour if commit() was not reached.
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(formats::Bytes bytes);
    // The contents of another file.
    void take(const std::filesystem::path& file);
    // Gives the file its name.
    void commit();

private:
    void open_directly();
    void open_neighbour();
    void discard();
    std::filesystem::path follow_links() const;
    [[noreturn]] void fail(int error) const;

    std::filesystem::path path_; // as the user named it
    std::filesystem::path target_; // after symbolic links
    std::filesystem::path working_path_; // empty: written directly
    std::optional<UnfinishedFile> unfinished_;
    int file_ = -1;
};

} // namespace vkpt::client

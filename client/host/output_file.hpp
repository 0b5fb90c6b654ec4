// SPDX-License-Identifier: GPL-2.0-or-later
// A file that appears under its name only when it is whole.
#pragma once

#include "formats/byte_reader.hpp"

#include <filesystem>

namespace vkpt::client {

class OutputFile {
public:
    // Creates a hidden neighbour of `path`, so that a place where nothing can be written is found before the work is
    // done. Throws Failure.
    explicit OutputFile(const std::filesystem::path& path);
    // Removes the neighbour if commit() was not reached.
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    // Where to write, for libraries that open files themselves.
    const std::filesystem::path& working_path() const { return working_path_; }
    void write(formats::Bytes bytes);
    // The contents of another file, which is not empty.
    void take(const std::filesystem::path& file);
    // Gives the file its name.
    void commit();

private:
    [[noreturn]] void fail(int error) const;

    std::filesystem::path path_, working_path_;
    bool is_committed_ = false;
};

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// A folder of results: found out before the work that its files can be written, and each named only when all are whole.
#pragma once

#include "client/host/output_file.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vkpt::client {

class OutputFolder {
public:
    // Makes the folder where it is not there. Throws Failure.
    OutputFolder(const std::filesystem::path& path, const std::vector<std::string>& names);
    // Removes what was not committed, and the folder if it was made for that alone.
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    void write(size_t file, formats::Bytes bytes) { files_[file]->write(bytes); }
    void write(size_t file, const std::string& text) { write(file, std::as_bytes(std::span(text))); }
    void commit();

private:
    void clear();

    std::filesystem::path path_;
    bool is_new_ = false;
    std::optional<UnfinishedFile> unfinished_; // where it is new
    std::vector<std::unique_ptr<OutputFile>> files_;
};

} // namespace vkpt::client

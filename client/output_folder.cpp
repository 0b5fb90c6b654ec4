// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/output_folder.hpp"

#include "client/host/errors.hpp"

#include <fmt/format.h>

namespace vkpt::client {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(const fs::path& path, const std::vector<std::string>& names)
    : path_(path)
{
    std::error_code error;
    is_new_ = fs::create_directories(path, error);
    if (error || !fs::is_directory(path, error))
        throw Failure(fmt::format("-o {}: cannot make this folder: {}; name a writable one", path.string(),
            error ? error.message() : "a file has that name"));
    if (is_new_)
        unfinished_.emplace(path);
    try {
        for (const std::string& name : names)
            files_.push_back(std::make_unique<OutputFile>(path / name));
    } catch (...) {
        clear();
        throw;
    }
}

OutputFolder::~OutputFolder() { clear(); }

void OutputFolder::commit()
{
    for (const auto& file : files_)
        file->commit();
    is_new_ = false;
}

void OutputFolder::clear()
{
    files_.clear();
    std::error_code ignored;
    if (is_new_)
        fs::remove(path_, ignored); // if it is empty
}

} // namespace vkpt::client

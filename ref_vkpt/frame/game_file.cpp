// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/game_file.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>

namespace vkpt {

bool stays_in_game_directory(const std::string& directory)
{
    return !directory.empty() && directory.front() != '/' && directory.find("..") == std::string::npos
        && directory.find('\\') == std::string::npos;
}

namespace {

std::string describe_errno() { return std::error_code(errno, std::generic_category()).message(); }

} // namespace

std::string write_game_file(const std::filesystem::path& path, std::span<const std::byte> bytes)
{
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error)
        return error.message();
    const std::filesystem::path partial = path.string() + ".new";
    errno = 0;
    std::ofstream file(partial, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    file.close(); // a full disk may show only here
    std::string reason = file ? std::string() : describe_errno();
    if (file) {
        std::filesystem::rename(partial, path, error);
        if (error)
            reason = error.message();
    }
    if (!reason.empty())
        std::filesystem::remove(partial, error);
    return reason;
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/files/cache_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace vkpt {

namespace {

constexpr mode_t private_folder = S_IRWXU;

std::string_view variable(const char* name)
{
    const char* text = std::getenv(name);
    return text ? text : "";
}

// Relative paths are ignored, as the XDG base directory specification wants it.
std::filesystem::path default_folder()
{
    if (const std::string_view cache = variable("XDG_CACHE_HOME"); cache.starts_with('/'))
        return std::filesystem::path(cache) / "ref_vkpt";
    if (const std::string_view home = variable("HOME"); home.starts_with('/'))
        return std::filesystem::path(home) / ".cache" / "ref_vkpt";
    return {};
}

// Each missing one with the mode, unlike std::filesystem::create_directories.
void make_folders(const std::filesystem::path& folder)
{
    std::filesystem::path made;
    for (const std::filesystem::path& part : folder)
        if (!part.empty()) {
            made /= part;
            mkdir(made.c_str(), private_folder); // whether the last one is there is looked at afterwards
        }
}

// "": nobody else can have put anything into it.
std::string find_fault(const std::string& folder)
{
    struct stat status { };
    if (lstat(folder.c_str(), &status) != 0)
        return std::error_code(errno, std::generic_category()).message();
    if (S_ISLNK(status.st_mode))
        return "it is a link";
    if (!S_ISDIR(status.st_mode))
        return "it is no folder";
    if (status.st_uid != geteuid())
        return fmt::format("it belongs to another user ({})", status.st_uid);
    if (status.st_mode & (S_IWGRP | S_IWOTH))
        return "it is writable by others; fix that with chmod go-w";
    return "";
}

} // namespace

CacheFolder find_cache_folder()
{
    std::filesystem::path folder(variable("VKPT_CACHE_DIR"));
    if (folder.empty())
        folder = default_folder();
    if (folder.empty())
        return { "", "none of VKPT_CACHE_DIR, XDG_CACHE_HOME and HOME is set" };
    if (!folder.has_filename()) // "DIR/": a link would be followed
        folder = folder.parent_path();
    make_folders(folder);
    const std::string fault = find_fault(folder.string());
    if (fault.empty())
        return { folder.string(), "" };
    return { "", fmt::format("{}: {}; set VKPT_CACHE_DIR to use another folder", folder.string(), fault) };
}

} // namespace vkpt

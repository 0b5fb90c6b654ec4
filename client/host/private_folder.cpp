// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/private_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sys/stat.h>
#include <unistd.h>

namespace vkpt::client {

namespace fs = std::filesystem;

namespace {

bool make_folders(const fs::path& path)
{
    struct stat found { };
    if (path.empty() || stat(path.c_str(), &found) == 0)
        return true;
    return make_folders(path.parent_path()) && (mkdir(path.c_str(), 0700) == 0 || errno == EEXIST);
}

std::string describe_owner(const fs::path& path, const struct stat& found)
{
    return path.string() + " belongs to user " + std::to_string(found.st_uid) + ", not to user "
        + std::to_string(geteuid());
}

// Whoever may rename the folder can put another one in its place after it has been looked at.
std::string find_problem_around(const fs::path& parent)
{
    struct stat found { };
    if (stat(parent.c_str(), &found) != 0)
        return "cannot look at " + parent.string() + ": " + std::strerror(errno);
    if (found.st_uid != geteuid() && found.st_uid != 0)
        return describe_owner(parent, found);
    if ((found.st_mode & S_IWOTH) && !(found.st_mode & S_ISVTX))
        return parent.string() + " is writable by everybody (chmod o-w)";
    return "";
}

std::string find_problem(const fs::path& path)
{
    struct stat found { };
    if (lstat(path.c_str(), &found) != 0)
        return "cannot look at " + path.string() + ": " + std::strerror(errno);
    if (S_ISLNK(found.st_mode))
        return path.string() + " is a symbolic link";
    if (!S_ISDIR(found.st_mode))
        return path.string() + " is no folder";
    if (found.st_uid != geteuid())
        return describe_owner(path, found);
    if (found.st_mode & (S_IWGRP | S_IWOTH))
        return path.string() + " is writable by others (chmod go-w)";
    return "";
}

PrivateFolder refuse(const std::string& reason) { return { {}, reason + "; set XDG_CACHE_HOME to use another place" }; }

} // namespace

PrivateFolder open_private_folder(const fs::path& path)
{
    const fs::path parent = path.parent_path();
    if (!make_folders(parent))
        return refuse("cannot make the folder " + parent.string() + ": " + std::strerror(errno));
    if (const std::string problem = find_problem_around(parent); !problem.empty())
        return refuse(problem);
    if (mkdir(path.c_str(), 0700) != 0 && errno != EEXIST)
        return refuse("cannot make the folder " + path.string() + ": " + std::strerror(errno));
    if (const std::string problem = find_problem(path); !problem.empty())
        return refuse(problem);
    return { path, "" };
}

PrivateFolder open_cache_folder()
{
    const auto absolute = [](const char* name) {
        const char* text = std::getenv(name);
        return text && *text == '/' ? fs::path(text) : fs::path(); // the specification: relative ones do not count
    };
    const fs::path cache = absolute("XDG_CACHE_HOME"), home = absolute("HOME");
    if (cache.empty() && home.empty())
        return refuse("there is no home folder ($HOME)");
    return open_private_folder((cache.empty() ? home / ".cache" : cache) / "vkpt");
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// Folders for what the program keeps for itself from run to run, that nobody else may have put anything into.
#pragma once

#include <filesystem>
#include <string>

namespace vkpt::client {

struct PrivateFolder {
    std::filesystem::path path; // empty: none, do without
    std::string problem; // why, and what to do; empty where there is a path
};

// Makes the folder, and those on the way to it, with mode 0700 where they are missing. One that is there is taken only
// if it is ours: a folder and no link, owned by this process's user, not writable by others; and the folder around it
// is ours or root's.
PrivateFolder open_private_folder(const std::filesystem::path& path);

// "vkpt" below $XDG_CACHE_HOME or else ~/.cache, as the XDG Base Directory Specification has it.
PrivateFolder open_cache_folder();

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// Looks at an archive before PhysicsFS opens it: PhysicsFS takes memory for whatever its directory says.
#pragma once

#include <filesystem>
#include <string>

namespace vkpt::client {

// What is wrong with a PAK or ZIP (PK3) as a whole; empty: nothing. The sizes of single files are checked when these
// are read.
std::string find_archive_fault(const std::filesystem::path& archive);

} // namespace vkpt::client

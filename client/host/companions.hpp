// SPDX-License-Identifier: GPL-2.0-or-later
// The modules that belong to this program.
#pragma once

#include <filesystem>
#include <string>

namespace vkpt::client {

// "ref_vkpt.so" and the like: beside the program as the build has it, or in ../lib/vkpt as an installation has it.
// Throws Failure with the places where it is not, and `remedy`.
std::filesystem::path find_companion(const std::string& name, const std::string& remedy);

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/companions.hpp"

#include "client/host/errors.hpp"

#include <fmt/format.h>

namespace vkpt::client {

namespace fs = std::filesystem;

fs::path find_companion(const std::string& name, const std::string& remedy)
{
    std::error_code ignored;
    const fs::path here = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    std::string looked;
    for (const fs::path& place : { here / name, here.parent_path() / "lib/vkpt" / name }) {
        if (fs::exists(place, ignored))
            return place;
        looked += "\n  " + place.string();
    }
    throw Failure(fmt::format("{} is missing; looked for{}\n{}", name, looked, remedy));
}

} // namespace vkpt::client

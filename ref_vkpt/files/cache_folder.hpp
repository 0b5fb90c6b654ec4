// SPDX-License-Identifier: GPL-2.0-or-later
// Where the module keeps what drivers compiled for it. Drivers run what they find there, so nobody else may have put it
// there: neither another user of the machine nor a server, which can fill the engine's game folder.
#pragma once

#include <string>

namespace vkpt {

struct CacheFolder {
    std::string path; // empty: there is none
    std::string reason; // why not
};

// $VKPT_CACHE_DIR, or ref_vkpt in $XDG_CACHE_HOME or ~/.cache; made, for its owner alone, where it is missing.
CacheFolder find_cache_folder();

} // namespace vkpt

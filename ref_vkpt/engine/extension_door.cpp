// SPDX-License-Identifier: GPL-2.0-or-later
// The module's door for hosts of our own. Modules that only an engine loads go without.
#include "ref_vkpt/engine/exports.hpp"

extern "C" [[gnu::visibility("default")]] const vkpt::Extension* vkpt_extension(uint32_t version)
{
    return version == vkpt::extension_version ? &vkpt::extension_table() : nullptr;
}

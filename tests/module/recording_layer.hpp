// SPDX-License-Identifier: GPL-2.0-or-later
// What the layer VK_LAYER_VKPT_recorder saw of command buffers: work, and barriers between.
#pragma once

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan.h>

#include <string>
#include <vector>

namespace vkpt::tests {

struct RecordedCommand {
    enum Kind { dispatch, trace, build, copy, fill, barrier } kind;
    // Of barriers: what they wait for and make available, and to whom. `global`: to all memory, not only to an image.
    VkPipelineStageFlags from_stages = 0, to_stages = 0;
    VkAccessFlags from_access = 0, to_access = 0;
    bool global = false;
    std::string label; // the debug label that it stands under: the pass
};
using RecordedCommands = std::vector<RecordedCommand>; // of one command buffer, in order

// Symbol "vkpt_take_recorded_commands" of the layer: the command buffers that were submitted since the last call, in
// order, of the first device that the process has made. The caller clears what it was given before it calls again.
using TakeRecordedCommands = void (*)(std::vector<RecordedCommands>& submitted);

} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// What recording_sound.so leaves for `vkpt`: a file of samples, and one beside it that tells where in it each recorded
// frame lies. Both vanish with the recording.
#pragma once

#include <cstdint>

namespace vkpt::client {

// Before the samples: signed, little-endian, the channels of a moment side by side.
struct SoundFileHeader {
    uint32_t rate = 0; // moments a second
    uint16_t channels = 0, bits = 0;
};
static_assert(sizeof(SoundFileHeader) == 8);

// The other file: an int64_t for each frame with a 3D view, the number of moments before it.
inline constexpr const char* sound_views_ending = ".views";

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// WAV files of PCM samples: RIFF, Microsoft's "Multimedia Programming Interface and Data Specifications 1.0" (1991).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace formats {

struct WavFormat {
    uint16_t channels = 1;
    uint32_t rate = 22050; // samples a second of each channel
    uint16_t bits = 16; // of a sample; 16: signed, little-endian, the channels of a moment side by side
};

inline constexpr int64_t max_wav_bytes = 0xffffff00; // of samples; sizes are 32 bits

// Everything before the samples. `further_bytes`: of the chunks that follow them.
std::vector<std::byte> make_wav_header(const WavFormat& format, uint32_t sample_bytes, uint32_t further_bytes = 0);

} // namespace formats

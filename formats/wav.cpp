// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/wav.hpp"

#include "formats/byte_writer.hpp"

namespace formats {

std::vector<std::byte> make_wav_header(const WavFormat& format, uint32_t sample_bytes, uint32_t further_bytes)
{
    constexpr uint32_t bytes_after_size = 36; // of the header
    constexpr uint32_t format_bytes = 16;
    constexpr uint16_t pcm = 1;
    ByteWriter writer;
    const auto write_tag
        = [&](const char(&tag)[5]) { writer.write_bytes(std::as_bytes(std::span(tag)).first(sizeof tag - 1)); };
    const uint16_t moment_bytes = uint16_t(format.channels * format.bits / 8);
    write_tag("RIFF");
    writer.write(bytes_after_size + sample_bytes + further_bytes);
    write_tag("WAVE");
    write_tag("fmt ");
    writer.write(format_bytes);
    writer.write(pcm);
    writer.write(format.channels);
    writer.write(format.rate);
    writer.write(format.rate * moment_bytes);
    writer.write(moment_bytes);
    writer.write(format.bits);
    write_tag("data");
    writer.write(sample_bytes);
    return writer.take();
}

} // namespace formats

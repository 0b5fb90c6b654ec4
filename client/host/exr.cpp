// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/exr.hpp"

#include "client/host/errors.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <fmt/format.h>
#include <string>

namespace vkpt::client {

std::vector<std::byte> write_exr(int width, int height, std::span<const float> rgb)
try {
    std::vector<float> pixels(rgb.begin(), rgb.end());
    Imf::Header header(width, height);
    Imf::FrameBuffer frame;
    const size_t pixel_bytes = 3 * sizeof(float);
    const char* const names[] = { "R", "G", "B" };
    for (size_t channel = 0; channel < 3; channel++) {
        header.channels().insert(names[channel], Imf::Channel(Imf::FLOAT));
        auto* base = reinterpret_cast<char*>(pixels.data() + channel);
        frame.insert(names[channel], Imf::Slice(Imf::FLOAT, base, pixel_bytes, pixel_bytes * size_t(width)));
    }
    Imf::StdOSStream stream;
    {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(height);
    } // the table of lines is written at its end
    const std::string text = stream.str();
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    return { bytes, bytes + text.size() };
} catch (const std::exception& error) {
    throw Failure(fmt::format("cannot make an EXR picture: {}", error.what()));
}

} // namespace vkpt::client

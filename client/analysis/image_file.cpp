// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/analysis/display.hpp"
#include "client/analysis/linear_image.hpp"
#include "client/host/errors.hpp"
#include "common/numbers.hpp"
#include "formats/byte_reader.hpp"
#include "formats/image.hpp"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <string>

namespace vkpt::analysis {

namespace fs = std::filesystem;
using client::Failure;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& why)
{
    throw Failure(fmt::format("cannot read {}: {}", path.string(), why));
}

// Before memory is taken for the pixels: a file may ask for more than it holds.
void check_size(const fs::path& path, size_t file_bytes, int64_t width, int64_t height)
{
    const auto is_possible = [](int64_t n) { return n >= 1 && n <= formats::max_image_size; };
    if (!is_possible(width) || !is_possible(height))
        fail(path,
            fmt::format(
                "it says it has {} x {} pixels; 1 to {} each are read", width, height, formats::max_image_size));
    const size_t pixels = size_t(width) * size_t(height);
    if (pixels > formats::max_pixels_of_any_file && pixels / formats::max_pixels_per_byte > file_bytes)
        fail(path,
            fmt::format("it says it has {} x {} pixels, which its {} bytes cannot hold", width, height, file_bytes));
}

std::vector<std::byte> read_bytes(const fs::path& path)
{
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        fail(path, "it is a folder; name a picture");
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        fail(path, errno ? std::strerror(errno) : "unknown error");
    const std::string text { std::istreambuf_iterator<char>(stream), {} };
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    return { bytes, bytes + text.size() };
}

LinearImage read_png(const fs::path& path)
try {
    const formats::Image picture = formats::read_common_image(read_bytes(path), path.string());
    LinearImage image = make_image(picture.width, picture.height);
    image.is_display = true;
    for (size_t i = 0; i < picture.pixels.size(); i++) {
        const formats::Rgba8 pixel = picture.pixels[i];
        const uint8_t channels[] = { pixel.r, pixel.g, pixel.b };
        for (size_t c = 0; c < 3; c++)
            image.rgb[3 * i + c] = decode_srgb(float(channels[c]) / 255);
    }
    return image;
} catch (const formats::FormatError& error) {
    throw Failure(fmt::format("cannot read {}", error.what()));
}

// The header's words, each ended by one white-space character, which the last one's is the pixels' neighbour.
class PfmHeader {
public:
    PfmHeader(const std::vector<std::byte>& bytes, const fs::path& path)
        : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size())
        , path_(path)
    {
    }
    std::string_view word()
    {
        constexpr const char* spaces = " \t\r\n";
        const size_t start = text_.find_first_not_of(spaces, at_), end = text_.find_first_of(spaces, start);
        if (end == std::string_view::npos)
            fail(path_, "it ends within the header of a PFM");
        at_ = end + 1;
        return text_.substr(start, end - start);
    }
    template <class Number> Number number()
    {
        const std::string_view text = word();
        const std::optional<Number> value = parse_number<Number>(text);
        if (!value)
            fail(path_, fmt::format("\"{}\" in the header is no number", text.substr(0, 20)));
        return *value;
    }
    size_t end() const { return at_; }

private:
    std::string_view text_;
    const fs::path& path_;
    size_t at_ = 0;
};

LinearImage read_pfm(const fs::path& path)
{
    const std::vector<std::byte> bytes = read_bytes(path);
    PfmHeader header(bytes, path);
    const std::string_view kind = header.word();
    if (kind != "PF" && kind != "Pf")
        fail(path, "no portable float map: it does not begin with PF or Pf");
    const auto width = header.number<int64_t>(), height = header.number<int64_t>();
    const double scale = header.number<double>();
    check_size(path, bytes.size(), width, height);
    const size_t channels = kind == "PF" ? 3 : 1;
    const size_t row = size_t(width) * channels, wanted = header.end() + row * size_t(height) * sizeof(float);
    if (bytes.size() < wanted)
        fail(path, fmt::format("{} x {} pixels need {} bytes, it has {}", width, height, wanted, bytes.size()));
    LinearImage image = make_image(int(width), int(height));
    for (size_t y = 0; y < size_t(height); y++)
        for (size_t i = 0; i < size_t(width) * 3; i++) {
            const size_t source = (size_t(height) - 1 - y) * row + (channels == 3 ? i : i / 3); // rows go upwards
            uint32_t bits = 0;
            std::memcpy(&bits, &bytes[header.end() + source * sizeof bits], sizeof bits);
            if (scale > 0) // the sign says the byte order
                bits = __builtin_bswap32(bits);
            image.rgb[y * size_t(width) * 3 + i] = std::bit_cast<float>(bits);
        }
    return image;
}

LinearImage read_exr(const fs::path& path)
{
    const size_t file_bytes = read_bytes(path).size(); // says why where it cannot be opened, which OpenEXR does not
    try {
        Imf::InputFile file(path.c_str(), 1);
        const Imath::Box2i window = file.header().dataWindow();
        const int64_t width = int64_t(window.max.x) - window.min.x + 1,
                      height = int64_t(window.max.y) - window.min.y + 1;
        check_size(path, file_bytes, width, height);
        for (const char* name : { "R", "G", "B" })
            if (!file.header().channels().findChannel(name))
                fail(path, fmt::format("it has no channel {}", name));
        LinearImage image = make_image(int(width), int(height));
        Imf::FrameBuffer frame;
        const size_t pixel_bytes = 3 * sizeof(float);
        const char* const names[] = { "R", "G", "B" };
        for (size_t c = 0; c < 3; c++)
            frame.insert(names[c],
                Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + c, window, pixel_bytes, pixel_bytes * size_t(width)));
        file.setFrameBuffer(frame);
        file.readPixels(window.min.y, window.max.y);
        return image;
    } catch (const Failure&) {
        throw;
    } catch (const std::exception& error) {
        fail(path, error.what());
    }
}

} // namespace

LinearImage read_image(const fs::path& path)
{
    const std::string ending = path.extension().string();
    LinearImage image = ending == ".png" ? read_png(path)
        : ending == ".pfm"               ? read_pfm(path)
        : ending == ".exr"
        ? read_exr(path)
        : throw Failure(fmt::format("cannot read {}: the ending says the format: .png, .pfm or .exr", path.string()));
    const auto nonfinite = std::ranges::count_if(image.rgb, [](float value) { return !std::isfinite(value); });
    if (nonfinite)
        fail(path, fmt::format("{} of {} values are not finite", nonfinite, image.rgb.size()));
    return image;
}

} // namespace vkpt::analysis

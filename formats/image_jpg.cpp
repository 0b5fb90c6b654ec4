// SPDX-License-Identifier: GPL-2.0-or-later
// JPG by libjpeg-turbo.
#include "formats/image_jpg.hpp"
#include "formats/image_size.hpp"

#include <csetjmp>
#include <cstdio> // jpeglib.h needs it

#include <jpeglib.h>

namespace formats {

namespace {

// Every scan of a progressive picture goes over all of its pixels, and a scan of a few bytes is allowed: a small file
// could ask for tens of thousands. Encoders write about ten.
constexpr int max_scans = 50;
// The coefficients of a progressive picture are held until its last scan: six bytes a pixel.
constexpr long max_decoder_bytes = 256L << 20;
// A block of 8 x 8 pixels takes at least two bits a channel, and channels may be stored at a quarter of the size.
constexpr size_t density_limit = 1024; // pixels per byte

// libjpeg's error_exit must not return: it jumps back into the step (open, decode) that was running. These hold nothing
// with a destructor, and no C++ code is between them and the library.
class Decoder {
public:
    Decoder()
    {
        info_.err = jpeg_std_error(&errors_);
        info_.client_data = this;
        errors_.error_exit = [](j_common_ptr info) { fail(info); };
        errors_.emit_message = [](j_common_ptr, int) {}; // warnings: what could be read is shown
        errors_.output_message = [](j_common_ptr) {};
        progress_.progress_monitor = check_scans;
    }
    ~Decoder() { jpeg_destroy_decompress(&info_); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    // False: see reason().
    bool open(Bytes file)
    {
        if (setjmp(failed_))
            return false;
        jpeg_create_decompress(&info_);
        info_.progress = &progress_;
        info_.mem->max_memory_to_use = max_decoder_bytes;
        jpeg_mem_src(&info_, reinterpret_cast<const unsigned char*>(file.data()), file.size());
        jpeg_read_header(&info_, TRUE);
        return true;
    }

    bool decode(Rgba8* pixels)
    {
        if (setjmp(failed_))
            return false;
        info_.out_color_space = is_cmyk() ? JCS_CMYK : JCS_EXT_RGBA;
        info_.do_block_smoothing = FALSE;
        jpeg_start_decompress(&info_);
        while (info_.output_scanline < info_.output_height) {
            auto* row = reinterpret_cast<JSAMPROW>(pixels + size_t(info_.output_scanline) * info_.output_width);
            jpeg_read_scanlines(&info_, &row, 1);
        }
        return true;
    }

    int64_t width() const { return info_.image_width; }
    int64_t height() const { return info_.image_height; }
    bool is_cmyk() const { return info_.jpeg_color_space == JCS_CMYK || info_.jpeg_color_space == JCS_YCCK; }
    bool is_arithmetic() const { return info_.arith_code; }
    const char* reason() const { return reason_; }

private:
    static void fail(j_common_ptr info)
    {
        Decoder& decoder = *static_cast<Decoder*>(info->client_data);
        info->err->format_message(info, decoder.reason_);
        std::longjmp(decoder.failed_, 1);
    }

    static void check_scans(j_common_ptr info)
    {
        Decoder& decoder = *static_cast<Decoder*>(info->client_data);
        if (decoder.info_.input_scan_number <= max_scans)
            return;
        std::snprintf(decoder.reason_, sizeof(decoder.reason_), "more than %d scans", max_scans);
        std::longjmp(decoder.failed_, 1);
    }

    jpeg_decompress_struct info_ {};
    jpeg_error_mgr errors_ {};
    jpeg_progress_mgr progress_ {};
    std::jmp_buf failed_ {};
    char reason_[JMSG_LENGTH_MAX] {};
};

// As every program stores it: inverted.
void convert_cmyk(std::vector<Rgba8>& pixels)
{
    const auto product = [](int a, int b) { return uint8_t((a * b + 127) / 255); };
    for (Rgba8& p : pixels)
        p = { product(p.r, p.a), product(p.g, p.a), product(p.b, p.a), 255 };
}

} // namespace

bool is_jpg(Bytes file) { return file.size() >= 2 && file[0] == std::byte { 0xff } && file[1] == std::byte { 0xd8 }; }

Image read_jpg(Bytes file, std::string_view name, size_t room)
{
    const ByteReader reader(file, name);
    const auto fail = [&](std::string_view reason) { reader.fail_at(0, "JPG: " + std::string(reason)); };
    Decoder decoder;
    if (!decoder.open(file))
        fail(decoder.reason());
    if (decoder.is_arithmetic()) // takes seconds for a picture without data, and no program writes it
        fail("arithmetic coding is not supported; save it as a baseline or progressive JPG");
    check_image_size(reader, 0, decoder.width(), decoder.height());
    check_pixel_budget(reader, decoder.width(), decoder.height(), room);
    if (size_t(decoder.width() * decoder.height()) / density_limit > file.size())
        fail_too_little_data(reader, decoder.width(), decoder.height());
    Image image { int(decoder.width()), int(decoder.height()), {} };
    image.pixels.resize(size_t(image.width) * size_t(image.height));
    if (!decoder.decode(image.pixels.data()))
        fail(decoder.reason());
    if (decoder.is_cmyk())
        convert_cmyk(image.pixels);
    return image;
}

} // namespace formats

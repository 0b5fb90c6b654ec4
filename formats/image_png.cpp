// SPDX-License-Identifier: GPL-2.0-or-later
// PNG by libpng: reading. Wrong checksums are tolerated, as the engine does.
#include "formats/image_png.hpp"
#include "formats/image_size.hpp"

#include <algorithm>
#include <csetjmp>
#include <cstring>

#include <png.h>

namespace formats {

namespace {

constexpr std::array<uint8_t, 8> signature { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
// Bytes out of one byte in: 1032 by the compressed format.
constexpr size_t deflate_limit = 1040;

// libpng's error function must not return: it jumps back into the step (open, decode) that was running. These hold
// nothing with a destructor, and no C++ code is between them and the library.
class Decoder {
public:
    explicit Decoder(Bytes file)
        : file_(file)
    {
        png_ = png_create_read_struct(
            PNG_LIBPNG_VER_STRING, this, fail, [](png_structp, png_const_charp) { /* what could be read is shown */ });
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_) {
            png_destroy_read_struct(&png_, &info_, nullptr);
            throw std::bad_alloc(); // its only reason to fail
        }
    }
    ~Decoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    // False: see reason() and position().
    bool open()
    {
        if (setjmp(failed_))
            return false;
        png_set_read_fn(png_, this, read);
        png_set_user_limits(png_, max_image_size, max_image_size);
        png_set_crc_action(png_, PNG_CRC_QUIET_USE, PNG_CRC_QUIET_USE);
#ifdef PNG_IGNORE_ADLER32 // libpng may be built without (Debian 13)
        png_set_option(png_, PNG_IGNORE_ADLER32, PNG_OPTION_ON);
#endif
        // Texts, profiles and the like are passed over: some are compressed, and their unpacked size is the file's
        // choice.
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_read_info(png_, info_);
        return true;
    }

    bool decode(Rgba8* pixels)
    {
        if (setjmp(failed_))
            return false;
        png_set_expand(png_); // palettes, grey of a few bits, transparent colours
        png_set_strip_16(png_);
        png_set_gray_to_rgb(png_);
        png_set_add_alpha(png_, 0xff, PNG_FILLER_AFTER);
        const int passes = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        if (png_get_rowbytes(png_, info_) != size_t(width()) * sizeof(Rgba8))
            png_error(png_, "unknown pixel format");
        for (int pass = 0; pass < passes; pass++)
            for (size_t y = 0; y < size_t(height()); y++)
                png_read_row(png_, reinterpret_cast<png_bytep>(pixels + y * size_t(width())), nullptr);
        return true;
    }

    int64_t width() const { return png_get_image_width(png_, info_); }
    int64_t height() const { return png_get_image_height(png_, info_); }
    size_t row_bytes() const { return png_get_rowbytes(png_, info_); } // before decode(): as stored
    size_t position() const { return position_; }
    const char* reason() const { return reason_.data(); }

private:
    [[noreturn]] static void fail(png_structp png, png_const_charp reason)
    {
        Decoder& decoder = *static_cast<Decoder*>(png_get_error_ptr(png));
        std::strncpy(decoder.reason_.data(), reason, decoder.reason_.size() - 1);
        std::longjmp(decoder.failed_, 1);
    }

    static void read(png_structp png, png_bytep to, size_t size)
    {
        Decoder& decoder = *static_cast<Decoder*>(png_get_io_ptr(png));
        if (size > decoder.file_.size() - decoder.position_)
            png_error(png, "the file ends within a chunk");
        std::memcpy(to, decoder.file_.data() + decoder.position_, size);
        decoder.position_ += size;
    }

    Bytes file_;
    size_t position_ = 0;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::jmp_buf failed_ {};
    std::array<char, 128> reason_ {};
};

} // namespace

bool is_png(Bytes file)
{
    return file.size() >= signature.size() && std::memcmp(file.data(), signature.data(), signature.size()) == 0;
}

Image read_png(Bytes file, std::string_view name, size_t room)
{
    const ByteReader reader(file, name);
    Decoder decoder(file);
    const auto fail = [&] { reader.fail_at(decoder.position(), "PNG: " + std::string(decoder.reason())); };
    if (!decoder.open())
        fail();
    check_image_size(reader, 16, decoder.width(), decoder.height());
    check_pixel_budget(reader, decoder.width(), decoder.height(), room);
    if ((decoder.row_bytes() + 1) * size_t(decoder.height()) / deflate_limit > file.size())
        fail_too_little_data(reader, decoder.width(), decoder.height());
    Image image { int(decoder.width()), int(decoder.height()), {} };
    image.pixels.resize(size_t(image.width) * size_t(image.height));
    if (!decoder.decode(image.pixels.data()))
        fail();
    return image;
}

} // namespace formats

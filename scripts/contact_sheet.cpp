// SPDX-License-Identifier: GPL-2.0-or-later
// Many pictures on one sheet: contact_sheet SHEET.png PICTURE...
#include "formats/image.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr int thumbnail_width = 320;
constexpr int gap = 6;
constexpr formats::Rgba8 paper { 24, 24, 24, 255 };

std::vector<std::byte> read_file(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw std::runtime_error(path + ": cannot be opened");
    const std::vector<char> text { std::istreambuf_iterator<char>(file), {} };
    std::vector<std::byte> bytes(text.size());
    std::transform(text.begin(), text.end(), bytes.begin(), [](char c) { return std::byte(c); });
    return bytes;
}

// The average of the source pixels that pixel `place` of `count` covers, in sRGB values: good enough for a thumbnail.
formats::Rgba8 average_box(const formats::Image& image, int x, int y, int width, int height)
{
    const int left = x * image.width / width, right = std::max(left + 1, (x + 1) * image.width / width);
    const int top = y * image.height / height, bottom = std::max(top + 1, (y + 1) * image.height / height);
    int red = 0, green = 0, blue = 0;
    for (int row = top; row < bottom; row++)
        for (int column = left; column < right; column++) {
            const formats::Rgba8 pixel = image.at(column, row);
            red += pixel.r;
            green += pixel.g;
            blue += pixel.b;
        }
    const int count = (right - left) * (bottom - top);
    return { uint8_t(red / count), uint8_t(green / count), uint8_t(blue / count), 255 };
}

void make_sheet(const std::string& sheet_path, const std::vector<std::string>& picture_paths)
{
    const int columns = int(std::ceil(std::sqrt(double(picture_paths.size()))));
    const int rows = (int(picture_paths.size()) + columns - 1) / columns;
    formats::Image sheet;
    int thumbnail_height = 0;
    for (int i = 0; i < int(picture_paths.size()); i++) {
        const auto bytes = read_file(picture_paths[size_t(i)]);
        const formats::Image picture = formats::read_common_image(bytes, picture_paths[size_t(i)]);
        if (i == 0) { // all have the first one's shape
            thumbnail_height = std::max(1, thumbnail_width * picture.height / picture.width);
            sheet.width = gap + columns * (thumbnail_width + gap);
            sheet.height = gap + rows * (thumbnail_height + gap);
            sheet.pixels.assign(size_t(sheet.width) * size_t(sheet.height), paper);
        }
        const int left = gap + i % columns * (thumbnail_width + gap),
                  top = gap + i / columns * (thumbnail_height + gap);
        for (int y = 0; y < thumbnail_height; y++)
            for (int x = 0; x < thumbnail_width; x++)
                sheet.pixels[size_t(top + y) * size_t(sheet.width) + size_t(left + x)]
                    = average_box(picture, x, y, thumbnail_width, thumbnail_height);
    }
    const auto png = formats::write_png(sheet);
    std::ofstream file(sheet_path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(png.data()), std::streamsize(png.size()));
    if (!file.flush())
        throw std::runtime_error(sheet_path + ": cannot be written");
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 3) {
        std::fprintf(stderr, "usage: contact_sheet SHEET.png PICTURE...\n");
        return 2;
    }
    try {
        make_sheet(argv[1], { argv + 2, argv + argc });
    } catch (const std::exception& error) {
        std::fprintf(stderr, "contact_sheet: %s\n", error.what());
        return 1;
    }
}

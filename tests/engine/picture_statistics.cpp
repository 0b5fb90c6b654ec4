// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/engine/picture_statistics.hpp"

#include "common/colour.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>

namespace vkpt::tests {

namespace {

// Rec. 709 weights on encoded values.
double luminance(formats::Rgba8 pixel) { return vkpt::luminance<double>(pixel.r, pixel.g, pixel.b) / 255.0; }

double estimate_noise(const formats::Image& picture)
{
    if (picture.width < 3 || picture.height < 3)
        return 0;
    constexpr int weights[3][3] = { { 1, -2, 1 }, { -2, 4, -2 }, { 1, -2, 1 } };
    double sum = 0;
    for (int y = 1; y + 1 < picture.height; y++)
        for (int x = 1; x + 1 < picture.width; x++) {
            double answer = 0;
            for (int dy = -1; dy <= 1; dy++)
                for (int dx = -1; dx <= 1; dx++)
                    answer += weights[dy + 1][dx + 1] * luminance(picture.at(x + dx, y + dy));
            sum += std::abs(answer);
        }
    const double count = double(picture.width - 2) * double(picture.height - 2);
    return std::sqrt(std::numbers::pi / 2) * sum / (6 * count); // 6: the filter's gain for white noise
}

} // namespace

PictureStatistics measure_picture(const formats::Image& picture)
{
    PictureStatistics statistics;
    double sum = 0, squares = 0, black = 0;
    for (const formats::Rgba8 pixel : picture.pixels) {
        const double value = luminance(pixel);
        sum += value;
        squares += value * value;
        black += value == 0 ? 1 : 0;
    }
    const double count = double(picture.pixels.size());
    statistics.mean = sum / count;
    statistics.deviation = std::sqrt(std::max(0.0, squares / count - statistics.mean * statistics.mean));
    statistics.noise = estimate_noise(picture);
    statistics.black = black / count;
    return statistics;
}

formats::Image load_picture(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw std::runtime_error(path.string() + ": cannot be opened");
    const std::vector<char> text { std::istreambuf_iterator<char>(file), {} };
    std::vector<std::byte> bytes(text.size());
    std::transform(text.begin(), text.end(), bytes.begin(), [](char c) { return std::byte(c); });
    return formats::read_common_image(bytes, path.string());
}

std::vector<std::filesystem::path> list_pictures(const std::filesystem::path& folder)
{
    std::vector<std::filesystem::path> pictures;
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ".png")
                pictures.push_back(entry.path());
    std::sort(pictures.begin(), pictures.end());
    return pictures;
}

} // namespace vkpt::tests

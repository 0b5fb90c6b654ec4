// SPDX-License-Identifier: GPL-2.0-or-later
// How far pictures are from a reference: picture_error REFERENCE.pfm PICTURE.pfm...
// Prints, over all pictures together, the root mean square error and the mean of their difference, both of luminance
// and relative to the reference's mean; and the mean square of the error relative to each pixel.
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

struct Picture {
    int width = 0, height = 0;
    std::vector<float> luminance;
};

// Little-endian colour PFM, as vkpt writes it.
Picture read_pfm(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    std::string kind;
    Picture picture;
    double scale = 0;
    file >> kind >> picture.width >> picture.height >> scale;
    file.get();
    constexpr int most = 1 << 15;
    if (!file || kind != "PF" || !(scale < 0) || picture.width < 1 || picture.height < 1 || picture.width > most
        || picture.height > most)
        throw std::runtime_error(path + ": no little-endian colour PFM; `vkpt render -o FILE.pfm` writes one");
    std::vector<float> rgb(3 * size_t(picture.width) * size_t(picture.height));
    file.read(reinterpret_cast<char*>(rgb.data()), std::streamsize(rgb.size() * sizeof(float)));
    if (!file)
        throw std::runtime_error(path + ": ends early");
    for (size_t i = 0; i < rgb.size(); i += 3)
        picture.luminance.push_back(0.2126f * rgb[i] + 0.7152f * rgb[i + 1] + 0.0722f * rgb[i + 2]);
    return picture;
}

void compare(const std::string& reference_path, const std::vector<std::string>& paths)
{
    const Picture reference = read_pfm(reference_path);
    const double n = double(reference.luminance.size());
    double mean = 0;
    for (const float value : reference.luminance)
        mean += double(value) / n;
    double squares = 0, relative = 0, difference = 0;
    for (const std::string& path : paths) {
        const Picture picture = read_pfm(path);
        if (picture.width != reference.width || picture.height != reference.height)
            throw std::runtime_error(path + ": another size than " + reference_path);
        for (size_t i = 0; i < reference.luminance.size(); i++) {
            const double truth = double(reference.luminance[i]), error = double(picture.luminance[i]) - truth;
            squares += error * error;
            relative += error * error / (truth * truth + 1e-4 * mean * mean);
            difference += error;
        }
    }
    const double count = n * double(paths.size());
    std::printf("rmse %.3f  relative_mse %.2f  mean_difference %+.4f\n", std::sqrt(squares / count) / mean,
        relative / count, difference / count / mean);
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 3) {
        std::fprintf(stderr, "usage: picture_error REFERENCE.pfm PICTURE.pfm...\n");
        return 2;
    }
    try {
        compare(argv[1], { argv + 2, argv + argc });
    } catch (const std::exception& error) {
        std::fprintf(stderr, "picture_error: %s\n", error.what());
        return 1;
    }
}

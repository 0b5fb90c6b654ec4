// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/analysis/linear_image.hpp"

#include <stdexcept>

namespace vkpt::analysis {

LinearImage make_image(int width, int height)
{
    LinearImage image { width, height, {} };
    image.rgb.assign(3 * image.pixel_count(), 0.0f);
    return image;
}

std::vector<float> luminances(const LinearImage& image)
{
    std::vector<float> values(image.pixel_count());
    for (size_t i = 0; i < values.size(); i++)
        values[i] = luminance(&image.rgb[3 * i]);
    return values;
}

double mean_luminance(const LinearImage& image)
{
    double sum = 0;
    for (size_t i = 0; i < image.pixel_count(); i++)
        sum += double(luminance(&image.rgb[3 * i]));
    return image.pixel_count() ? sum / double(image.pixel_count()) : 0;
}

void add_image(LinearImage& sum, const LinearImage& image)
{
    if (sum.rgb.empty())
        sum = make_image(image.width, image.height);
    if (sum.width != image.width || sum.height != image.height)
        throw std::invalid_argument("add_image: pictures of different sizes");
    for (size_t i = 0; i < sum.rgb.size(); i++)
        sum.rgb[i] += image.rgb[i];
}

void scale_image(LinearImage& image, float factor)
{
    for (float& value : image.rgb)
        value *= factor;
}

} // namespace vkpt::analysis

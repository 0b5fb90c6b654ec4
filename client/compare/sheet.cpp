// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/compare/sheet.hpp"

#include "client/analysis/display.hpp"

#include <algorithm>
#include <cmath>

namespace vkpt::client {

namespace {

constexpr int gap = 6; // pixels
constexpr formats::Rgba8 paper { 24, 24, 24, 255 };

} // namespace

formats::Image make_sheet(const SceneResult& scene)
{
    std::vector<const analysis::LinearImage*> pictures;
    for (const VariantResult& result : scene.variants)
        pictures.push_back(&result.picture);
    pictures.push_back(&scene.reference.image);
    const int count = int(pictures.size()), columns = int(std::ceil(std::sqrt(double(count))));
    const int rows = (count + columns - 1) / columns, width = pictures[0]->width, height = pictures[0]->height;
    formats::Image sheet { gap + columns * (width + gap), gap + rows * (height + gap), {} };
    sheet.pixels.assign(size_t(sheet.width) * size_t(sheet.height), paper);
    for (int i = 0; i < count; i++) {
        const formats::Image picture = encode_display(map_to_display(*pictures[size_t(i)], scene.exposure));
        const int left = gap + i % columns * (width + gap), top = gap + i / columns * (height + gap);
        for (int y = 0; y < height; y++)
            std::copy_n(&picture.at(0, y), width, &sheet.pixels[size_t(top + y) * size_t(sheet.width) + size_t(left)]);
    }
    return sheet;
}

} // namespace vkpt::client

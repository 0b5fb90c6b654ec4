// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/bright_parts.hpp"

#include "common/colour.hpp"

#include <algorithm>
#include <utility>

namespace vkpt {

namespace {

constexpr int max_side = 32; // cells
constexpr float min_brightness = 0.3f;
constexpr size_t max_count = 4;
constexpr float max_area = 0.5f;
constexpr float min_share = 0.6f;

// The texture in a few cells, each the sum of the light of its texels.
struct Cells {
    Cells(const formats::Image& image, AlphaMeaning alpha)
        : width(std::min(image.width, max_side))
        , height(std::min(image.height, max_side))
        , light(size_t(width) * size_t(height))
    {
        std::vector<int> column(size_t(image.width)); // no division a texel
        for (int x = 0; x < image.width; x++)
            column[size_t(x)] = x * width / image.width;
        for (int y = 0; y < image.height; y++) {
            glm::vec3* const row = &at(0, y * height / image.height);
            for (int x = 0; x < image.width; x++) {
                const formats::Rgba8& texel = image.at(x, y);
                const float opacity = alpha == AlphaMeaning::opacity ? float(texel.a) / 255 : 1;
                row[column[size_t(x)]] += decode_colour(texel) * opacity;
            }
        }
        const float texels = float(image.width) * float(image.height) / float(width * height);
        for (glm::vec3& cell : light)
            cell /= texels;
    }
    glm::vec3& at(int x, int y) { return light[size_t(y) * size_t(width) + size_t(x)]; }

    int width, height;
    std::vector<glm::vec3> light; // averages
};

// Cells [x0, x1) x [y0, y1).
struct CellBox {
    int x0, y0, x1, y1;
    bool overlaps(const CellBox& other) const
    {
        return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
    }
    void include(const CellBox& other)
    {
        *this = { std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1), std::max(y1, other.y1) };
    }
    int area() const { return (x1 - x0) * (y1 - y0); }
};

// Around the bright cells that hang together with (x, y), which are struck from `bright`.
CellBox flood(const Cells& cells, std::vector<bool>& bright, int x, int y)
{
    CellBox box { x, y, x + 1, y + 1 };
    std::vector<std::pair<int, int>> open { { x, y } };
    while (!open.empty()) {
        const auto [cx, cy] = open.back();
        open.pop_back();
        if (cx < 0 || cy < 0 || cx >= cells.width || cy >= cells.height)
            continue;
        const size_t index = size_t(cy) * size_t(cells.width) + size_t(cx);
        if (!bright[index])
            continue;
        bright[index] = false;
        box.include({ cx, cy, cx + 1, cy + 1 });
        for (const auto& [dx, dy] : { std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1) })
            open.emplace_back(cx + dx, cy + dy);
    }
    return box;
}

std::vector<CellBox> find_boxes(const Cells& cells)
{
    float brightest = 0;
    for (const glm::vec3& cell : cells.light)
        brightest = std::max(brightest, luminance(cell));
    std::vector<bool> bright(cells.light.size());
    for (size_t i = 0; i < bright.size(); i++)
        bright[i] = brightest > 0 && luminance(cells.light[i]) >= min_brightness * brightest;
    std::vector<CellBox> boxes;
    for (int y = 0; y < cells.height; y++)
        for (int x = 0; x < cells.width; x++) {
            if (!bright[size_t(y) * size_t(cells.width) + size_t(x)])
                continue;
            CellBox box = flood(cells, bright, x, y);
            // One that grows may come to overlap those before.
            for (auto other = boxes.begin(); other != boxes.end();)
                if (box.overlaps(*other)) {
                    box.include(*other);
                    boxes.erase(other);
                    other = boxes.begin();
                } else {
                    ++other;
                }
            boxes.push_back(box);
        }
    return boxes;
}

} // namespace

std::vector<BrightPart> find_bright_parts(const formats::Image& image, AlphaMeaning alpha)
{
    if (image.width < 4 || image.height < 4)
        return {};
    Cells cells(image, alpha);
    const std::vector<CellBox> boxes = find_boxes(cells);
    if (boxes.size() > max_count)
        return {};
    glm::vec3 all(0), held(0);
    for (const glm::vec3& cell : cells.light)
        all += cell;
    std::vector<BrightPart> parts;
    int area = 0;
    const glm::vec2 size(cells.width, cells.height);
    for (const CellBox& box : boxes) {
        glm::vec3 sum(0);
        for (int y = box.y0; y < box.y1; y++)
            for (int x = box.x0; x < box.x1; x++)
                sum += cells.at(x, y);
        held += sum;
        area += box.area();
        parts.push_back(
            { glm::vec2(box.x0, box.y0) / size, glm::vec2(box.x1, box.y1) / size, sum / float(box.area()) });
    }
    if (float(area) > max_area * size.x * size.y || luminance(held) < min_share * luminance(all))
        return {};
    return parts;
}

formats::Image keep_bright_texels(formats::Image image, int threshold)
{
    for (formats::Rgba8& texel : image.pixels)
        if (std::max({ texel.r, texel.g, texel.b }) < threshold)
            texel = { 0, 0, 0, texel.a };
    return image;
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/split.hpp"

#include <algorithm>
#include <cmath>

namespace vkpt::client::view {

namespace {

constexpr float grip = 6; // pixels to either side of the divider
constexpr float min_share = 0.02f;
constexpr formats::Rgba8 line_colour { 255, 255, 255, 255 };

} // namespace

bool Area::contains(glm::vec2 point) const
{
    return point.x >= x && point.y >= y && point.x < x + width && point.y < y + height;
}

Area fit_picture(const Area& room, glm::ivec2 picture)
{
    if (picture.x <= 0 || picture.y <= 0 || room.width < 1 || room.height < 1)
        return { room.x, room.y, 0, 0 };
    constexpr float little = 1.1f;
    float scale = std::min(room.width / float(picture.x), room.height / float(picture.y));
    if (scale >= 1 && scale < little)
        scale = 1;
    Area area;
    area.width = std::max(std::floor(float(picture.x) * scale), 1.0f);
    area.height = std::max(std::floor(float(picture.y) * scale), 1.0f);
    area.x = room.x + std::floor((room.width - area.width) / 2);
    area.y = room.y + std::floor((room.height - area.height) / 2);
    return area;
}

std::optional<glm::ivec2> find_pixel(const Area& shown, glm::ivec2 picture, glm::vec2 point)
{
    if (!shown.contains(point))
        return std::nullopt;
    const glm::ivec2 pixel(
        (point.x - shown.x) / shown.width * float(picture.x), (point.y - shown.y) / shown.height * float(picture.y));
    return glm::ivec2(std::clamp(pixel.x, 0, picture.x - 1), std::clamp(pixel.y, 0, picture.y - 1));
}

void Split::set_place(float place) { place_ = std::clamp(place, min_share, 1 - min_share); }

int Split::columns_of_a(int width) const
{
    return is_on ? std::clamp(int(std::lround(place_ * float(width))), 0, width) : width;
}

float Split::divider(const Area& shown) const { return shown.x + place_ * shown.width; }

bool Split::is_at_divider(const Area& shown, glm::vec2 point) const
{
    return is_on && shown.contains(point) && std::abs(point.x - divider(shown)) <= grip;
}

void Split::drag_to(const Area& shown, glm::vec2 point)
{
    if (is_dragged_ && shown.width > 0)
        set_place((point.x - shown.x) / shown.width);
}

formats::Image compose(const formats::Image& a, const formats::Image& b, const Split& split)
{
    formats::Image result = a;
    if (!split.is_on || b.width != a.width || b.height != a.height)
        return result;
    const int first_of_b = split.columns_of_a(a.width);
    for (int y = 0; y < a.height; y++) {
        const size_t row = size_t(y) * size_t(a.width);
        for (int x = first_of_b; x < a.width; x++)
            result.pixels[row + size_t(x)] = x == first_of_b ? line_colour : b.pixels[row + size_t(x)];
    }
    return result;
}

} // namespace vkpt::client::view

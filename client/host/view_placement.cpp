// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/view_placement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace vkpt::client {

namespace {

float fit(int from, int to) { return float(to) / float(from); }

// Of the opening angle that goes with `angle` in degrees when the picture is `factor` times as wide.
float widen(float angle, float factor)
{
    constexpr float degrees = 180 / std::numbers::pi_v<float>;
    return 2 * std::atan(std::tan(angle / degrees / 2) * factor) * degrees;
}

} // namespace

ViewPlacement::ViewPlacement(int from_width, int from_height, int to_width, int to_height)
    : from_width_(from_width)
    , from_height_(from_height)
    , to_width_(to_width)
    , to_height_(to_height)
    , scale_(std::min(fit(from_width, to_width), fit(from_height, to_height)))
    , left_((float(to_width) - scale_ * float(from_width)) / 2)
    , top_((float(to_height) - scale_ * float(from_height)) / 2)
{
}

int ViewPlacement::place_x(int x) const { return int(std::lround(left_ + scale_ * float(x))); }
int ViewPlacement::place_y(int y) const { return int(std::lround(top_ + scale_ * float(y))); }

Rectangle ViewPlacement::place(const Rectangle& from) const
{
    const int left = from.x <= 0 ? std::min(place_x(from.x), 0) : place_x(from.x);
    const int top = from.y <= 0 ? std::min(place_y(from.y), 0) : place_y(from.y);
    const int64_t from_right = int64_t(from.x) + from.width, from_bottom = int64_t(from.y) + from.height;
    const int right = from_right == from_width_ ? to_width_ : place_x(int(from_right));
    const int bottom = from_bottom == from_height_ ? to_height_ : place_y(int(from_bottom));
    return { left, top, right - left, bottom - top };
}

void ViewPlacement::place_view(engine::RefDef& refdef) const
{
    if (from_width_ == to_width_ && from_height_ == to_height_)
        return;
    const float x = fit(from_width_, to_width_), y = fit(from_height_, to_height_);
    refdef.x = int(std::lround(float(refdef.x) * x));
    refdef.y = int(std::lround(float(refdef.y) * y));
    refdef.width = std::max(int(std::lround(float(refdef.width) * x)), 1);
    refdef.height = std::max(int(std::lround(float(refdef.height) * y)), 1);
    if (x != y)
        refdef.fov_x = widen(refdef.fov_x, x / y);
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// Shows what was recorded in a window of one size in a picture of another. 2D keeps its proportions and is centred;
// what reached the window's edges reaches the picture's.
#pragma once

#include "ref_vkpt/engine/contract.hpp"

namespace vkpt::client {

struct Rectangle {
    int x = 0, y = 0, width = 0, height = 0; // pixels
};

class ViewPlacement {
public:
    // The same size: everything stays as it is, bit by bit.
    ViewPlacement(int from_width, int from_height, int to_width, int to_height);

    float scale() const { return scale_; } // of pictures and letters
    int place_x(int x) const;
    int place_y(int y) const;
    Rectangle place(const Rectangle& from) const;
    // The view's rectangle and its angles: the vertical one stays, a wider picture sees more at the sides.
    void place_view(engine::RefDef& refdef) const;

private:
    int from_width_, from_height_, to_width_, to_height_;
    float scale_, left_, top_;
};

} // namespace vkpt::client

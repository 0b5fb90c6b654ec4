// SPDX-License-Identifier: GPL-2.0-or-later
// Where the picture lies in the window, and the divider between side A on its left and side B on its right.
#pragma once

#include "formats/image.hpp"

#include <glm/vec2.hpp>
#include <optional>

namespace vkpt::client::view {

// Window pixels.
struct Area {
    float x = 0, y = 0, width = 0, height = 0;
    bool contains(glm::vec2 point) const;
};

// The largest area of the picture's proportions in the middle of `room`; whole numbers, so that nothing blurs. The
// picture's own size where it has room for no more than a little enlargement.
Area fit_picture(const Area& room, glm::ivec2 picture);

// The picture's pixel under a point of the window; nothing: the point lies beside it.
std::optional<glm::ivec2> find_pixel(const Area& shown, glm::ivec2 picture, glm::vec2 point);

class Split {
public:
    bool is_on = false;

    float place() const { return place_; } // share of the picture's width that is side A's
    void set_place(float place);
    // Columns of a picture of this width that are side A's: all of them while the split is off.
    int columns_of_a(int width) const;
    // The divider in the window, in the middle of its line.
    float divider(const Area& shown) const;
    // Whether the divider can be taken hold of there.
    bool is_at_divider(const Area& shown, glm::vec2 point) const;
    // A drag goes on until it is ended, wherever the mouse goes.
    void begin_drag() { is_dragged_ = true; }
    void drag_to(const Area& shown, glm::vec2 point);
    void end_drag() { is_dragged_ = false; }
    bool is_dragged() const { return is_dragged_; }

private:
    float place_ = 0.5f;
    bool is_dragged_ = false;
};

// The picture as the window shows it: side A left of the divider, a line, side B. Both are of one size.
formats::Image compose(const formats::Image& a, const formats::Image& b, const Split& split);

} // namespace vkpt::client::view

// SPDX-License-Identifier: GPL-2.0-or-later
// pt_menu: this renderer's settings on the screen, over the running game.
#pragma once

#include "ref_vkpt/overlay/key_filter.hpp"
#include "ref_vkpt/overlay/panel.hpp"

#include <string>
#include <vector>

namespace vkpt {

class SettingsMenu {
public:
    bool is_open() const { return is_open_; }
    void toggle();
    // `frame_milliseconds`: what a frame takes now; it stands beside the menu until the next change.
    void press(MenuKey key, double frame_milliseconds);
    // `is_covered`: the engine has the keys.
    std::vector<PanelLine> describe(double frame_milliseconds, bool is_covered) const;

private:
    void change(int direction);

    bool is_open_ = false;
    size_t row_ = 0;
    double before_ = 0; // milliseconds of a frame before the last change; 0: there was none
};

} // namespace vkpt

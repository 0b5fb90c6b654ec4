// SPDX-License-Identifier: GPL-2.0-or-later
// pt_menu: this renderer's settings on the screen, over the running game.
#pragma once

#include "ref_vkpt/overlay/change_times.hpp"
#include "ref_vkpt/overlay/key_filter.hpp"
#include "ref_vkpt/overlay/panel.hpp"

#include <string>
#include <vector>

namespace vkpt {

class SettingsMenu {
public:
    SettingsMenu();

    bool is_open() const { return is_open_; }
    void toggle();
    // What a frame took on the device, whether the menu is open or not.
    void note_frame(double milliseconds) { times_.note_frame(milliseconds); }
    // A line of describe(): its row is chosen. False: it is none.
    bool choose_line(size_t line);
    size_t chosen_line() const;
    // For the chosen row.
    void press(MenuKey key);
    // `is_covered`: the engine has the keys.
    std::vector<PanelLine> describe(bool is_covered) const;

private:
    void change(int direction);
    std::string describe_change(size_t row) const;

    bool is_open_ = false;
    size_t row_ = 0;
    ChangeTimes times_;
};

} // namespace vkpt

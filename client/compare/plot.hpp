// SPDX-License-Identifier: GPL-2.0-or-later
// Line plots as SVG, to stand inside of a page.
#pragma once

#include <string>
#include <vector>

namespace vkpt::client {

struct PlotPoint {
    double x = 0, y = 0;
};
struct PlotLine {
    std::string name;
    std::vector<PlotPoint> points; // one: a dot
};
struct Plot {
    std::string title, x_label, y_label;
    std::vector<PlotLine> lines;
    bool x_is_logarithmic = false, y_is_logarithmic = false;
    bool starts_at_zero = false; // the y axis
};

// A line's colour follows its place in the list, also where others have no points: the same in several plots.
// Points that are not finite, or not positive on a logarithmic axis, are left out. Empty: nothing is left.
std::string draw_plot(const Plot& plot);

// With <, >, & and quotes as HTML and SVG want them.
std::string escape_markup(const std::string& text);

} // namespace vkpt::client

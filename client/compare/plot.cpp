// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/compare/plot.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace vkpt::client {

namespace {

constexpr double plot_width = 560, plot_height = 340; // of the whole; user units
constexpr double left = 64, right = 12, top = 34, bottom = 48; // margins
constexpr double legend_row = 16, legend_column = 276;

struct Axis {
    bool is_logarithmic = false;
    double low = std::numeric_limits<double>::infinity(), high = -low;

    bool takes(double value) const { return std::isfinite(value) && (!is_logarithmic || value > 0); }
    void include(double value)
    {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    // Some room around what is shown; never an empty stretch.
    void widen(bool keeps_low)
    {
        if (is_logarithmic) {
            low /= 1.12;
            high *= 1.12;
            return;
        }
        const double room = std::max(0.05 * (high - low), 1e-9 + 1e-3 * std::abs(high));
        low -= keeps_low ? 0 : room;
        high += room;
    }
    double share(double value) const
    {
        return is_logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    }
    // 1, 2 and 5 times powers of ten; fewer where that would be many.
    std::vector<double> ticks() const
    {
        std::vector<double> values;
        if (is_logarithmic) {
            const double decades = std::log10(high / low);
            for (double power = std::pow(10, std::floor(std::log10(low))); power <= high; power *= 10)
                for (const double factor : { 1.0, 2.0, 5.0 })
                    if (power * factor >= low && power * factor <= high && (factor == 1 || decades < 2.5))
                        values.push_back(power * factor);
            return values;
        }
        const double rough = (high - low) / 5, power = std::pow(10, std::floor(std::log10(rough)));
        const double step = rough / power < 1.5 ? power : rough / power < 3.5 ? 2 * power : 5 * power;
        for (double value = std::ceil(low / step) * step; value <= high; value += step)
            values.push_back(std::abs(value) < step * 1e-6 ? 0 : value);
        return values;
    }
};

// Hues apart by the golden angle: neighbours differ however many there are.
std::string colour_of(size_t line)
{
    return fmt::format("hsl({:.0f} 65% {}%)", std::fmod(double(line) * 137.508 + 205, 360), line % 2 ? 58 : 46);
}

class Drawing {
public:
    explicit Drawing(const Plot& plot)
        : plot_(plot)
    {
        x_.is_logarithmic = plot.x_is_logarithmic;
        y_.is_logarithmic = plot.y_is_logarithmic;
        for (size_t number = 0; number < plot.lines.size(); number++) {
            const PlotLine& line = plot.lines[number];
            Line kept;
            kept.name = line.name;
            kept.colour = colour_of(number);
            for (const PlotPoint& point : line.points)
                if (x_.takes(point.x) && y_.takes(point.y)) {
                    x_.include(point.x);
                    y_.include(point.y);
                    kept.points.push_back(point);
                }
            if (!kept.points.empty())
                lines_.push_back(std::move(kept));
        }
        if (plot.starts_at_zero && !lines_.empty())
            y_.include(0);
        if (!lines_.empty()) {
            x_.widen(false);
            y_.widen(plot.starts_at_zero);
        }
    }

    std::string draw()
    {
        if (lines_.empty())
            return "";
        const double legend = legend_row * double((lines_.size() + 1) / 2);
        svg_ = fmt::format(R"(<svg class="plot" role="img" viewBox="0 0 {} {}" xmlns="http://www.w3.org/2000/svg">)",
            plot_width, plot_height + legend);
        svg_ += fmt::format("<title>{}</title>", escape_markup(plot_.title));
        text(left, 18, "plot-title", plot_.title);
        draw_axes();
        for (size_t i = 0; i < lines_.size(); i++)
            draw_line(i);
        return svg_ + "</svg>";
    }

private:
    struct Line : PlotLine {
        std::string colour;
    };
    double x_of(double value) const { return left + (plot_width - left - right) * x_.share(value); }
    double y_of(double value) const { return plot_height - bottom - (plot_height - top - bottom) * y_.share(value); }

    void text(double x, double y, const char* kind, const std::string& words)
    {
        svg_ += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" class="{}">{}</text>)", x, y, kind, escape_markup(words));
    }
    void stroke(double x1, double y1, double x2, double y2)
    {
        svg_ += fmt::format(R"(<line class="grid" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)", x1, y1, x2, y2);
    }

    void draw_axes()
    {
        for (const double tick : x_.ticks()) {
            stroke(x_of(tick), top, x_of(tick), plot_height - bottom);
            text(x_of(tick), plot_height - bottom + 16, "tick-x", fmt::format("{:g}", tick));
        }
        for (const double tick : y_.ticks()) {
            stroke(left, y_of(tick), plot_width - right, y_of(tick));
            text(left - 6, y_of(tick) + 4, "tick-y", fmt::format("{:.4g}", tick));
        }
        text((left + plot_width - right) / 2, plot_height - 12, "label-x", plot_.x_label);
        svg_ += fmt::format(R"svg(<text class="label-x" transform="translate(14 {:.1f}) rotate(-90)">{}</text>)svg",
            (top + plot_height - bottom) / 2, escape_markup(plot_.y_label));
    }

    void draw_line(size_t index)
    {
        const Line& line = lines_[index];
        svg_ += fmt::format(
            R"(<g class="series" style="--colour:{}"><title>{}</title>)", line.colour, escape_markup(line.name));
        std::string path;
        for (const PlotPoint& point : line.points)
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x_of(point.x), y_of(point.y));
        svg_ += fmt::format(R"(<path d="{}"/>)", path);
        if (line.points.size() <= 12)
            for (const PlotPoint& point : line.points)
                svg_ += fmt::format(
                    R"(<circle cx="{:.1f}" cy="{:.1f}" r="3"><title>{}: {:.4g}, {:.4g}</title></circle>)",
                    x_of(point.x), y_of(point.y), escape_markup(line.name), point.x, point.y);
        const double x = 16 + double(index % 2) * legend_column, y = plot_height + legend_row * double(index / 2);
        svg_ += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="5"/>)", x, y);
        text(x + 12, y + 4, "legend", line.name);
        svg_ += "</g>";
    }

    const Plot& plot_;
    Axis x_, y_;
    std::vector<Line> lines_;
    std::string svg_;
};

} // namespace

std::string escape_markup(const std::string& text)
{
    std::string result;
    for (const char c : text)
        switch (c) {
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '&':
            result += "&amp;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += c;
        }
    return result;
}

std::string draw_plot(const Plot& plot) { return Drawing(plot).draw(); }

} // namespace vkpt::client

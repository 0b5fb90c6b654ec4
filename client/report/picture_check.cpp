// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/report/picture_check.hpp"

#include "client/report/expected_pictures.hpp"
#include "common/colour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>

namespace vkpt::client {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 5> views { {
    { "start", "maps/vkpt1.bsp@0,-384,46,0,90" },
    { "hall", "maps/vkpt1.bsp@0,150,90,10,-60" },
    { "dark_room", "maps/vkpt1.bsp@-440,100,60,10,-135" },
    { "under_water", "maps/vkpt1.bsp@-600,-60,-100,10,90" },
    { "open_air", "maps/vkpt1.bsp@0,520,200,-5,90" },
} };

// The line that begins with `name`.
std::vector<float> read_expected(std::string_view name)
{
    std::istringstream lines { std::string(expected_pictures) };
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string first;
        if (!(words >> first) || first != name)
            continue;
        std::vector<float> grid;
        for (float value = 0; words >> value;)
            grid.push_back(value);
        return grid;
    }
    return {};
}

} // namespace

std::vector<float> measure_grid(const formats::Image& picture)
{
    std::vector<double> sums(size_t(grid_columns * grid_rows)), counts(sums.size());
    for (int y = 0; y < picture.height; y++)
        for (int x = 0; x < picture.width; x++) {
            const formats::Rgba8& pixel = picture.pixels[size_t(y) * size_t(picture.width) + size_t(x)];
            const size_t part
                = size_t(y * grid_rows / picture.height * grid_columns + x * grid_columns / picture.width);
            sums[part] += luminance(double(pixel.r), double(pixel.g), double(pixel.b));
            counts[part]++;
        }
    std::vector<float> grid;
    for (size_t i = 0; i < sums.size(); i++)
        grid.push_back(float(sums[i] / std::max(counts[i], 1.0)));
    return grid;
}

GridDifference compare_grids(const std::vector<float>& expected, const std::vector<float>& found)
{
    GridDifference difference;
    for (size_t i = 0; i < expected.size(); i++) {
        const double off = std::abs(double(expected[i]) - double(found[i]));
        difference.mean += off / double(expected.size());
        difference.max = std::max(difference.max, off);
    }
    return difference;
}

std::vector<CheckedView> list_checked_views()
{
    std::vector<CheckedView> list;
    for (const auto& [name, scene] : views)
        list.push_back({ name, scene, read_expected(name) });
    return list;
}

} // namespace vkpt::client

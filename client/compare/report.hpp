// SPDX-License-Identifier: GPL-2.0-or-later
// What a comparison leaves: figures.json, figures.csv and one page for a browser.
#pragma once

#include "client/compare/figures.hpp"
#include "client/compare/measure.hpp"

#include <string>
#include <vector>

namespace vkpt::client {

struct Report {
    std::string command; // that made it
    Size size;
    std::vector<std::string> settings; // NAME=VALUE
    MeasureOptions options;
    std::vector<SceneResult> scenes;
    std::vector<Figure> figures;
};

inline constexpr int report_schema = 1;

// `rows`: one a variant, with the columns of the CSV; `details`, in the same order: what else was measured.
std::string make_json(const Report& report);
// scene, frame, sampler, subset, noise, denoiser, spp, rmse, rel_mse, flip, bias, bias_ci95, spectrum_low_high,
// flicker, ms. Numbers that there are not are empty.
std::string make_csv(const Report& report);
// Needs nothing but itself: pictures, plots and programs are inside.
std::string make_page(const Report& report);

} // namespace vkpt::client

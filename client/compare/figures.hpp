// SPDX-License-Identifier: GPL-2.0-or-later
// The chapter's figures (Ray Tracing Gems II, chapter 47) on our own map: which scene, which variants, side by side.
#pragma once

#include "client/compare/variant.hpp"

#include <string>
#include <vector>

namespace vkpt::client {

// Pictures in rows and columns, seen through one window.
struct FigurePicture {
    std::string variant; // Variant::label(); empty: the reference
    std::string caption; // what the figure calls it
    bool is_centre = false; // of the reference: that of filtered pictures
};
struct Figure {
    std::string title, text;
    size_t scene = 0; // of the comparison's
    std::vector<std::vector<FigurePicture>> rows;
    // What the window shows first: centre as share of the picture, pixels magnified.
    double x = 0.5, y = 0.5, zoom = 1;
    bool is_free = false; // the reader chooses its pictures
};

struct FigureScene {
    std::string scene; // as on the command line
    std::vector<Variant> variants;
};
struct FigurePlan {
    std::vector<FigureScene> scenes;
    std::vector<Figure> figures;
};

// The chapter's first scene.
std::string first_figure_scene();
// Figures 47-1, 47-4, 47-5, 47-6 and 47-7. Light samplers that the module lacks throw WrongUse.
FigurePlan plan_chapter_figures(const ModuleInfo& module);
// One figure a scene that has the first variants and the reference in a row.
std::vector<Figure> plan_plain_figures(const std::vector<FigureScene>& scenes);

} // namespace vkpt::client

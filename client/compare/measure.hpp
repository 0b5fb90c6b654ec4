// SPDX-License-Identifier: GPL-2.0-or-later
// Every figure of every variant on one scene.
#pragma once

#include "client/analysis/error.hpp"
#include "client/analysis/spectrum.hpp"
#include "client/compare/reference.hpp"
#include "client/compare/stage.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vkpt::client {

struct MeasureOptions {
    int samples = 1; // per pixel, of pictures that no filter touches
    int runs = 8; // independent ones of each variant, taking turns
    int frames = 8; // over which flicker is measured
    int warmup = 16; // frames that filters see before
    ReferenceOptions reference;
};

// Unfiltered pictures' error as samples are added.
struct CurvePoint {
    int samples = 0;
    double rmse = 0;
};

struct VariantResult {
    Variant variant;
    int samples = 1; // of each picture; filtered: of each frame
    analysis::ImageError error;
    double flip = 0;
    analysis::Estimate bias;
    analysis::LocalBias local_bias;
    analysis::Spectrum spectrum;
    double flicker = 0;
    double ms = 0, light_ms = 0; // medians: a frame's passes; direct and indirect light alone
    double light_ratio = 1; // of light_ms, to the first variant's in the same run: median
    std::vector<CurvePoint> curve;
    // As many samples as fit the time that the slowest unfiltered variant needs for `samples`, and the error by then.
    // Nothing: filtered, or no times.
    std::optional<double> equal_time_samples, equal_time_rmse;
    analysis::LinearImage picture; // of the first run
};

struct SceneResult {
    std::string scene;
    int frame = 0;
    Reference reference; // of unfiltered pictures
    std::optional<Reference> centre_reference; // of filtered ones, where there are some
    float exposure = 1; // for the screen, of all pictures of the scene
    std::vector<VariantResult> variants;
    std::vector<std::string> notes;
    std::string device, driver, trace_backend;
};

inline const Reference& reference_of(const SceneResult& scene, const Variant& variant)
{
    return variant.is_filtered() ? *scene.centre_reference : scene.reference;
}

using Progress = std::function<void(int done, int total)>;

// That measure_scene draws; fewer where a reference was kept.
int count_frames(const std::vector<Variant>& variants, const MeasureOptions& options, bool is_still);

SceneResult measure_scene(Stage& stage, const std::string& scene, const std::vector<Variant>& variants,
    const MeasureOptions& options, const Progress& progress);

// RMSE at a number of samples that need not be whole: between and beyond the curve's points a power law.
double interpolate_curve(const std::vector<CurvePoint>& curve, double samples);

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// The converged picture that everything is compared with, and how far it is from the truth itself.
#pragma once

#include "client/analysis/error.hpp"
#include "client/compare/stage.hpp"

#include <functional>
#include <optional>
#include <string>

namespace vkpt::client {

// Which part of a pixel it shows. Averaged pictures spread their rays over it, which smooths edges; live ones look
// through its centre, and so do those that filters get.
enum class PixelPart { whole, centre };

struct Reference {
    analysis::LinearImage image;
    int samples = 0;
    std::string sampler;
    bool was_cached = false;
    // Root mean square difference of its two halves, halved, by the mean: an estimate of its own RMSE.
    double rmse = 0;
    double mean_interval = 0; // 95 %, of its mean, relative to it
    std::vector<double> block_variances; // of block_differences() of its picture to the truth
};

// Blocks in which local bias is looked for, pixels.
inline constexpr int block_side = 16;

struct ReferenceOptions {
    int samples = 512;
    std::string sampler; // empty: a good one that the module has
    std::filesystem::path cache_folder; // empty: none is read or kept
};

// Where converged pictures are kept: in the user's cache folder. Empty: nowhere, stderr says why.
std::filesystem::path find_reference_folder();

// Of the stage's scene at `frame`. on_sample is called after each sample that was drawn; a cached one draws none.
Reference make_reference(
    Stage& stage, int frame, PixelPart part, const ReferenceOptions& options, const std::function<void()>& on_sample);

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/compare/measure.hpp"

#include "client/analysis/display.hpp"
#include "client/analysis/flip.hpp"
#include "client/host/errors.hpp"
#include "common/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkpt::client {

using namespace analysis;

namespace {

constexpr int curve_doublings = 3; // curves reach to `samples` * 8
constexpr int costly_runs = 4; // curves, flicker and FLIP are taken from as many runs at most

bool measures_costly(int run) { return run < costly_runs; }

// For changes from frame to frame an eighth of the samples will do.
int flicker_reference_samples(const MeasureOptions& options) { return std::max(options.reference.samples / 8, 1); }

// What the runs of one variant left.
struct Runs {
    std::vector<analysis::ImageError> errors;
    std::vector<double> mean_differences, flips, flickers, light_ratios;
    std::vector<std::vector<double>> blocks;
    std::vector<analysis::Spectrum> spectra;
    std::vector<double> ms, light_ms;
    std::vector<std::vector<analysis::ImageError>> curve; // per point
};

class SceneMeasurement {
public:
    SceneMeasurement(
        Stage& stage, const std::vector<Variant>& variants, const MeasureOptions& options, const Progress& progress)
        : stage_(stage)
        , variants_(variants)
        , options_(options)
        , progress_(progress)
        , runs_(variants.size())
    {
        if (!stage.is_still() && stage.frame() + 1 < options.warmup + options.frames)
            throw Failure(fmt::format(
                "frame {} has too few frames before it: filters look back at {} (--warmup) and flicker takes {} "
                "(--frames); choose FILE.rtrace@{} or later",
                stage.frame(), options.warmup, options.frames, options.warmup + options.frames - 1));
        total_ = count_frames(variants, options, stage.is_still());
    }

    SceneResult measure(const std::string& scene)
    {
        result_.scene = scene;
        result_.frame = stage_.frame();
        make_references();
        result_.exposure = analysis::choose_exposure(result_.reference.image);
        result_.variants.resize(variants_.size());
        for (size_t i = 0; i < variants_.size(); i++) {
            stage_.begin_averaged(variants_[i], 1); // its shaders are made at first use
            draw(stage_.frame(), nullptr);
        }
        for (int run = 0; run < options_.runs; run++)
            run_all(run);
        for (size_t i = 0; i < variants_.size(); i++)
            summarise(i);
        compare_at_equal_time();
        result_.notes = stage_.notes();
        result_.device = stage_.info().device;
        result_.driver = stage_.info().driver;
        result_.trace_backend = stage_.info().trace_backend;
        progress_(total_, total_);
        return std::move(result_);
    }

private:
    void advance() { progress_(std::min(++done_, total_), total_); }

    FrameTime draw(int frame, Runs* runs)
    {
        const FrameTime time = stage_.draw(frame);
        advance();
        if (runs) {
            runs->ms.push_back(time.all);
            runs->light_ms.push_back(time.light);
        }
        return time;
    }

    Reference make_one_reference(int frame, PixelPart part, int samples)
    {
        ReferenceOptions options = options_.reference;
        options.samples = samples;
        Reference reference = make_reference(stage_, frame, part, options, [&] { advance(); });
        if (reference.was_cached)
            total_ -= samples;
        return reference;
    }
    void make_references()
    {
        result_.reference = make_one_reference(stage_.frame(), PixelPart::whole, options_.reference.samples);
        if (has_filtered())
            result_.centre_reference
                = make_one_reference(stage_.frame(), PixelPart::centre, options_.reference.samples);
        if (stage_.is_still()) { // whatever it is, it does not change
            flicker_references_.push_back(result_.reference.image);
            return;
        }
        for (int frame = stage_.frame() - options_.frames + 1; frame <= stage_.frame(); frame++)
            flicker_references_.push_back(
                make_one_reference(frame, PixelPart::centre, flicker_reference_samples(options_)).image);
    }
    bool has_filtered() const { return std::ranges::any_of(variants_, &Variant::is_filtered); }

    // One picture of every variant: whatever slows the machine meanwhile slows all of them.
    void run_all(int run)
    {
        double first_light = 0;
        for (size_t i = 0; i < variants_.size(); i++) {
            const size_t first_time = runs_[i].light_ms.size();
            if (variants_[i].is_filtered())
                run_filtered(i, run);
            else
                run_unfiltered(i, run);
            const double light
                = find_median(std::vector(runs_[i].light_ms.begin() + ptrdiff_t(first_time), runs_[i].light_ms.end()));
            if (i == 0)
                first_light = light;
            runs_[i].light_ratios.push_back(first_light > 0 ? light / first_light : 1);
        }
    }

    void run_unfiltered(size_t index, int run)
    {
        Runs& runs = runs_[index];
        stage_.begin_averaged(variants_[index], 1 + run);
        int drawn = 0;
        for (int doubling = 0; doubling <= (measures_costly(run) ? curve_doublings : 0); doubling++) {
            for (; drawn < options_.samples << doubling; drawn++)
                draw(stage_.frame(), &runs);
            const LinearImage picture = stage_.capture();
            if (doubling == 0)
                judge(index, run, picture);
            runs.curve.resize(std::max(runs.curve.size(), size_t(doubling) + 1));
            runs.curve[size_t(doubling)].push_back(measure_error(result_.reference.image, picture));
        }
        if (measures_costly(run)) {
            stage_.begin_live(variants_[index]);
            measure_live(index);
        }
    }

    void run_filtered(size_t index, int run)
    {
        stage_.begin_live(variants_[index]);
        const int first = stage_.frame() - options_.frames - options_.warmup + 1;
        for (int i = 0; i < options_.warmup; i++)
            draw(stage_.is_still() ? stage_.frame() : first + i, &runs_[index]);
        judge(index, run, measure_live(index));
    }

    // Flicker; returns the last picture.
    LinearImage measure_live(size_t index)
    {
        std::vector<LinearImage> pictures;
        for (int i = 1 - options_.frames; i <= 0; i++) {
            draw(stage_.frame() + (stage_.is_still() ? 0 : i), &runs_[index]);
            pictures.push_back(stage_.capture());
        }
        runs_[index].flickers.push_back(measure_flicker(flicker_references_, pictures));
        return pictures.back();
    }

    void judge(size_t index, int run, const LinearImage& picture)
    {
        Runs& runs = runs_[index];
        const LinearImage& reference = reference_of(result_, variants_[index]).image;
        runs.errors.push_back(measure_error(reference, picture));
        runs.mean_differences.push_back(runs.errors.back().mean_difference);
        runs.blocks.push_back(block_differences(reference, picture, block_side));
        runs.spectra.push_back(measure_tiled_spectrum(
            { relative_errors(reference, picture) }, size_t(picture.width), size_t(picture.height)));
        if (measures_costly(run))
            runs.flips.push_back(mean_flip(
                measure_flip(map_to_display(reference, result_.exposure), map_to_display(picture, result_.exposure))));
        if (run == 0)
            result_.variants[index].picture = picture;
    }

    void summarise(size_t index)
    {
        const Runs& runs = runs_[index];
        const Reference& reference = reference_of(result_, variants_[index]);
        VariantResult& result = result_.variants[index];
        result.variant = variants_[index];
        result.samples = result.variant.is_filtered() ? 1 : options_.samples;
        result.error = average_errors(runs.errors);
        result.flip = analysis::estimate_mean(runs.flips).mean;
        result.flicker = analysis::estimate_mean(runs.flickers).mean;
        result.bias = estimate_bias(runs.mean_differences, reference.mean_interval);
        result.local_bias = estimate_local_bias(runs.blocks, reference.block_variances);
        result.spectrum = average_spectra(runs.spectra);
        result.ms = find_median(runs.ms);
        result.light_ms = find_median(runs.light_ms);
        result.light_ratio = find_median(runs.light_ratios);
        for (size_t point = 0; point < runs.curve.size(); point++)
            result.curve.push_back({ options_.samples << point, average_errors(runs.curve[point]).rmse });
    }

    void compare_at_equal_time()
    {
        double slowest = 0;
        for (const VariantResult& result : result_.variants)
            if (!result.variant.is_filtered())
                slowest = std::max(slowest, result.ms);
        for (VariantResult& result : result_.variants)
            if (!result.variant.is_filtered() && result.ms > 0) {
                result.equal_time_samples = options_.samples * slowest / result.ms;
                result.equal_time_rmse = interpolate_curve(result.curve, *result.equal_time_samples);
            }
    }

    Stage& stage_;
    const std::vector<Variant>& variants_;
    const MeasureOptions& options_;
    const Progress& progress_;
    std::vector<Runs> runs_; // per variant
    SceneResult result_;
    std::vector<LinearImage> flicker_references_; // one, or one a frame
    int done_ = 0, total_ = 0;
};

} // namespace

int count_frames(const std::vector<Variant>& variants, const MeasureOptions& options, bool is_still)
{
    const bool has_filtered = std::ranges::any_of(variants, &Variant::is_filtered);
    int total = options.reference.samples * (has_filtered ? 2 : 1) + int(variants.size());
    if (!is_still)
        total += options.frames * flicker_reference_samples(options);
    for (const Variant& variant : variants)
        for (int run = 0; run < options.runs; run++)
            if (variant.is_filtered())
                total += options.warmup + options.frames;
            else
                total += options.samples * (measures_costly(run) ? 1 << curve_doublings : 1)
                    + (measures_costly(run) ? options.frames : 0);
    return total;
}

double interpolate_curve(const std::vector<CurvePoint>& curve, double samples)
{
    if (curve.size() < 2)
        return curve.empty() ? 0 : curve[0].rmse;
    size_t upper = 1;
    while (upper + 1 < curve.size() && samples > curve[upper].samples)
        upper++;
    const CurvePoint &a = curve[upper - 1], &b = curve[upper];
    if (a.rmse <= 0 || b.rmse <= 0)
        return std::max(a.rmse, b.rmse);
    const double slope = std::log(b.rmse / a.rmse) / std::log(double(b.samples) / a.samples);
    return a.rmse * std::pow(samples / a.samples, slope);
}

SceneResult measure_scene(Stage& stage, const std::string& scene, const std::vector<Variant>& variants,
    const MeasureOptions& options, const Progress& progress)
{
    return SceneMeasurement(stage, variants, options, progress).measure(scene);
}

} // namespace vkpt::client

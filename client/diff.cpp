// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt diff: how far a picture is from another.
#include "client/analysis/display.hpp"
#include "client/analysis/error.hpp"
#include "client/analysis/flip.hpp"
#include "client/analysis/spectrum.hpp"
#include "client/host/errors.hpp"
#include "client/host/output_file.hpp"
#include "client/options.hpp"

#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace vkpt::client {

namespace {

using namespace vkpt::analysis;

constexpr int diff_schema = 1;

struct DiffOptions {
    std::string reference, heat_map;
    std::vector<std::string> pictures;
    double exposure = 0, pixels_per_degree = default_pixels_per_degree;
    bool json = false;
};

struct Difference {
    ImageError error;
    double flip = 0, low_to_high = 0, specks = 0;
    std::vector<float> flip_map;
};

void check_same_shape(
    const DiffOptions& options, const LinearImage& reference, const std::string& path, const LinearImage& picture)
{
    if (picture.width != reference.width || picture.height != reference.height)
        throw Failure(
            fmt::format("{} has {} x {} pixels, {} has {} x {}: only pictures of the same size can be compared; "
                        "render both with the same --size",
                options.reference, reference.width, reference.height, path, picture.width, picture.height));
    if (picture.is_display != reference.is_display)
        throw Failure(fmt::format("{} has linear radiance, {} a picture as shown: the exposure and the tone curve "
                                  "between them are not known; write both as .pfm or .exr, or both as .png",
            picture.is_display ? options.reference : path, picture.is_display ? path : options.reference));
}

Difference measure(const DiffOptions& options, const LinearImage& reference, const LinearImage& picture)
{
    Difference result;
    result.error = measure_error(reference, picture);
    const float exposure = options.exposure > 0 ? float(options.exposure) : choose_exposure(reference);
    result.flip_map = measure_flip(
        map_to_display(reference, exposure), map_to_display(picture, exposure), options.pixels_per_degree);
    result.flip = mean_flip(result.flip_map);
    result.low_to_high = measure_tiled_spectrum(
        { relative_errors(reference, picture) }, size_t(reference.width), size_t(reference.height))
                             .low_to_high();
    result.specks = measure_specks(reference, picture);
    return result;
}

void print(const DiffOptions& options, const std::vector<Difference>& differences)
{
    if (!options.json) {
        fmt::print("{:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "rmse", "rel_mse", "mean_diff", "flip", "low/high",
            "specks %");
        for (size_t i = 0; i < differences.size(); i++)
            fmt::print("{:>10.5f} {:>10.5f} {:>+10.5f} {:>10.5f} {:>10.3f} {:>10.3f}  {}\n", differences[i].error.rmse,
                differences[i].error.relative_mse, differences[i].error.mean_difference, differences[i].flip,
                differences[i].low_to_high, 100 * differences[i].specks, options.pictures[i]);
        return;
    }
    nlohmann::ordered_json json { { "schema", diff_schema }, { "reference", options.reference } };
    for (size_t i = 0; i < differences.size(); i++)
        json["pictures"].push_back({ { "file", options.pictures[i] }, { "rmse", differences[i].error.rmse },
            { "rel_mse", differences[i].error.relative_mse },
            { "mean_difference", differences[i].error.mean_difference }, { "flip", differences[i].flip },
            { "spectrum_low_high", differences[i].low_to_high }, { "specks", differences[i].specks } });
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void run_diff(const DiffOptions& options)
{
    if (!options.heat_map.empty() && !options.heat_map.ends_with(".png"))
        throw WrongUse(fmt::format("-o {}: the heat map is a PNG; name FILE.png", options.heat_map));
    if (!options.heat_map.empty() && options.pictures.size() > 1)
        throw WrongUse("-o: a heat map needs exactly one picture beside the reference");
    std::optional<OutputFile> output;
    if (!options.heat_map.empty())
        output.emplace(options.heat_map);
    const LinearImage reference = read_image(options.reference);
    std::vector<Difference> differences;
    for (const std::string& path : options.pictures) {
        const LinearImage picture = read_image(path);
        check_same_shape(options, reference, path, picture);
        differences.push_back(measure(options, reference, picture));
    }
    if (output) {
        output->write(formats::write_png(draw_heat_map(differences[0].flip_map, reference.width, reference.height)));
        output->commit();
    }
    print(options, differences);
}

} // namespace

void add_diff_command(CLI::App& program)
{
    const auto options = std::make_shared<DiffOptions>();
    CLI::App* command = program.add_subcommand(
        "diff", "Measure the error of pictures against a reference, and draw a heat map of one");
    command->add_option("REFERENCE", options->reference, "The reference: .png, .pfm or .exr")->required();
    command->add_option("PICTURE", options->pictures, "Pictures to compare with it, of the same size and kind")
        ->required();
    command
        ->add_option("-o,--output", options->heat_map,
            "Heat map of the perceived difference: from black (none) to pale yellow (most)")
        ->type_name("FILE.png");
    command
        ->add_option("--exposure", options->exposure,
            "Factor from radiance to the display that flip compares on (default: the reference's log-average becomes "
            "middle grey)")
        ->type_name("FACTOR")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--ppd", options->pixels_per_degree, "Pixels per degree of the viewer's field of view, for flip")
        ->type_name("N")
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
    command->add_flag("--json", options->json, "Print JSON");
    command->footer("rmse      root mean square error of luminance / mean of the reference\n"
                    "rel_mse   mean of error^2 / reference^2, pixel by pixel\n"
                    "mean_diff difference of the means / mean of the reference\n"
                    "flip      0 equal .. 1, what a viewer sees flipping between the two (Andersson et al. 2020)\n"
                    "low/high  power of the error below 1/8 cycle per pixel divided by that above; white noise has 1\n"
                    "specks %  pixels brighter than 1.6 times the reference, and than the same of their surroundings\n"
                    "Example: vkpt diff reference.pfm picture.pfm -o heat.png");
    command->callback([options] { run_diff(*options); });
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt_calibrate_light MAP.bsp...: path-traced against baked light at the lightmaps' sample points, and by which
// factors the scales in ref_vkpt/lights/emitters.hpp would have to change for the two to agree.
#include "client/host/errors.hpp"
#include "tools/calibrate_light/measure.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fmt/format.h>

namespace vkpt::tools {

namespace {

// What "matches" means: the median ratio of every map lies between these.
constexpr double lowest_median = 0.7, highest_median = 1.4;

void print_ratios(const std::vector<MapComparison>& maps, const Scales& factors)
{
    fmt::print("{:<24} {:>7}  {:>8} {:>8} {:>8}   share of face, point, sky light\n", "map", "luxels", "quartile",
        "median", "quartile");
    for (const MapComparison& map : maps) {
        const Quartiles ratio = measure_ratio(map, factors);
        Scales sums {};
        double all = 1e-30;
        for (const Comparison& luxel : map.luxels)
            for (size_t kind = 0; kind < light_kind_count; kind++) {
                sums[kind] += factors[kind] * luxel.traced[kind];
                all += factors[kind] * luxel.traced[kind];
            }
        const bool matches = ratio.median >= lowest_median && ratio.median <= highest_median;
        fmt::print("{:<24} {:>7}  {:>8.3f} {:>8.3f} {:>8.3f}   {:.2f} {:.2f} {:.2f}{}\n", map.name, map.luxels.size(),
            ratio.lower, ratio.median, ratio.upper, sums[0] / all, sums[1] / all, sums[2] / all,
            matches ? "" : "   outside of 0.7..1.4");
    }
}

bool all_match(const std::vector<MapComparison>& maps)
{
    Scales present;
    present.fill(1);
    return std::all_of(maps.begin(), maps.end(), [&](const MapComparison& map) {
        const double median = measure_ratio(map, present).median;
        return median >= lowest_median && median <= highest_median;
    });
}

int run(const std::vector<std::string>& files, const MeasureOptions& options)
{
    std::vector<MapComparison> maps;
    for (const std::string& file : files) {
        std::fprintf(stderr, "measuring %s (%zu of %zu)\n", file.c_str(), maps.size() + 1, files.size());
        maps.push_back(compare_map(file, options));
    }
    Scales present;
    present.fill(1);
    fmt::print("Path-traced / baked irradiance, {} bounces\n", options.bounces);
    print_ratios(maps, present);
    const Scales factors = fit_factors(maps);
    fmt::print("\nWith the fitted factors to EmissionScales:");
    for (size_t kind = 0; kind < light_kind_count; kind++)
        fmt::print(" {} x {:.3f}", name_of(LightKind(kind)), factors[kind]);
    fmt::print("\n");
    print_ratios(maps, factors);
    return all_match(maps) ? 0 : 1;
}

} // namespace

} // namespace vkpt::tools

int main(int argc, char** argv)
{
    vkpt::tools::MeasureOptions options;
    std::vector<std::string> maps;
    CLI::App program("Compares path-traced light with the lightmaps that maps carry.", "vkpt_calibrate_light");
    program.footer(
        "Exit status: 0 the median ratio of every map lies within 0.7..1.4, 1 it does not or an error, 2 wrong use.");
    program.add_option("MAP", maps, "BSP files with lightmaps")->required()->check(CLI::ExistingFile);
    program.add_option("--luxels", options.luxels, "Sample points per map")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    program.add_option("--spp", options.samples, "Paths per sample point")
        ->check(CLI::Range(1, 1 << 16))
        ->capture_default_str();
    program.add_option("--bounces", options.bounces, "Indirect bounces")
        ->check(CLI::Range(0, 8))
        ->capture_default_str();
    program.add_option("--seed", options.seed, "Which sample points and paths")
        ->check(CLI::Range(1, 16777215))
        ->capture_default_str();
    program.add_option("--module", options.module, "The ref_vkpt.so to use");
    program.add_option("--basedir", options.base_folder, "The folder that holds \"baseq2\", for the maps' pictures");
    program.add_option("--game", options.game, "A game folder beside baseq2, searched first");
    program.add_flag("--verbose", options.verbose, "Print the module's console output on stderr");
    try {
        program.parse(argc, argv);
        return vkpt::tools::run(maps, options);
    } catch (const CLI::ParseError& error) {
        return program.exit(error) == 0 ? 0 : 2;
    } catch (const vkpt::client::WrongUse& error) {
        std::fprintf(stderr, "vkpt_calibrate_light: %s\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "vkpt_calibrate_light: %s\n", error.what());
        return 1;
    }
}

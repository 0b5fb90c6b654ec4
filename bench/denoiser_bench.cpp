// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt_denoiser_bench: how far the filtered picture is from the converged one, at rest and in motion, and what each
// pass costs. Prints a table in Markdown, for docs/denoiser.md.
#include "client/analysis/error.hpp"
#include "client/analysis/flip.hpp"
#include "client/host/client_map.hpp"
#include "client/host/errors.hpp"
#include "common/quantile.hpp"
#include "formats/image.hpp"
#include "tests/module/game_folder.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/picture.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <glm/geometric.hpp>
#include <map>
#include <span>

using namespace vkpt;
using client::Host;

namespace {

constexpr float frame_seconds = 1.0f / 60;

struct Options {
    std::string base_folder, map = "maps/vkpt1.bsp", pictures, journey, cache = "denoiser_bench_cache";
    int width = 480, height = 270, frames = 48, samples = 400, checks = 1, spacing = 5;
    std::vector<std::string> modes { "off", "temporal", "svgf", "asvgf", "asvgf+taa" }, settings, samplers { "subset" };
    std::string scene; // "near", "glossy": made for MIS; else the map
    bool times = false;
};

struct Journey {
    const char* name;
    client::Camera from, to; // to: a second later

    bool is_at_rest() const { return from.position == to.position && from.yaw == to.yaw && from.pitch == to.pitch; }
};
// Through our map's halls.
const Journey journeys[] = {
    { "hall, at rest", { { 0, -384, 54 }, 0, 90 }, { { 0, -384, 54 }, 0, 90 } },
    { "hall, running and turning", { { -60, -440, 54 }, 0, 70 }, { { 200, -300, 54 }, 4, 130 } },
    { "upper floor, turning", { { 0, 352, 150 }, 8, 250 }, { { 60, 340, 150 }, 8, 330 } },
};

const Journey near_journeys[] = {
    { "long lamps above the floor, at rest", { { 0, -150, 40 }, 15, 90 }, { { 0, -150, 40 }, 15, 90 } },
    { "long lamps above the floor, in motion", { { -60, -160, 40 }, 15, 75 }, { { 120, -130, 45 }, 13, 120 } },
};
const Journey glossy_journeys[] = {
    { "brushed metal, at rest", { { -150, 0, 60 }, 15, 0 }, { { -150, 0, 60 }, 15, 0 } },
    { "brushed metal, in motion", { { -160, -60, 60 }, 15, 15 }, { { -110, 120, 70 }, 13, -30 } },
};

std::span<const Journey> journeys_of(const std::string& scene)
{
    if (scene == "near")
        return near_journeys;
    if (scene == "glossy")
        return glossy_journeys;
    return journeys;
}

// The scenes for which MIS was made, as in tests/module/sampler_error_test.cpp: direct light only.
void make_scene(Options& options, const tests::GameFolder& folder)
{
    using tests::rectangle;
    folder.add_wall("wall", 170);
    folder.add_wall("lamp", tests::white_index);
    tests::MapBuilder map;
    map.add_room({ -200, -200, 0 }, { 200, 200, 160 }, map.add_material("wall"));
    const uint16_t lamp = map.add_material("lamp", 0, 300), far_lamp = map.add_material("lamp", 0, 900);
    const bool near = options.scene == "near";
    for (const float y : { -40.0f, 40.0f })
        if (near)
            map.add(rectangle({ 0, y, 3 }, { 0, 6, 0 }, { 120, 0, 0 }), lamp);
    for (int i = 0; near && i < 16; i++)
        map.add(
            rectangle({ float(i % 4) * 80 - 120, float(i / 4) * 80 - 120, 150 }, { 0, 5, 0 }, { 5, 0, 0 }), far_lamp);
    for (int i = 0; !near && i < 6; i++)
        map.add(rectangle({ 195, float(i) * 60 - 150, 60 }, { 0, 0, 30 }, { 0, 20, 0 }), lamp);
    folder.add_map(options.scene, map.finish());
    options.base_folder = folder.path().string();
    options.map = "maps/" + options.scene + ".bsp@0,0,60,0,0";
    options.settings.emplace_back("pt_bounces=0");
    options.settings.emplace_back(near ? "pt_roughness_default=1" : "pt_roughness_default=0.2");
    options.settings.emplace_back(near ? "pt_light_point=area" : "pt_metallic_default=1");
}

client::Camera camera_at(const Journey& journey, float seconds)
{
    client::Camera camera;
    camera.position = glm::mix(journey.from.position, journey.to.position, seconds);
    camera.pitch = glm::mix(journey.from.pitch, journey.to.pitch, seconds);
    camera.yaw = glm::mix(journey.from.yaw, journey.to.yaw, seconds);
    return camera;
}

using Picture = std::vector<float>; // RGB

// A run of the module on the map.
class Run {
public:
    Run(const Options& options, const std::vector<std::pair<std::string, std::string>>& cvars)
        : options_(options)
        , files_(options.base_folder, "")
        , scene_(files_, client::parse_scene_name(options.map))
    {
        client::HostOptions host;
        host.width = options.width;
        host.height = options.height;
        host.cvars = cvars;
        for (const std::string& setting : options.settings) {
            const size_t equals = setting.find('=');
            host.cvars.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
        }
        host_ = std::make_unique<Host>(host, &files_);
        scene_.register_with(*host_);
    }

    void draw(const client::Camera& camera, float seconds)
    {
        scene_.set_camera(camera);
        host_->draw_frame(scene_.view(options_.width, options_.height, seconds));
    }

    Picture radiance()
    {
        Picture picture(size_t(options_.width) * size_t(options_.height) * 3);
        if (!host_->extension().capture_radiance(picture.data()))
            throw client::Failure("the module has no picture to capture");
        return picture;
    }

    void save(const std::string& path)
    {
        formats::Image image { options_.width, options_.height,
            std::vector<formats::Rgba8>(size_t(options_.width) * size_t(options_.height)) };
        host_->extension().capture_display(&image.pixels.data()->r);
        const std::vector<std::byte> bytes = formats::write_png(image);
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    }

    const Extension& extension() const { return host_->extension(); }

private:
    const Options& options_;
    client::FileSystem files_;
    client::ClientMap scene_;
    std::unique_ptr<Host> host_;
};

// The frames of a journey that are compared.
bool is_checked(const Options& options, int frame)
{
    const int left = options.frames - 1 - frame;
    return left % options.spacing == 0 && left / options.spacing < options.checks;
}

float frame_time(int frame) { return float(frame) * frame_seconds; }

// Converged, from the cache where it has been made before.
Picture make_reference(const Options& options, const Journey& journey, int frame)
{
    std::filesystem::create_directories(options.cache);
    std::string name = fmt::format("{}_{}_{}x{}_{}_{}.bin", std::filesystem::path(options.map).stem().string(),
        journey.name, options.width, options.height, frame, options.samples);
    std::ranges::replace(name, ' ', '_');
    const std::string path = (std::filesystem::path(options.cache) / name).string();
    Picture picture(size_t(options.width) * size_t(options.height) * 3);
    const auto bytes = std::streamsize(picture.size() * sizeof(float));
    if (std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(picture.data()), bytes))
        return picture;
    // In the scenes made for MIS it converges soonest.
    Run run(
        options, { { "pt_accumulate", "1" }, { "pt_light_sampler", options.scene.empty() ? "subset" : "subset_mis" } });
    for (int i = 0; i < options.samples; i++)
        run.draw(camera_at(journey, frame_time(frame)), frame_time(frame));
    picture = run.radiance();
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(picture.data()), bytes);
    return picture;
}

// What relative_error sums, per pixel: black 0, white 0.25 and more.
void save_error_map(const Options& options, const Picture& picture, const Picture& reference, const std::string& path)
{
    formats::Image image { options.width, options.height, {} };
    for (size_t i = 0; i < picture.size(); i += 3) {
        const double error = tests::relative_error({ &picture[i], 3 }, { &reference[i], 3 });
        const auto grey = uint8_t(255 * std::min(1.0, 4 * error));
        image.pixels.push_back({ grey, grey, grey, 255 });
    }
    const std::vector<std::byte> bytes = formats::write_png(image);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

// FLIP of x / (1 + x).
double flip_error(const Options& options, const Picture& picture, const Picture& reference)
{
    const auto display = [&](const Picture& radiance) {
        analysis::LinearImage image = analysis::make_image(options.width, options.height);
        std::ranges::transform(radiance, image.rgb.begin(), [](float x) { return x / (1 + x); });
        image.is_display = true;
        return image;
    };
    return analysis::mean_flip(analysis::measure_flip(display(reference), display(picture)));
}

struct Errors {
    double error = 0, flip = 0;
    double flicker = -1; // at rest: root mean square change from frame to frame, by the reference's mean
    std::map<std::string, std::vector<double>> milliseconds;
};

Errors measure(
    const Options& options, const Journey& journey, const std::map<int, Picture>& references, const std::string& mode)
{
    const size_t plus = mode.find('+');
    const std::string antialiasing = plus == std::string::npos ? "off" : mode.substr(plus + 1);
    Run run(options,
        { { "flt_denoiser", mode.substr(0, plus) }, { "flt_taa", antialiasing == "taa" ? "on" : antialiasing } });
    run.extension().time_every_pass();
    Errors errors;
    std::vector<analysis::LinearImage> last;
    for (int frame = 0; frame < options.frames; frame++) {
        run.draw(camera_at(journey, frame_time(frame)), frame_time(frame));
        size_t count = 0;
        const PassTime* times = run.extension().pass_times(&count);
        for (size_t i = 0; frame > 4 && i < count; i++)
            errors.milliseconds[times[i].name].push_back(times[i].milliseconds);
        if (journey.is_at_rest() && !references.empty() && frame >= references.begin()->first)
            last.push_back({ options.width, options.height, run.radiance() });
        if (!is_checked(options, frame))
            continue;
        errors.error += tests::relative_error(run.radiance(), references.at(frame)) / options.checks;
        errors.flip += flip_error(options, run.radiance(), references.at(frame)) / options.checks;
    }
    if (last.size() > 1) {
        const analysis::LinearImage reference { options.width, options.height, references.begin()->second };
        errors.flicker = analysis::measure_flicker({ &reference, 1 }, last);
    }
    if (!options.pictures.empty()) {
        std::string name = fmt::format("{}/{}_{}.png", options.pictures, journey.name, mode);
        std::ranges::replace(name, ' ', '_');
        run.save(name);
        if (!references.empty())
            save_error_map(
                options, run.radiance(), references.rbegin()->second, name.substr(0, name.size() - 4) + "_error.png");
    }
    return errors;
}

void print_times(const std::string& mode, const Errors& errors)
{
    double total = 0;
    for (const auto& [name, values] : errors.milliseconds)
        total += find_median(values);
    fmt::print("\n{}, all passes {:.1f} ms\n", mode, total);
    for (const auto& [name, values] : errors.milliseconds)
        fmt::print("| {} | {:.2f} ms | {:.1f} % |\n", name, find_median(values), 100 * find_median(values) / total);
}

// Error, FLIP and flicker (at rest).
void print_errors(const Errors& errors)
{
    fmt::print(" {:.4f}, {:.3f}", errors.error, errors.flip);
    if (errors.flicker >= 0)
        fmt::print(", {:.3f}", errors.flicker);
    fmt::print(" |");
    std::fflush(stdout);
}

void run_bench(const Options& options)
{
    std::map<std::string, Errors> last;
    fmt::print("| journey | sampler |");
    for (const std::string& mode : options.modes)
        fmt::print(" {} |", mode);
    fmt::print("\n");
    for (const Journey& journey : journeys_of(options.scene)) {
        if (!options.journey.empty() && std::string(journey.name).find(options.journey) == std::string::npos)
            continue;
        std::map<int, Picture> references;
        for (int frame = 0; frame < options.frames; frame++)
            if (is_checked(options, frame))
                references[frame] = make_reference(options, journey, frame);
        for (const std::string& sampler : options.samplers) {
            fmt::print("| {} | `{}` |", journey.name, sampler);
            Options here = options;
            here.settings.push_back("pt_light_sampler=" + sampler);
            for (const std::string& mode : options.modes)
                print_errors(last[mode] = measure(here, journey, references, mode));
            fmt::print("\n");
        }
    }
    for (const std::string& mode : options.modes)
        if (options.times)
            print_times(mode, last[mode]);
}

} // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App program("Error and cost of the denoiser");
    program.add_option("--basedir", options.base_folder, "Folder that holds baseq2");
    program
        .add_option(
            "--scene", options.scene, "Instead of a map, a room made for MIS: near (long lamps) or glossy (metal)")
        ->check(CLI::IsMember({ "near", "glossy" }));
    program.add_option("--samplers", options.samplers, "A row for each of these light samplers");
    program.add_option("--map", options.map);
    program.add_option("--width", options.width);
    program.add_option("--height", options.height);
    program.add_option("--frames", options.frames, "Length of each journey");
    program.add_option("--checks", options.checks, "Frames at the end of each journey that are compared, five apart");
    program.add_option("--samples", options.samples, "Frames averaged for the converged pictures");
    program.add_option(
        "--modes", options.modes, "Values of flt_denoiser; with +taa or +upscale behind: and flt_taa on or upscale");
    program.add_option("--journey", options.journey, "Part of its name; else all");
    program.add_option("--set", options.settings, "NAME=VALUE");
    program.add_option("--cache", options.cache, "Folder for converged pictures");
    program.add_option("--pictures", options.pictures, "Folder for the last frames as PNG");
    program.add_flag("--times", options.times, "Print the passes' times of the last journey");
    CLI11_PARSE(program, argc, argv);
    try {
        const tests::GameFolder folder;
        if (!options.scene.empty())
            make_scene(options, folder);
        else if (options.base_folder.empty())
            throw client::Failure("--basedir or --scene is needed");
        run_bench(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "vkpt_denoiser_bench: {}\n", error.what());
        return 1;
    }
}

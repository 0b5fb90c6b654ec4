// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/report/measurements.hpp"

#include "client/base64.hpp"
#include "client/bench/collected_times.hpp"
#include "client/host/errors.hpp"
#include "client/host/frame_source.hpp"
#include "client/host/name_list.hpp"
#include "common/quantile.hpp"

#include <chrono>
#include <fmt/format.h>
#include <regex>

namespace vkpt::client {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int checked_width = 320, checked_height = 180, checked_frames = 16, validated_frames = 6;
constexpr int warm_up_frames = 2, min_timed_frames = 4, max_timed_frames = 240;
constexpr size_t max_texts = 10;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// A module that draws one scene.
struct Stage {
    Stage(const ReportOptions& options, const std::string& scene, Size size,
        const std::vector<std::pair<std::string, std::string>>& cvars, std::vector<std::string>* lines = nullptr)
        : files(options.base_folder, options.game)
        , source(open_frame_source(files, scene))
        , host(make_options(options, size, cvars, lines), &files)
    {
    }
    void draw(int frame)
    {
        const std::optional<int> count = source->frame_count();
        source->draw(host, count ? frame % *count : frame);
    }

    FileSystem files;
    std::unique_ptr<FrameSource> source;
    Host host;

private:
    static HostOptions make_options(const ReportOptions& options, Size size,
        const std::vector<std::pair<std::string, std::string>>& cvars, std::vector<std::string>* lines)
    {
        HostOptions host = make_host_options(options.module);
        host.width = size.width;
        host.height = size.height;
        host.cvars.insert(host.cvars.begin(), cvars.begin(), cvars.end()); // the user's own win
        if (lines)
            host.on_line = [lines](const std::string& line) { lines->push_back(line); };
        return host;
    }
};

// "... software 20 ns, query 52.1 ns a ray"
Json read_ray_times(const std::vector<std::string>& lines)
{
    static const std::regex time("([a-z]+) ([0-9.e+]+) ns");
    Json times = Json::object();
    for (const std::string& line : lines)
        if (line.find(" ns a ray") != std::string::npos)
            for (std::sregex_iterator found(line.begin(), line.end(), time), end; found != end; ++found)
                times[(*found)[1]] = std::stod((*found)[2]);
    return times;
}

} // namespace

Json describe_device(const ReportOptions& options)
{
    std::vector<std::string> lines;
    Stage stage(options, options.scene, { 1280, 800 }, {}, &lines);
    stage.source->register_with(stage.host);
    stage.draw(0);
    stage.host.run_text("pt_trace_measure\npt_info\n");
    const ModuleInfo info = stage.host.extension().info();
    return { { "device", info.device }, { "driver", info.driver }, { "vulkan", info.vulkan_version },
        { "trace_backend", info.trace_backend }, { "trace_backends", list_names(info.trace_backends) },
        { "ns_per_ray", read_ray_times(lines) }, { "console", lines } };
}

Json time_preset(const ReportOptions& options, const std::string& preset, const std::string& size)
{
    const auto start = Clock::now();
    Stage stage(options, options.scene, parse_size(size), { { "pt_times", "1" } });
    stage.host.run_text("pt_preset " + preset + "\n");
    stage.source->register_with(stage.host);
    stage.draw(0);
    BenchResult result;
    add_collected_times(stage.host.extension(), result); // waits for the device
    const double first_frame_seconds = seconds_since(start);
    result = {};
    int frame = 1;
    for (; frame <= warm_up_frames; frame++)
        stage.draw(frame);
    stage.host.extension().forget_times();
    const auto timing = Clock::now();
    for (; result.frames < min_timed_frames
         || (result.frames < max_timed_frames && seconds_since(timing) < options.seconds);
         result.frames++)
        stage.draw(frame++);
    add_collected_times(stage.host.extension(), result);
    const ModuleInfo info = stage.host.extension().info();
    Json passes = Json::object();
    for (const TimedTask& pass : result.passes)
        passes[pass.name] = round_time(find_median(pass.ms));
    return { { "preset", preset }, { "size", size }, { "frames", result.frames },
        { "frame_ms", result.frame_ms.empty() ? Json() : Json(round_time(find_median(result.frame_ms))) },
        { "first_frame_seconds", round_time(first_frame_seconds) }, { "trace_backend", info.trace_backend },
        { "gpu_mib", std::lround(find_device_mib(info)) }, { "passes", passes } };
}

Json validate_frames(const ReportOptions& options, const std::string& backend)
{
    std::vector<std::string> lines;
    Json result { { "backend", backend }, { "messages", 0 }, { "texts", Json::array() } };
    Stage stage(options, options.scene, { checked_width, checked_height },
        { { "pt_validation", "1" }, { "pt_trace", backend } }, &lines);
    stage.source->register_with(stage.host);
    for (int frame = 0; frame < validated_frames; frame++)
        stage.draw(frame);
    size_t count = 0;
    stage.host.extension().collected_times(&count); // waits for the device
    for (const std::string& line : lines)
        if (line.starts_with("vkpt validation:")) {
            result["messages"] = result["messages"].get<int>() + 1;
            if (result["texts"].size() < max_texts)
                result["texts"].push_back(line);
        }
    return result;
}

formats::Image draw_checked_view(const ReportOptions& options, const CheckedView& view, const std::string& backend)
{
    // Exposure follows at once: else it would still depend on the first frame, which is mostly noise.
    Stage stage(options, std::string(view.scene), { checked_width, checked_height },
        { { "pt_trace", backend }, { "pt_exposure_speed", "100" } });
    stage.source->register_with(stage.host);
    for (int frame = 0; frame < checked_frames; frame++)
        stage.draw(frame);
    const ImageSize size = stage.host.extension().frame_size();
    formats::Image image { size.width, size.height,
        std::vector<formats::Rgba8>(size_t(size.width) * size_t(size.height)) };
    if (!stage.host.extension().capture_display(&image.pixels.data()->r))
        throw Failure("the module has no finished frame to capture");
    return image;
}

Json check_pictures(const ReportOptions& options, const std::string& backend)
{
    Json pictures = Json::array();
    for (const CheckedView& view : list_checked_views()) {
        if (view.expected.empty())
            throw Failure(fmt::format("it is not known what {} should look like", view.name));
        const formats::Image image = draw_checked_view(options, view, backend);
        const GridDifference difference = compare_grids(view.expected, measure_grid(image));
        pictures.push_back({ { "name", view.name }, { "scene", view.scene }, { "mean_difference", difference.mean },
            { "max_difference", difference.max }, { "is_right", difference.is_small() },
            { "png", encode_base64(formats::write_png(image)) } });
    }
    return { { "backend", backend }, { "pictures", pictures } };
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt render: one picture of a map.
#include "client/host/errors.hpp"
#include "client/host/frame_source.hpp"
#include "client/host/output_file.hpp"
#include "client/options.hpp"
#include "client/progress.hpp"
#include "formats/image.hpp"

#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace vkpt::client {

namespace {

struct RenderOptions {
    ModuleOptions module;
    SceneOptions scene;
    std::string output;
    int samples = 64, frames = 0;
};

enum class PictureKind { png, pfm, exr };

PictureKind picture_kind(const std::string& path)
{
    if (path.ends_with(".png"))
        return PictureKind::png;
    if (path.ends_with(".pfm"))
        return PictureKind::pfm;
    if (path.ends_with(".exr"))
        return PictureKind::exr;
    throw WrongUse(
        fmt::format("-o {}: the file name must end in .png (as shown), .pfm or .exr (linear radiance)", path));
}

void write_display(const Extension& extension, OutputFile& output)
{
    const ImageSize size = extension.frame_size();
    formats::Image image { size.width, size.height,
        std::vector<formats::Rgba8>(size_t(size.width) * size_t(size.height)) };
    if (!extension.capture_display(&image.pixels.data()->r))
        throw Failure("the module has no finished frame to capture");
    output.write(formats::write_png(image));
}

void write_radiance(const Extension& extension, OutputFile& output, PictureKind kind)
{
    const ImageSize size = extension.frame_size();
    std::vector<float> rgb(3 * size_t(size.width) * size_t(size.height));
    if (!extension.capture_radiance(rgb.data()))
        throw Failure("the module has no finished 3D view to capture");
    size_t nonfinite = 0;
    for (const float value : rgb)
        nonfinite += !std::isfinite(value);
    if (nonfinite)
        std::fprintf(
            stderr, "vkpt: %zu of %zu values are not finite: please report this scene\n", nonfinite, rgb.size());
    output.write(kind == PictureKind::exr ? formats::write_exr(size.width, size.height, rgb)
                                          : formats::write_pfm(size.width, size.height, rgb));
}

HostOptions make_render_host(const RenderOptions& options, Size size)
{
    HostOptions host = make_host_options(options.module);
    host.width = size.width;
    host.height = size.height;
    // Before the user's own, which win.
    const auto set = [&](const char* name, int number) {
        host.cvars.insert(host.cvars.begin(), { name, std::to_string(number) });
    };
    set("pt_accumulate", options.frames == 0);
    set("pt_seed", options.scene.seed);
    return host;
}

void run_render(const RenderOptions& options)
{
    const PictureKind kind = picture_kind(options.output);
    const Size size = parse_size(options.scene.size);
    const HostOptions host_options = make_render_host(options, size);
    OutputFile output(options.output);
    FileSystem files(options.scene.base_folder, options.scene.game);
    const std::unique_ptr<FrameSource> source = open_frame_source(files, options.scene.scene);
    Host host(host_options, &files);
    source->register_with(host);
    for (const std::string& note : source->notes())
        std::fprintf(stderr, "vkpt: %s\n", note.c_str());
    const int first = source->chosen_frame(), frames = options.frames ? options.frames : options.samples;
    if (const auto count = source->frame_count(); count && options.frames > *count - first)
        throw WrongUse(fmt::format(
            "--frames {}: from frame {} on, {} has {}", options.frames, first, options.scene.scene, *count - first));
    ProgressBar progress("rendering", frames);
    for (int i = 0; i < frames; i++) {
        source->draw(host, options.frames ? first + i : first);
        progress.show(i + 1);
    }
    if (kind == PictureKind::png)
        write_display(host.extension(), output);
    else
        write_radiance(host.extension(), output, kind);
    output.commit();
}

} // namespace

void add_render_command(CLI::App& program)
{
    const auto options = std::make_shared<RenderOptions>();
    CLI::App* command = program.add_subcommand(
        "render", "Write one picture of a map or a trace: PNG (as shown), PFM or EXR (linear radiance)");
    add_scene_options(*command, options->scene);
    CLI::Option* samples
        = command
              ->add_option("--spp", options->samples, "Frames to average, one path per pixel each (converged picture)")
              ->type_name("N")
              ->check(CLI::Range(1, 1 << 20))
              ->capture_default_str();
    command
        ->add_option(
            "--frames", options->frames, "Draw live frames at 60 a second as in the game instead, and write the last")
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 20))
        ->excludes(samples);
    command->add_option("-o,--output", options->output, "FILE.png, FILE.pfm or FILE.exr")
        ->required()
        ->type_name("FILE");
    add_module_options(*command, options->module);
    add_examples(*command,
        { "vkpt render maps/vkpt1.bsp -o start.png", "vkpt render maps/vkpt1.bsp@0,-384,46,0,90 --spp 1024 -o view.exr",
            "vkpt render game.rtrace@700 --size 1920x1080 --set pt_light_sampler=ris -o frame.png",
            "vkpt render game.rtrace@690 --frames 11 -o live.png" });
    command->callback([options] { run_render(*options); });
}

} // namespace vkpt::client

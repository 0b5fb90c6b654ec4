// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt export: a scene for other renderers, which can check us.
#include "client/analysis/linear_image.hpp"
#include "client/export/scene_pictures.hpp"
#include "client/export/scene_text.hpp"
#include "client/host/errors.hpp"
#include "client/host/frame_source.hpp"
#include "client/options.hpp"
#include "client/output_folder.hpp"

#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace vkpt::client {

namespace {

constexpr int sky_width = 2048; // texels around: about as many as the sky's six pictures have
constexpr const char* sky_name = "sky.exr";

struct ExportOptions {
    ModuleOptions module;
    SceneOptions scene;
    std::string output;
};

void print_notes(const std::vector<std::string>& notes)
{
    for (const std::string& note : notes)
        fmt::print(stderr, "vkpt: {}\n", note);
}

void write_pictures(const std::filesystem::path& folder, const ScenePictures& pictures)
{
    if (pictures.written().empty())
        return;
    std::vector<std::string> names;
    for (const ScenePictures::Written& picture : pictures.written())
        names.push_back(picture.name.substr(picture.name.find('/') + 1));
    OutputFolder output(folder / "textures", names);
    for (size_t i = 0; i < names.size(); i++)
        output.write(i, formats::write_png(pictures.written()[i].image));
    output.commit();
}

void write_sky(const std::filesystem::path& path, const analysis::LinearImage& sky)
{
    OutputFile file(path);
    file.write(formats::write_exr(sky.width, sky.height, sky.rgb));
    file.commit();
}

void run_export(const ExportOptions& options)
{
    const Size size = parse_size(options.scene.size);
    HostOptions host_options = make_host_options(options.module);
    host_options.width = size.width;
    host_options.height = size.height;
    OutputFolder output(options.output, { "scene.obj", "scene.mtl", "scene.json" });
    FileSystem files(options.scene.base_folder, options.scene.game);
    const std::unique_ptr<FrameSource> source = open_frame_source(files, options.scene.scene);
    Host host(host_options, &files);
    source->register_with(host);
    source->draw(host, source->chosen_frame());
    print_notes(source->notes());
    SceneContents contents {};
    if (!host.extension().read_scene(&contents))
        throw Failure(fmt::format("{}: the module has no map to export", options.scene.scene));
    const MergedScene merged(contents);
    const SceneContents& scene = merged.contents;
    ScenePictures pictures(files);
    pictures.add(scene);
    const analysis::LinearImage sky = pictures.sky(scene.sky, sky_width);
    print_notes(pictures.notes());
    write_pictures(options.output, pictures);
    output.write(0, make_obj(scene, "scene.mtl"));
    output.write(1, make_mtl(scene, pictures));
    output.write(2,
        make_scene_json(scene, options.scene.scene, source->chosen_frame(), host.extension().frame_size(),
            sky.rgb.empty() ? "" : sky_name));
    if (!sky.rgb.empty())
        write_sky(std::filesystem::path(options.output) / sky_name, sky);
    output.commit();
    fmt::print("{}: {} triangles, {} materials, {} emitters\n", options.output, scene.triangle_count,
        scene.material_count, scene.emitter_count);
}

} // namespace

void add_export_command(CLI::App& program)
{
    const auto options = std::make_shared<ExportOptions>();
    CLI::App* command = program.add_subcommand("export",
        "Write a scene for other renderers: triangles, materials, emitters, sky, camera as OBJ, MTL, JSON, PNG, EXR");
    add_scene_options(*command, options->scene);
    command
        ->add_option(
            "-o,--output", options->output, "Folder for scene.obj, scene.mtl, scene.json, sky.exr and textures/")
        ->required()
        ->type_name("DIR");
    add_module_options(*command, options->module);
    command->footer("Example: vkpt export maps/vkpt1.bsp -o scene\n"
                    "Spheres (point lights) are in scene.json only. How to check pictures with it: docs/truth.md");
    command->callback([options] { run_export(*options); });
}

} // namespace vkpt::client

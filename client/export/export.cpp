// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt export: a scene for other renderers, which can check us.
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

struct ExportOptions {
    ModuleOptions module;
    SceneOptions scene;
    std::string output;
};

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
    for (const std::string& note : source->notes())
        fmt::print(stderr, "vkpt: {}\n", note);
    SceneContents scene {};
    if (!host.extension().read_scene(&scene))
        throw Failure(fmt::format("{}: the module has no map to give out", options.scene.scene));
    output.write(0, make_obj(scene, "scene.mtl"));
    output.write(1, make_mtl(scene));
    output.write(2, make_scene_json(scene, options.scene.scene, source->chosen_frame(), host.extension().frame_size()));
    output.commit();
    fmt::print("{}: {} triangles, {} materials, {} emitters\n", options.output, scene.triangle_count,
        scene.material_count, scene.emitter_count);
}

} // namespace

void add_export_command(CLI::App& program)
{
    const auto options = std::make_shared<ExportOptions>();
    CLI::App* command = program.add_subcommand(
        "export", "Write a scene for other renderers: triangles, materials, emitters, camera as OBJ, MTL and JSON");
    add_scene_options(*command, options->scene);
    command->add_option("-o,--output", options->output, "Folder for scene.obj, scene.mtl and scene.json")
        ->required()
        ->type_name("DIR");
    add_module_options(*command, options->module);
    command->footer("Example: vkpt export maps/vkpt1.bsp -o scene\n"
                    "Spheres (point lights) are in scene.json alone; pictures are given by their average colours.");
    command->callback([options] { run_export(*options); });
}

} // namespace vkpt::client

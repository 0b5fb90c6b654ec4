// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt view: a window on a scene.
#include "client/host/errors.hpp"
#include "client/host/frame_source.hpp"
#include "client/options.hpp"
#include "client/view/viewer.hpp"

#include <fmt/format.h>
#include <memory>

namespace vkpt::client {

namespace {

struct ViewOptions {
    ModuleOptions module;
    SceneOptions scene;
    std::vector<std::string> settings_of_b; // NAME=VALUE
};

constexpr const char* footer
    = R"(Keys: F1 in the window lists them all. WASD flies, drag looks, L R B N T V change sampler, subset length,
bounces, denoiser, trace backend and debug view, X splits the picture, M measures the error, a click shows a pixel's lights.

Examples:
  vkpt view maps/vkpt1.bsp
  vkpt view maps/vkpt1.bsp --b pt_light_sampler=uniform       split: uniform on the right
  vkpt view maps/vkpt1.bsp --size 640x360 --set pt_bounces=0 --set flt_denoiser=off)";

void run_view(const ViewOptions& options)
{
    const Size size = parse_size(options.scene.size);
    view::ViewerOptions viewer;
    viewer.render.host = make_host_options(options.module);
    viewer.render.host.width = size.width;
    viewer.render.host.height = size.height;
    // Before the user's own, which win.
    viewer.render.host.cvars.insert(
        viewer.render.host.cvars.begin(), { "pt_seed", std::to_string(options.scene.seed) });
    viewer.render.scene = options.scene.scene;
    const std::vector<view::LiveSetting> live = view::find_live_settings({ "" });
    for (const auto& [name, value] : parse_settings(options.settings_of_b, "--b")) {
        if (!view::find_setting(live, name))
            throw WrongUse(fmt::format(
                "--b {}={}: not a setting that can change while the renderer runs; `vkpt info --cvars` lists them",
                name, value));
        viewer.b[name] = value;
    }
    FileSystem files(options.scene.base_folder, options.scene.game);
    const std::unique_ptr<FrameSource> source = open_frame_source(files, options.scene.scene);
    viewer.render.files = &files;
    viewer.render.source = source.get();
    view::Viewer(viewer).run();
}

} // namespace

void add_view_command(CLI::App& program)
{
    const auto options = std::make_shared<ViewOptions>();
    options->scene.size = "960x540";
    CLI::App* command
        = program.add_subcommand("view", "Show a scene in a window: fly, compare settings, see error, cost and lights");
    add_scene_options(*command, options->scene);
    command
        ->add_option(
            "--b", options->settings_of_b, "Split the picture and set a variable of its right side, B; may be repeated")
        ->type_name("NAME=VALUE")
        ->take_all()
        ->expected(1);
    add_module_options(*command, options->module);
    command->footer(footer);
    command->callback([options] { run_view(*options); });
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/renderer.hpp"

#include "common/quantile.hpp"
#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/cvars_rows.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/engine/exports.hpp"
#include "ref_vkpt/files/cache_folder.hpp"
#include "ref_vkpt/files/output_folder.hpp"
#include "ref_vkpt/frame/bench_report.hpp"
#include "ref_vkpt/frame/pass_shaders.hpp"
#include "ref_vkpt/frame/trace_measurement.hpp"
#include "ref_vkpt/lights/media.hpp"
#include "ref_vkpt/material_commands.hpp"
#include "ref_vkpt/module.hpp"
#include "ref_vkpt/photo_commands.hpp"
#include "ref_vkpt/replay_commands.hpp"
#include "ref_vkpt/scene/camera.hpp"
#include "ref_vkpt/scene/motion.hpp"
#include "ref_vkpt/vulkan/pipeline_statistics.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>

namespace vkpt {

namespace {

std::unique_ptr<Module> running;

// Between a door's opening and its success: whatever leaves by an exception in between has been told to the console.
bool start_failed = false;

// The window size that Init agreed on with the engine; what a host without a window gets its images in.
VkExtent2D agreed_size { 640, 480 };

// For what driver and module compile; empty: nowhere.
std::string cache_directory()
{
    const CacheFolder folder = find_cache_folder();
    if (folder.path.empty())
        engine::print("ref_vkpt: compiled shaders are not kept for the next start: {}", folder.reason);
    return folder.path;
}

VSync vsync()
{
    const int wanted = cvars::values().r_vsync;
    return wanted == 0 ? VSync::off : wanted == 2 ? VSync::adaptive : VSync::on;
}

WindowWishes window_wishes()
{
    const CvarValues& cvars = cvars::values();
    return { vsync(), cvars.pt_hdr != 0, cvars.pt_hdr_peak, cvars.pt_hdr_paper_white };
}

GraphicsSettings graphics_settings(void* sdl_window)
{
    const CvarValues& cvars = cvars::values();
    GraphicsSettings settings;
    settings.sdl_window = sdl_window;
    settings.size = agreed_size;
    settings.device_name_part = cvars.pt_device;
    settings.cache_directory = cache_directory();
    settings.validation = cvars.pt_validation != 0;
    settings.ray_tracing = cvars.pt_device_rays != 0;
    settings.table_reads = TableReads(find_choice(find_cvar_row("pt_table_reads")->choices, cvars.pt_table_reads));
    settings.pipeline_statistics = !wanted_statistics_file().empty();
    settings.window = window_wishes();
    return settings;
}

void check_light_sampler()
{
    const std::string& name = cvars::values().pt_light_sampler;
    if (find_light_sampler(name))
        return;
    std::string known;
    for (const LightSampler& sampler : light_samplers())
        known += fmt::format("{}{}", known.empty() ? "" : ", ", sampler.name);
    engine::print("vkpt: there is no pt_light_sampler \"{}\"; there are: {}", name, known);
    cvars::set("pt_light_sampler", find_cvar_row("pt_light_sampler")->initial);
    cvars::update();
}

// True: they have changed. Commands read them, too: the light sampler's name may be new though nothing has changed
// here.
bool update_settings()
{
    const bool changed = cvars::update();
    check_light_sampler();
    return changed;
}

engine::VideoSize wanted_size()
{
    const CvarValues& cvars = cvars::values();
    if (cvars.r_mode == -2)
        if (const auto desktop = engine::desktop_size())
            return *desktop;
    if (const auto size = engine::mode_size(cvars.r_mode))
        return *size;
    return { std::clamp(cvars.r_customwidth, 64, 16384), std::clamp(cvars.r_customheight, 64, 16384) };
}

Filtering filtering()
{
    const CvarValues& cvars = cvars::values();
    return { cvars.r_2D_unfiltered != 0, cvars.r_videos_unfiltered != 0, cvars.r_nolerp_list, cvars.r_lerp_list };
}

// Within what the menu's slider and its neighbours can say: the configuration may hold anything.
Brightness brightness()
{
    const CvarValues& cvars = cvars::values();
    return { std::clamp(cvars.gl3_intensity_2D, 0.0f, 100.0f), std::clamp(cvars.vid_gamma, 0.1f, 10.0f) };
}

// The last frame as shown; it waits for the device. Empty: there was none.
formats::Image read_image()
{
    static_assert(sizeof(formats::Rgba8) == 4);
    const ImageSize size = extension_table().frame_size();
    formats::Image image { size.width, size.height, {} };
    image.pixels.resize(size_t(size.width) * size_t(size.height));
    if (image.pixels.empty() || !extension_table().capture_display(&image.pixels[0].r))
        return {};
    return image;
}

void take_screenshot()
{
    const formats::Image image = read_image();
    if (image.pixels.empty())
        engine::print("vkpt: no screenshot: no frame has been drawn yet");
    else
        engine::write_screenshot({ image.width, image.height }, 4, image.pixels.data());
}

// nullptr: pt_times is 0.
PassStatistics* wanted_statistics()
{
    return running && cvars::values().pt_times != 0 ? &running->pass_statistics : nullptr;
}

// Those of the module's own that are not at their default.
std::vector<std::pair<std::string, std::string>> changed_settings()
{
    std::vector<std::pair<std::string, std::string>> settings;
    for (const CvarRow& row : cvar_rows)
        if (const engine::Cvar* cvar = engine::get_cvar(row.name, row.initial, engine::CVAR_NONE);
            row.owner == CvarOwner::module && cvar && cvar->text && std::string_view(cvar->text) != row.initial)
            settings.emplace_back(row.name, cvar->text);
    return settings;
}

void write_bench_report(const Module& m)
{
    const std::string& name = cvars::values().pt_bench_json;
    if (name.empty() || m.pass_statistics.empty())
        return;
    if (!is_plain_name(name)) {
        engine::print("ref_vkpt: pt_bench_json \"{}\" may have only letters, digits, _ and -", name);
        return;
    }
    BenchFacts facts;
    facts.scene = m.scene.map_path();
    facts.width = int(m.graphics.size().width);
    facts.height = int(m.graphics.size().height);
    facts.first_frame_seconds = m.first_frame_seconds;
    facts.settings = changed_settings();
    const std::string report = make_bench_report(m.pass_statistics, extension_table().info(), facts);
    try {
        const OutputFolder folder(engine::game_directory(), { "vkpt", "bench" });
        const std::string file = name + ".json";
        folder.write(file, std::as_bytes(std::span(report)), bench_report_head);
        engine::print("ref_vkpt: wrote {}", (folder.path() / file).string());
    } catch (const FileError& error) {
        engine::print("ref_vkpt: {}", error.what());
    }
}

void print_pass_statistics(Module& m)
{
    if (!m.graphics.is_recording()) {
        m.graphics.finish();
        m.graphics.timer.read_back_all(m.graphics.slot());
    }
    if (m.pass_statistics.empty())
        engine::print("ref_vkpt: no times were collected: set pt_times 1");
    for (const PassStatistics::Pass& pass : m.pass_statistics.passes())
        engine::print("ref_vkpt: pass {} median {:.3f} ms, p95 {:.3f} ms", pass.name, find_median(pass.milliseconds),
            find_quantile(pass.milliseconds, 0.95));
    write_bench_report(m);
}

void close_module()
{
    struct Closing {
        ~Closing()
        {
            CpuTimer::collect_into(nullptr);
            running = nullptr;
        }
    } const closing;
    if (!running)
        return;
    running->photo.leave(); // the game goes on
    if (const std::string file = wanted_statistics_file(); !file.empty())
        write_pipeline_statistics(file, running->graphics.device, running->graphics.pipelines);
    if (!running->pass_statistics.empty())
        print_pass_statistics(*running);
}

// In the last view; the device is between frames.
void measure_trace_backends(Module& m)
{
    if (!m.view().snapshot || m.graphics.is_recording()) {
        engine::print("ref_vkpt: rays are measured in a map: start one first");
        return;
    }
    m.trace_choice.measure([&](TraceBackend backend) { return measure_trace_backend(m.queries(), backend); });
}

void toggle_flashlight() { cvars::set("pt_flashlight", cvars::values().pt_flashlight != 0 ? "0" : "1"); }

// Where the view is, as a line for maps/cameras/NAME.txt.
void print_camera(const Module& m)
{
    if (!m.last_camera)
        return engine::print("camera: start a map, and look as a camera of it should");
    formats::SecurityCamera camera;
    camera.eye = m.last_camera->eye;
    camera.forward = glm::normalize(m.last_camera->forward);
    engine::print("{}", formats::write_camera(camera));
}

struct Command {
    const char* name;
    void (*function)();
};
// Each wrapped, so that what it throws becomes the engine's error.
constexpr Command commands[] = {
    { "pt_info", [] { run_command(print_info); } },
    { "pt_trace_measure", [] { run_command([] { module() ? measure_trace_backends(*module()) : void(); }); } },
    { "pt_preset", [] { run_command([] { module() ? module()->preset.run() : void(); }); } },
    { "pt_lights", [] { run_command([] { module() ? module()->light_inspector.run(*module()) : void(); }); } },
    { "pt_menu", [] { run_command([] { module() ? module()->overlay.toggle_menu() : void(); }); } },
    { "pt_photo", [] { run_command([] { module() ? run_photo_command(*module()) : void(); }); } },
    { "pt_replay", [] { run_command([] { module() ? run_replay_command(*module()) : void(); }); } },
    { "mat", [] { run_command([] { module() ? run_material_command(*module()) : void(); }); } },
    { "camera", [] { run_command([] { module() ? print_camera(*module()) : void(); }); } },
    { "flashlight", [] { run_command(toggle_flashlight); } },
    { "reload_shader", [] { run_command([] { module() ? module()->shader_reload.look() : void(); }); } },
    { "pt_times_print", [] { run_command([] { module() ? print_pass_statistics(*module()) : void(); }); } },
    { "screenshot", [] { run_command(take_screenshot); } },
    { "imagelist", [] { run_command([] { module() ? module()->textures.print_list() : void(); }); } },
    { "modellist", [] { run_command([] { module() ? module()->scene.print_models() : void(); }); } },
};
bool commands_added = false;

} // namespace

Module::Module(const GraphicsSettings& settings)
    : graphics(settings)
    , trace_choice(
          graphics.device, settings.cache_directory.empty() ? "" : settings.cache_directory + "/trace_backends.txt")
    , textures(graphics.gpu, graphics.bindings, graphics.uploader)
    , draw2d(graphics.gpu, graphics.bindings, graphics.pipelines, textures, frames_in_flight)
    , scene(textures)
    , frame(graphics, workers)
    , shader_reload(cvars::values().pt_shader_dir, graphics.pipelines)
{
}

Module::~Module() { vkDeviceWaitIdle(graphics.device.handle); }

void Module::renew_scene()
{
    for (View& each : views)
        each.is_frozen = false;
    photo.renew_scene();
}

Module* module() { return running.get(); }

namespace renderer {

// ---- start and end

int prepare_for_window()
{
    start_failed = true;
    load_vulkan_library();
    start_failed = false;
    return sdl_vulkan_window_flag;
}

bool init_context(void* sdl_window)
{
    close_module();
    start_failed = true;
    running = std::make_unique<Module>(graphics_settings(sdl_window));
    start_failed = false;
    const Device& device = running->graphics.device;
    engine::print("ref_vkpt: {} ({}), Vulkan {}{}", device.properties.deviceName, device.driver,
        describe_api_version(device.properties.apiVersion), device.async_queue ? ", a second queue for compute" : "");
    running->frame.set_trace_backend(running->trace_choice.choose(cvars::values().pt_trace));
    if (sdl_window)
        running->overlay.take_keys();
    return true;
}

void shutdown_context() { close_module(); }

bool init()
{
    cvars::register_all();
    check_light_sampler();
    engine::init_video_menu();
    for (const Command& command : commands)
        engine::add_command(command.name, command.function);
    commands_added = true;
    const engine::VideoSize wanted = wanted_size();
    agreed_size = { uint32_t(wanted.width), uint32_t(wanted.height) };
    start_failed = false;
    const auto size = engine::init_graphics(cvars::values().vid_fullscreen, wanted);
    if (!size || !running) {
        if (!start_failed)
            engine::print("ref_vkpt: the engine could not open a window of {} x {} for Vulkan; is a Vulkan driver "
                          "installed (see vulkaninfo)? Without a GPU, install mesa-vulkan-drivers",
                wanted.width, wanted.height);
        return false;
    }
    agreed_size = { uint32_t(size->width), uint32_t(size->height) };
    running->graphics.set_size(agreed_size);
    return true;
}

void shutdown()
{
    if (commands_added)
        for (const Command& command : commands)
            engine::remove_command(command.name);
    commands_added = false;
    close_module();
    give_back_free_memory();
}

bool is_vsync_active() { return running && running->graphics.is_vsync_active(); }

void get_drawable_size(int* width, int* height)
{
    const VkExtent2D size = running ? running->graphics.size() : agreed_size;
    *width = int(size.width);
    *height = int(size.height);
}

std::string describe_lost_device()
{
    if (!running)
        return {};
    const Module& m = *running;
    std::string settings = fmt::format("pt_trace {}", name_of(m.frame.trace_backend()));
    for (const auto& [name, value] : changed_settings())
        if (name != "pt_trace")
            settings += fmt::format(", {} {}", name, value);
    const VkExtent2D size = m.graphics.size();
    return fmt::format("{} (images of {} x {}, map {}, {}); if it happens again, update the graphics driver, or try "
                       "pt_trace software, and report these lines",
        m.graphics.markers.describe_last(), size.width, size.height, m.scene.map_path(), settings);
}

// ---- registration

// Images that are compared, and times, are of the sampler and the shaders that were asked for.
static bool wants_settled_frames()
{
    const CvarValues& cvars = cvars::values();
    return cvars.pt_seed != 0 || cvars.pt_accumulate != 0 || cvars.pt_times != 0;
}

// Whether a material may be a screen that shows a camera's picture.
static bool may_have_screens(const Module& m)
{
    return cvars::values().pt_cameras != 0 && m.scene.world() && !m.scene.world()->cameras.empty();
}

// Shaders that are edited are compiled often enough.
static void fix_choices(Module& m)
{
    const shared::ShaderCvars cvars = cvars::shader_values();
    if (m.graphics.device.traits.specializes_pipelines && !m.shader_reload.is_on())
        m.graphics.pipelines.fix({ cvars.pt_light_weight, cvars.pt_light_point, cvars.pt_bounces, cvars.pt_indirect,
                                     may_have_screens(m) ? 1 : 0 },
            wants_settled_frames());
}

void begin_registration(std::string_view map)
{
    Module& m = *running;
    update_settings();
    // A level that was dropped half-way through a frame leaves one open.
    m.graphics.end_frame();
    m.graphics.finish();
    leave_photo_mode(m);
    m.replay_ring.begin_map(map);
    for (View& view : m.views)
        if (&view != &m.view())
            view = {}; // gives its memory back
    m.view().begin_world({});
    m.gpu_world = {};
    m.last_camera.reset();
    m.light_inspector.forget_map();
    m.material_inspector.forget_map();
    m.sampler_choice.forget_world();
    m.frame.forget_world();
    fix_choices(m);
    if (!m.warm_up)
        m.warm_up.emplace(m.graphics.device, m.graphics.pipelines, frame_shaders(m.frame.trace_backend()));
    m.scene.begin_registration(map);
    for (View& view : m.views)
        view.begin_world(m.scene.world()->light_lists);
}

void* register_model(std::string_view name)
{
    void* const model = running->scene.register_model(name);
    running->replay_ring.note_model(name, model);
    return model;
}

void* register_skin(std::string_view name)
{
    const Texture* const skin = running->scene.register_skin(name);
    running->replay_ring.note_skin(name, skin);
    return const_cast<Texture*>(skin);
}

void set_sky(std::string_view name, float rotate, const float axis[3])
{
    running->replay_ring.note_sky(name, rotate, axis);
    running->scene.set_sky(name, rotate, { axis[0], axis[1], axis[2] });
}

// Late, because the map's tree takes its time, on a thread of its own.
static void upload_world_if_needed()
{
    Module& m = *running;
    if (const World* world = m.scene.world(); world && m.gpu_world.version == 0)
        m.gpu_world
            = upload_world(*world, make_sampler_tables(*world, SamplerChoice::wanted_needs()), m.graphics.uploader);
}

void end_registration()
{
    running->graphics.finish();
    running->scene.end_registration();
    running->replay_ring.end_registration();
    running->textures.flush_if_needed();
    upload_world_if_needed();
    running->graphics.uploader.flush();
    give_back_free_memory();
}

// ---- the frame

static void choose_light_sampler(Module& m)
{
    const LightSampler& sampler = m.sampler_choice.choose(
        m.scene.world(), m.gpu_world, wants_settled_frames(), [&](const SamplerTables& tables) {
            m.graphics.finish();
            upload_sampler_tables(m.gpu_world, tables, m.graphics.uploader);
            m.graphics.uploader.flush();
        });
    m.frame.set_light_sampler(sampler.name);
}

static void upload_lightmaps_if_wanted(Module& m)
{
    const World* world = m.scene.world();
    if (cvars::shader_values().pt_wipe <= 0 || !world || m.gpu_world.version == 0 || m.gpu_world.luxels)
        return;
    m.graphics.finish();
    upload_lightmaps(m.gpu_world, *world, m.graphics.uploader);
    m.graphics.uploader.flush();
}

static void take_edited_shaders(Module& m)
{
    if (!m.shader_reload.is_on())
        return;
    if (m.shader_reload.update(
            frame_shaders(m.frame.trace_backend()), wants_settled_frames(), [&] { m.graphics.finish(); }))
        for (View& view : m.views)
            view.accumulated_frames = 0;
}

void begin_frame(float)
{
    Module& m = *running;
    m.overlay.obey_input(m.graphics.size());
    begin_photo_frame(m);
    if (update_settings())
        m.graphics.set_window_wishes(window_wishes());
    if (m.trace_choice.wants_measurement() && m.view().snapshot && !m.graphics.is_recording())
        measure_trace_backends(m);
    m.frame.set_trace_backend(m.trace_choice.choose(cvars::values().pt_trace));
    if (!m.graphics.is_recording()) { // else the engine left a frame by its error exit
        choose_light_sampler(m);
        fix_choices(m);
        upload_lightmaps_if_wanted(m);
        take_edited_shaders(m);
        m.light_inspector.update(m);
        m.material_inspector.update(m);
    }
    if (m.view().snapshot && !m.graphics.is_recording() && m.frame.light_cache.wants_filling(m.gpu_world))
        m.frame.light_cache.fill(m.graphics, m.frame, m.view(), m.gpu_world);
    PassStatistics* const statistics = wanted_statistics();
    m.graphics.timer.collect_into(statistics);
    CpuTimer::collect_into(statistics);
    m.frame_has_view = false;
    if (m.graphics.begin_frame())
        m.draw2d.set_output(m.graphics.output.words.address(), m.graphics.size());
    m.draw2d.begin_frame(m.graphics.slot(), filtering(), brightness());
    m.frame.begin(m.view());
}

static SceneSnapshot take_snapshot(const engine::RefDef& refdef, int projection, const engine::RefDef* player = nullptr)
{
    const CpuTimer timer("cpu scene");
    const bool looks_around = projection != shared::PROJECTION_PERSPECTIVE;
    return running->scene.take_snapshot(refdef, running->view().lights, player, looks_around);
}

static void record_view(const Viewpoint& from, const SceneSnapshot& snapshot, const GpuWorld* gpu_world, bool average)
{
    Module& m = *running;
    const CpuTimer timer("cpu record");
    m.textures.flush_if_needed();
    m.draw2d.record(m.graphics.commands());
    if (gpu_world)
        m.last_camera = from.camera;
    m.frame.record_view(m.view(), from, snapshot, gpu_world, average);
}

static void replace_snapshot(View& view, SceneSnapshot snapshot)
{
    find_previous_poses(snapshot, view.snapshot ? *view.snapshot : SceneSnapshot());
    view.snapshot = std::move(snapshot);
    view.accumulated_frames = 0;
}

// Many settings count where the scene is taken.
static bool has_other_settings(const View& view) { return !(cvars::players_values() == view.cvars); }

// What photo mode's camera sees of the view that was there when it began.
static void render_photo(const engine::RefDef& refdef, bool freeze)
{
    Module& m = *running;
    if (!m.replay)
        m.photo.keep(refdef);
    else if (m.replay->takes_moment())
        m.photo.show(m.replay->moment());
    const engine::RefDef seen = m.photo.camera_view(m.graphics.size());
    if (m.photo.takes_scene() | has_other_settings(m.view()))
        replace_snapshot(m.view(),
            take_snapshot(seen, m.photo.camera().projection, m.photo.rides() ? nullptr : &m.photo.player_view()));
    Viewpoint from = make_viewpoint(seen, m.graphics.size(), { m.photo.camera().projection });
    from.underwater = medium_at(m.scene.world()->bsp, from.camera.eye) != shared::MEDIUM_NONE;
    from.is_photo = true;
    from.exposure_stops = m.photo.camera().exposure;
    from.max_samples = PhotoMode::max_samples;
    // The filters of live images know perspective alone.
    const bool is_live = m.photo.is_moving(PhotoMode::Clock::now()) || (m.replay && m.replay->is_playing());
    const bool average = freeze || from.projection != shared::PROJECTION_PERSPECTIVE || !is_live;
    record_view(from, *m.view().snapshot, &m.gpu_world, average);
}

// Of images that are averaged.
static Projection wanted_projection()
{
    return { cvars::shader_values().pt_projection, cvars::values().pt_projection_fov };
}

void render_view(const engine::RefDef& refdef)
{
    Module& m = *running;
    if (!m.graphics.is_recording() || m.graphics.is_hidden())
        return;
    const bool has_world = !(refdef.flags & engine::RDF_NOWORLDMODEL);
    if (has_world && !m.scene.world())
        throw LevelError("a view of the world was requested before a map was registered");
    m.frame_has_view = true;
    if (m.warm_up)
        m.warm_up->wait();
    if (!has_world) {
        const Viewpoint from = make_viewpoint(refdef, m.graphics.size());
        record_view(from, take_snapshot(refdef, from.projection), nullptr, false);
        return;
    }
    if (m.gpu_world.version == 0) { // drawn during registration
        upload_world_if_needed();
        m.graphics.uploader.flush();
    }
    const bool freeze = cvars::values().pt_accumulate != 0;
    if (m.photo.is_on())
        return render_photo(refdef, freeze);
    if (!freeze)
        keep_for_replay(m, refdef);
    View& view = m.view();
    const Viewpoint from = make_viewpoint(refdef, m.graphics.size(), freeze ? wanted_projection() : Projection());
    view.is_frozen = view.is_frozen && !has_other_settings(view);
    const bool blends = std::exchange(view.blends_next, false) && freeze && view.is_frozen && view.snapshot;
    if (!freeze || !view.is_frozen || !view.snapshot || blends) {
        const uint32_t averaged = blends ? view.accumulated_frames : 0;
        replace_snapshot(view, take_snapshot(refdef, from.projection));
        view.is_frozen = freeze;
        view.accumulated_frames = averaged;
    }
    if (blends)
        view.viewpoint = from; // as if the camera had not moved
    record_view(from, *view.snapshot, &m.gpu_world, freeze);
}

// r_speeds
static void print_speeds(const Module& m)
{
    if (cvars::values().r_speeds == 0 || !m.view().snapshot || !m.scene.world())
        return;
    engine::print("{:6} triangles {:6} of models {:5} lights {:7.1f} ms", m.scene.world()->models[0].triangles.size(),
        m.view().snapshot->moving.triangle_count(),
        m.scene.world()->models[0].emitters.size() + m.view().snapshot->emitters.size(),
        m.graphics.timer.frame_milliseconds());
}

static OverlayFacts overlay_facts(const Module& m)
{
    return { m.graphics.size(), m.view().rendered_size, m.graphics.timer.frame_milliseconds(),
        &m.graphics.timer.times(), &m.shader_reload.errors(),
        m.photo.describe(m.view().accumulated_frames, describe_replay(m)), m.light_inspector.describe(),
        m.material_inspector.describe(panel_columns(m.graphics.size())) };
}

// Between the classic picture and the path-traced one (pt_wipe).
static void draw_divider(Module& m)
{
    constexpr int white = 15; // of the game's palette
    const float wipe = cvars::shader_values().pt_wipe;
    if (wipe <= 0 || wipe >= 1 || !m.frame_has_view || m.photo.is_on() || m.overlay.engine_screen.is_shown())
        return;
    const Viewpoint& shown = m.view().viewpoint;
    const int width = std::max(int(shown.size.y) / 360, 1);
    const int x = int(shown.origin.x) + int(wipe * float(shown.size.x)) - width / 2;
    m.draw2d.draw_fill({ x, int(shown.origin.y), width, int(shown.size.y) }, white);
}

void end_frame()
{
    Module& m = *running;
    if (!m.graphics.is_recording())
        return;
    if (m.frame_has_view) {
        m.graphics.timer.note_view();
        m.preset.note_frame(m.graphics.timer.frame_milliseconds());
        m.overlay.note_frame(m.graphics.timer.frame_milliseconds());
        print_speeds(m);
    }
    if (!m.photo.takes_photo()) {
        draw_divider(m);
        m.overlay.draw(m.draw2d, overlay_facts(m));
    }
    m.textures.flush_if_needed();
    m.draw2d.record(m.graphics.commands());
    m.graphics.timer.mark(m.graphics.commands(), "2d");
    m.graphics.end_frame();
    m.free_memory.end_frame({ m.gpu_world.version, m.graphics.pipelines.made() }, FreeMemory::Clock::now());
    // What the engine's server reads as the light on the player: 255 * half the radiance of a white floor, as lightmaps
    // go.
    constexpr float server_scale = 150 * 0.5f;
    if (m.scene.world() && !m.photo.is_on()) // whose camera is not the player
        engine::set_cvar("r_lightlevel", server_scale * m.frame.light_level());
    if (m.frame_has_view) {
        if (m.first_frame_seconds == 0 && wanted_statistics()) {
            m.graphics.finish();
            m.first_frame_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - m.start).count();
        }
        m.capture.end_view(read_image);
        end_photo_frame(m, read_image);
    }
}

bool end_world_renderpass() { return true; }

// ---- 2D

void* find_pic(std::string_view name) { return const_cast<Texture*>(running->textures.find(name, TextureUse::image)); }

void get_pic_size(std::string_view name, int* width, int* height)
{
    const Texture* image = running->textures.find(name, TextureUse::image);
    *width = image ? image->width : -1;
    *height = image ? image->height : -1;
}

// While photo mode shows its image alone.
static bool hides_2d() { return running->frame_has_view && running->photo.hides_2d(running->overlay.engine_screen); }

void draw_pic(int x, int y, std::string_view name, float scale, const float* tint)
{
    if (hides_2d())
        return;
    if (const Texture* image = running->textures.find(name, TextureUse::image))
        running->draw2d.draw_pic(*image, x, y, scale, tint);
}

void draw_stretched_pic(int x, int y, int width, int height, std::string_view name)
{
    running->overlay.engine_screen.note_picture(name);
    if (hides_2d())
        return;
    if (const Texture* image = running->textures.find(name, TextureUse::image))
        running->draw2d.draw_stretched(*image, { x, y, width, height });
}

void draw_character(int x, int y, int code, float scale)
{
    running->overlay.engine_screen.note_character(code);
    if (!hides_2d())
        running->draw2d.draw_character(x, y, code, scale);
}

void draw_tiled(int x, int y, int width, int height, std::string_view name)
{
    if (hides_2d())
        return;
    if (const Texture* image = running->textures.find(name, TextureUse::image))
        running->draw2d.draw_tiled(*image, { x, y, width, height });
}

void draw_fill(int x, int y, int width, int height, int palette_index)
{
    if (!hides_2d())
        running->draw2d.draw_fill({ x, y, width, height }, palette_index);
}

void draw_fade()
{
    running->overlay.engine_screen.note_fade();
    if (!hides_2d())
        running->draw2d.draw_fade();
}

void draw_raw(int x, int y, int width, int height, int columns, int rows, const uint8_t* pixels, int bits)
{
    running->draw2d.draw_raw({ x, y, width, height }, columns, rows, pixels, bits);
}

void set_palette(const uint8_t* rgb) { running->draw2d.set_palette(rgb); }

} // namespace renderer
} // namespace vkpt

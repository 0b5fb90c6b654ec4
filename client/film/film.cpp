// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt film: a trace or a demo as a film, with motion blur.
#include "client/film/encoder.hpp"
#include "client/film/time_left.hpp"
#include "client/host/errors.hpp"
#include "client/host/output_file.hpp"
#include "client/host/session_folder.hpp"
#include "client/host/trace_frames.hpp"
#include "client/options.hpp"
#include "client/progress.hpp"
#include "client/record/record.hpp"
#include "client/record/sound.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <optional>

namespace vkpt::client {

namespace {

struct FilmOptions {
    ModuleOptions module;
    SceneOptions scene;
    std::string output, engine, sound;
    bool is_silent = false;
    int samples = 64;
    double rate = 24, shutter = 0.5, from = 0, seconds = 0, aperture = 0, focus = 256;
};

constexpr double live_rate = 60; // frames a second that automatic exposure's speed is meant for

HostOptions make_film_host(const FilmOptions& options, Size size)
{
    HostOptions host = make_host_options(options.module);
    host.width = size.width;
    host.height = size.height;
    // Every sample is a frame to the module; the eye adapts by the film's frames.
    constexpr double usual_speed = 2, min_speed = 0.01, max_speed = 100;
    const double speed = std::clamp(usual_speed * live_rate / options.rate / options.samples, min_speed, max_speed);
    // Before the user's own, which win.
    const std::pair<const char*, std::string> settings[] = { { "pt_accumulate", "1" },
        { "pt_exposure_speed", fmt::format("{}", speed) }, { "pt_aperture", fmt::format("{}", options.aperture) },
        { "pt_focus", fmt::format("{}", options.focus) } };
    for (const auto& [name, value] : settings)
        host.cvars.insert(host.cvars.begin(), { name, value });
    return host;
}

formats::Image read_picture(const Extension& extension)
{
    const ImageSize size = extension.frame_size();
    formats::Image image { size.width, size.height,
        std::vector<formats::Rgba8>(size_t(size.width) * size_t(size.height)) };
    if (!extension.capture_display(&image.pixels.data()->r))
        throw Failure("the module has no finished frame to capture");
    return image;
}

// What the film is made of: a trace, and what the engine mixed while it was recorded, if it did.
struct Recorded {
    std::filesystem::path trace, sound;
};

// `folder`: where a sound is put that is made here.
Encoder::Sound find_sound(
    const FilmOptions& options, const Recorded& recorded, const std::filesystem::path& folder, double seconds)
{
    if (options.is_silent)
        return {};
    if (!options.sound.empty()) {
        if (!std::filesystem::is_regular_file(options.sound))
            throw Failure(fmt::format("--sound {}: there is no such file", options.sound));
        return { std::filesystem::absolute(options.sound), options.from, seconds };
    }
    if (recorded.sound.empty())
        return {};
    const std::filesystem::path wav = folder / "sound.wav";
    const std::string silence
        = write_sound(recorded.sound, trace::TraceReader(recorded.trace), options.from, seconds, wav);
    if (silence.empty())
        return { wav, 0, seconds };
    std::fprintf(stderr, "vkpt: the film has no sound: %s\n", silence.c_str());
    return {};
}

// Where the pictures go: into a film, or into a folder. So does the sound, which has the same length.
class Pictures {
public:
    Pictures(const FilmOptions& options, const Recorded& recorded, Size size, double seconds)
    {
        if (options.output.ends_with('/')) {
            folder_ = options.output;
            if (!options.sound.empty())
                throw WrongUse("--sound goes into a FILE.mp4, not to pictures in a folder");
            std::filesystem::create_directories(folder_);
            has_sound_ = !find_sound(options, recorded, folder_, seconds).file.empty();
            return;
        }
        if (!options.output.ends_with(".mp4"))
            throw WrongUse(
                fmt::format("-o {}: name a FILE.mp4, or a FOLDER/ for pictures frame000001.png, ...", options.output));
        if (size.width % 2 != 0 || size.height % 2 != 0)
            throw WrongUse(fmt::format("--size {}x{}: films need an even width and height, such as {}x{}; pictures in "
                                       "a FOLDER/ may have any",
                size.width, size.height, size.width + size.width % 2, size.height + size.height % 2));
        check_ffmpeg();
        file_.emplace(options.output);
        temporary_.emplace("vkpt-film-");
        const Encoder::Sound sound = find_sound(options, recorded, temporary_->path(), seconds);
        has_sound_ = !sound.file.empty();
        encoder_.emplace(film(), temporary_->path(), size.width, size.height, options.rate, sound);
    }

    void add(const formats::Image& picture)
    {
        count_++;
        if (encoder_)
            return encoder_->add(picture);
        OutputFile file(folder_ / fmt::format("frame{:06}.png", count_));
        file.write(formats::write_png(picture));
        file.commit();
    }

    bool has_sound() const { return has_sound_; }

    void finish()
    {
        if (!encoder_)
            return;
        encoder_->finish();
        file_->take(film());
        file_->commit();
    }

private:
    std::filesystem::path film() const { return temporary_->path() / "film.mp4"; }

    std::filesystem::path folder_;
    std::optional<OutputFile> file_;
    std::optional<SessionFolder> temporary_;
    std::optional<Encoder> encoder_;
    int count_ = 0;
    bool has_sound_ = false;
};

// Time left is said where stderr is no terminal, too.
void show_progress(ProgressBar& progress, TimeLeft& time_left, int done)
{
    progress.show(done);
    if (const std::string line = time_left.describe(done, TimeLeft::Clock::now()); !line.empty())
        std::fprintf(stderr, "%svkpt: %s\n", progress.is_shown() ? "\r\033[K" : "", line.c_str());
}

int count_frames(const FilmOptions& options, const TraceFrames& trace)
{
    const double length = trace.seconds(*trace.frame_count() - 1);
    if (options.from > length)
        throw WrongUse(fmt::format("--from {}: {} is {:.2f} seconds long", options.from, options.scene.scene, length));
    const double shown = options.seconds > 0 ? std::min(options.seconds, length - options.from) : length - options.from;
    const double frames = std::floor(shown * options.rate + 1e-6);
    constexpr double max_frames = 1e7;
    if (!(frames <= max_frames))
        throw WrongUse(
            fmt::format("{} is {:.0f} seconds long: choose a part with --seconds", options.scene.scene, length));
    return std::max(1, int(frames));
}

// While the shutter is open, samples are spread evenly over its time.
void expose(const FilmOptions& options, TraceFrames& trace, Host& host, int frame)
{
    const double open = options.from + frame / options.rate, time = options.shutter / options.rate;
    for (int sample = 0; sample < options.samples; sample++)
        trace.draw_moment(host, open + time * (sample + 0.5) / options.samples, sample > 0);
}

void make_film(const FilmOptions& options, FileSystem& files, const Recorded& recorded)
{
    const Size size = parse_size(options.scene.size);
    TraceFrames trace(files, recorded.trace.string(), 0);
    const int frames = count_frames(options, trace);
    const double seconds = frames / options.rate;
    Pictures pictures(options, recorded, size, seconds);
    Host host(make_film_host(options, size), &files);
    trace.register_with(host);
    for (const std::string& note : trace.notes())
        std::fprintf(stderr, "vkpt: %s\n", note.c_str());
    ProgressBar progress("filming", frames);
    TimeLeft time_left(frames, TimeLeft::Clock::now());
    constexpr int seeds = 1 << 24;
    for (int frame = 0; frame < frames; frame++) {
        host.cvars().set("pt_seed", fmt::format("{}", 1 + (options.scene.seed + frame) % (seeds - 1)));
        expose(options, trace, host, frame);
        pictures.add(read_picture(host.extension()));
        show_progress(progress, time_left, frame + 1);
    }
    progress.finish();
    pictures.finish();
    fmt::print("{}: {} frames of {} x {}, {:.1f} s, {}\n", options.output, frames, size.width, size.height, seconds,
        pictures.has_sound() ? "with sound" : "without sound");
}

void run_film(const FilmOptions& options)
{
    FileSystem files(options.scene.base_folder, options.scene.game);
    const std::string& scene = options.scene.scene;
    if (scene.ends_with(".rtrace"))
        return make_film(options, files, { scene, {} });
    if (scene.ends_with(".bsp") || scene.find('@') != std::string::npos)
        throw WrongUse(fmt::format("\"{}\" is no recorded game: name a FILE.rtrace or a demo (.dm2)", scene));
    RecordOptions record;
    record.demo = scene;
    record.engine = options.engine;
    record.game = options.scene.game;
    record.size = options.scene.size;
    record.with_sound = !options.is_silent && options.sound.empty();
    const std::unique_ptr<EngineRun> run = record_demo(record, files);
    make_film(options, files, { run->trace(), record.with_sound ? run->sound() : std::filesystem::path() });
}

} // namespace

void add_film_command(CLI::App& program)
{
    const auto options = std::make_shared<FilmOptions>();
    CLI::App* command = program.add_subcommand("film",
        "Make a film of a trace or a demo, with motion blur and depth of field, by averaging many samples a frame; a "
        "demo's sound goes with it");
    add_scene_options(*command, options->scene);
    command->add_option("-o,--output", options->output, "FILE.mp4, written by ffmpeg; or FOLDER/ for PNG pictures")
        ->required()
        ->type_name("FILE");
    command->add_option("--spp", options->samples, "Samples for each of a frame's pixels, each at a time of its own")
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 16))
        ->capture_default_str();
    command->add_option("--fps", options->rate, "Frames a second")
        ->type_name("N")
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
    command
        ->add_option(
            "--shutter", options->shutter, "Share of a frame's time that the shutter is open; 0: no motion blur")
        ->type_name("SHARE")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    command->add_option("--from", options->from, "Seconds after the first recorded frame")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    command->add_option("--seconds", options->seconds, "Length of the film; 0: to the end")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    command->add_option("--aperture", options->aperture, "Diameter of the lens in units; 0: all is sharp")
        ->type_name("UNITS")
        ->check(CLI::Range(0.0, 1000.0))
        ->capture_default_str();
    command->add_option("--focus", options->focus, "Distance of what is sharp, in units")
        ->type_name("UNITS")
        ->check(CLI::Range(1.0, 100000.0))
        ->capture_default_str();
    CLI::Option* sound
        = command
              ->add_option("--sound", options->sound,
                  "What is heard, as long as the trace: of vkpt record --sound, or any sound that ffmpeg "
                  "reads (default: a demo's own; none for traces)")
              ->type_name("FILE");
    command->add_flag("--no-sound", options->is_silent, "A silent film")->excludes(sound);
    command
        ->add_option("--engine", options->engine,
            "For demos: the Yamagi Quake II executable (default: $VKPT_ENGINE, then the usual places)")
        ->type_name("PATH");
    add_module_options(*command, options->module);
    add_examples(*command,
        { "vkpt film game.rtrace -o game.mp4", "vkpt film vkpt1.dm2 --size 1920x1080 --spp 256 -o tour.mp4",
            "vkpt film game.rtrace --sound game.wav -o game.mp4",
            "vkpt film game.rtrace --from 12 --seconds 4 --aperture 6 --focus 180 -o out/frames/" });
    command->callback([options] { run_film(*options); });
}

} // namespace vkpt::client

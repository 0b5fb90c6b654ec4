// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt record: a demo as a trace, by the engine itself.
#include "client/record/record.hpp"
#include "client/host/errors.hpp"
#include "client/host/file_system.hpp"
#include "client/host/output_file.hpp"
#include "client/options.hpp"
#include "client/progress.hpp"
#include "client/record/sound.hpp"
#include "common/trace/trace_reader.hpp"

#include <chrono>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <iterator>
#include <memory>

namespace vkpt::client {

namespace fs = std::filesystem;

namespace {

constexpr int server_messages_per_second = 10;

// A demo is a chain of the server's messages, each led by its length; -1 ends it. Nothing: the chain is broken.
std::optional<int> count_messages(const std::vector<std::byte>& demo)
{
    int count = 0;
    for (size_t at = 0; at + sizeof(int32_t) <= demo.size(); count++) {
        int32_t length = 0;
        std::memcpy(&length, demo.data() + at, sizeof length);
        at += sizeof length;
        if (length == -1)
            break;
        if (length < 0 || size_t(length) > demo.size() - at)
            return std::nullopt;
        at += size_t(length);
    }
    return count > 0 ? std::optional(count) : std::nullopt;
}

struct Demo {
    std::string name; // in demos/
    std::vector<std::byte> file; // empty: in the game data
    int messages = 0;
};

Demo find_demo(const FileSystem& files, const std::string& wanted)
{
    Demo demo;
    std::error_code ignored;
    std::vector<std::byte> bytes;
    if (fs::is_regular_file(wanted, ignored)) {
        demo.name = "recorded.dm2"; // whatever the file is called, the engine's console can say it
        std::ifstream stream(wanted, std::ios::binary);
        const std::string text { std::istreambuf_iterator<char>(stream), {} };
        const auto* begin = reinterpret_cast<const std::byte*>(text.data());
        demo.file = bytes = std::vector<std::byte>(begin, begin + text.size());
    } else {
        demo.name = wanted.ends_with(".dm2") ? wanted : wanted + ".dm2";
        const auto found = files.read("demos/" + demo.name);
        if (!found || demo.name.find_first_of("\"; \n") != std::string::npos)
            throw Failure(fmt::format("no demo {}: neither a file nor demos/{} in\n  {}\nThere are: {}", wanted,
                demo.name, fmt::join(files.search_path(), "\n  "), fmt::join(files.list("demos", ".dm2"), " ")));
        bytes = *found;
    }
    const std::optional<int> messages = count_messages(bytes);
    if (!messages)
        throw Failure(fmt::format("{} is not a Quake II demo (.dm2)", wanted));
    demo.messages = *messages;
    return demo;
}

// The same sound from everybody's configuration. The engine mixes ahead of what is heard, here by little more than a
// frame (`step` in microseconds): a sound that starts with a frame is heard with it.
void add_sound_settings(EngineRunOptions& run, int step)
{
    constexpr double mixed_ahead = 1.25; // frames
    run.settings.insert(run.settings.end(),
        { { "s_mixahead", fmt::format("{:.6f}", step * 1e-6 * mixed_ahead) }, { "s_khz", "44" }, { "sndbits", "16" },
            { "sndchannels", "2" }, { "s_volume", "0.7" } });
}

EngineRunOptions make_run(const RecordOptions& options, const FileSystem& files, Demo demo)
{
    const Size size = parse_size(options.size);
    EngineRunOptions run;
    run.engine = options.engine;
    run.data_folder = files.base_folder();
    run.game = options.game == "baseq2" ? "" : options.game;
    run.demo = std::move(demo.name);
    run.demo_file = std::move(demo.file);
    const auto set = [&](const char* name, int number) { run.settings.emplace_back(name, std::to_string(number)); };
    set("r_mode", -1);
    set("r_customwidth", size.width);
    set("r_customheight", size.height);
    set("timedemo", options.timedemo);
    // Microseconds a frame. With timedemo, too: else the clock on the wall decides about a millisecond now and then.
    const int step
        = options.timedemo ? 1000000 / server_messages_per_second : (1000000 + options.rate / 2) / options.rate;
    set("fixedtime", step);
    run.with_sound = options.with_sound;
    if (options.with_sound)
        add_sound_settings(run, step);
    for (const auto& setting : parse_settings(options.settings, "--set")) {
        if ((setting.first + setting.second).find_first_of("\"\n") != std::string::npos)
            throw WrongUse(fmt::format("--set {}: no quotation marks or line breaks", setting.first));
        run.settings.push_back(setting);
    }
    return run;
}

} // namespace

std::unique_ptr<EngineRun> record_demo(const RecordOptions& options, const FileSystem& files)
{
    Demo demo = find_demo(files, options.demo);
    const int expected = options.timedemo ? demo.messages : demo.messages * options.rate / server_messages_per_second;
    EngineRunOptions run_options = make_run(options, files, std::move(demo));
    ProgressBar progress("recording", expected);
    run_options.on_progress = [&](const fs::path& trace) { progress.show(int(trace::count_views(trace))); };
    auto run = std::make_unique<EngineRun>(run_options);
    progress.finish();
    const trace::TraceReader reader(run->trace());
    if (reader.frame_count() == 0 || reader.cut_at())
        throw Failure(fmt::format("the engine drew no frame of {}", options.demo));
    return run;
}

namespace {

void run_record(const RecordOptions& options)
{
    if (!options.output.ends_with(".rtrace"))
        throw WrongUse(fmt::format("-o {}: name a FILE.rtrace", options.output));
    if (options.with_sound && !options.sound.ends_with(".wav"))
        throw WrongUse(fmt::format("--sound {}: name a FILE.wav", options.sound));
    OutputFile output(options.output);
    const FileSystem files(options.base_folder, options.game);
    const auto start = std::chrono::steady_clock::now();
    const std::unique_ptr<EngineRun> run = record_demo(options, files);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const trace::TraceReader reader(run->trace());
    const size_t frames = reader.frame_count();
    const double shown = reader.seconds(frames - 1);
    const std::string silence
        = options.with_sound ? write_sound(run->sound(), reader, 0, shown, options.sound) : std::string();
    output.take(run->trace());
    output.commit();
    fmt::print("{}: {} frames, {:.1f} s, {:.0f} kB ({:.1f} kB a second), recorded in {:.1f} s\n", options.output,
        frames, shown, double(reader.file_bytes()) / 1000, double(reader.file_bytes()) / 1000 / std::max(shown, 1e-3),
        seconds);
    if (!silence.empty())
        std::fprintf(stderr, "vkpt: %s is not written: %s\n", options.sound.c_str(), silence.c_str());
}

} // namespace

void add_record_command(CLI::App& program)
{
    const auto options = std::make_shared<RecordOptions>();
    CLI::App* command
        = program.add_subcommand("record", "Play a demo in the engine and record what it draws as a trace");
    command->add_option("DEMO", options->demo, "A .dm2 file, or the name of one in the game data")->required();
    command->add_option("-o,--output", options->output, "FILE.rtrace")->required()->type_name("FILE");
    CLI::Option* rate
        = command->add_option("--rate", options->rate, "Frames per second, interpolated between the server's messages")
              ->type_name("N")
              ->check(CLI::Range(10, 1000))
              ->capture_default_str();
    command->add_flag("--timedemo", options->timedemo, "One frame per server message instead, ten a second")
        ->excludes(rate);
    command->add_option("--sound", options->sound, "FILE.wav: also write what is heard, as long as the trace")
        ->type_name("FILE");
    command->add_option("--size", options->size, "The window size that 2D is laid out for")
        ->type_name("WxH")
        ->capture_default_str();
    add_data_options(*command, options->base_folder, options->game);
    command
        ->add_option("--engine", options->engine,
            "The Yamagi Quake II executable (default: $VKPT_ENGINE, then the usual places)")
        ->type_name("PATH");
    command->add_option("--set", options->settings, "Set a console variable of the engine; may be repeated")
        ->type_name("NAME=VALUE")
        ->take_all()
        ->expected(1);
    add_examples(*command,
        { "vkpt record vkpt1.dm2 -o vkpt1.rtrace",
            "vkpt record ~/demos/fight.dm2 --game xatrix --basedir ~/quake2 -o fight.rtrace",
            "vkpt record demo1 --timedemo --size 1920x1080 -o demo1.rtrace" });
    command->callback([options] {
        options->with_sound = !options->sound.empty();
        run_record(*options);
    });
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt bench: how long each part of a frame takes.
#include "client/bench/bench_report.hpp"
#include "client/bench/collected_times.hpp"
#include "client/host/errors.hpp"
#include "client/host/frame_source.hpp"
#include "client/host/output_file.hpp"
#include "client/options.hpp"
#include "client/progress.hpp"
#include "ref_vkpt/cvars_rows.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <sys/resource.h>

namespace vkpt::client {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int default_frames = 200;
// In frames, where two variants take turns; and what is taken for alike by the confidence intervals. Of two frames one
// is timed as a whole, the other one pass by pass.
constexpr int shortest_turn = 2, longest_turn = 16;
constexpr int counted_frames = 8; // for rays

struct BenchOptions {
    ModuleOptions module;
    SceneOptions scene;
    std::string json, against, ab;
    int frames = 0, warmup = 10;
};

struct Setting {
    std::string name, value;
};

double milliseconds_since(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// NAME=V1,V2
std::vector<Setting> parse_ab(const std::string& text)
{
    const size_t equals = text.find('='), comma = text.find(',', equals == std::string::npos ? 0 : equals);
    const bool is_sound = equals != std::string::npos && equals > 0 && comma != std::string::npos
        && text.find(',', comma + 1) == std::string::npos;
    if (!is_sound)
        throw WrongUse(fmt::format("--ab {}: write --ab NAME=VALUE,VALUE", text));
    const std::string name = text.substr(0, equals);
    return { { name, text.substr(equals + 1, comma - equals - 1) }, { name, text.substr(comma + 1) } };
}

// The module runs, the scene is there; measures one variant's turns.
class Bench {
public:
    Bench(const BenchOptions& options, FileSystem& files, const HostOptions& host_options)
        : options_(options)
        , start_(Clock::now())
        , source_(open_frame_source(files, options.scene.scene))
        , host_(host_options, &files)
        , first_(source_->chosen_frame())
    {
        const std::optional<int> count = source_->frame_count();
        const int left = count ? *count - first_ : options.frames ? options.frames : default_frames;
        frames_ = options.frames ? options.frames : std::min(left, default_frames);
        if (frames_ > left)
            throw WrongUse(
                fmt::format("--frames {}: from frame {} on, {} has {}", frames_, first_, options.scene.scene, left));
        if (frames_ < shortest_turn)
            throw WrongUse(fmt::format("{} has only one frame: choose another scene", options.scene.scene));
        source_->register_with(host_);
        for (const std::string& note : source_->notes())
            std::fprintf(stderr, "vkpt: %s\n", note.c_str());
        source_->draw(host_, first_);
        wait();
        first_frame_seconds_ = milliseconds_since(start_) / 1000;
    }

    // One result per variant; without variants, one.
    std::vector<BenchResult> run(const std::vector<Setting>& variants)
    {
        const size_t count = std::max<size_t>(variants.size(), 1);
        const int turn = variants.empty() ? frames_ : turn_length();
        ProgressBar progress("measuring", int(count) * (frames_ + options_.warmup));
        int done = 0;
        std::vector<BenchResult> results(count);
        for (size_t i = 0; i < count; i++) {
            choose(variants, i);
            for (int frame = 0; frame < options_.warmup; frame++, progress.show(++done))
                source_->draw(host_, first_ + frame % frames_);
            check_choice(variants, i);
        }
        for (int begin = 0; begin < frames_; begin += turn)
            for (size_t i = 0; i < count; i++) {
                choose(variants, i);
                measure(results[i], begin, std::min(begin + turn, frames_));
                progress.show(done += std::min(turn, frames_ - begin));
            }
        for (size_t i = 0; i < count; i++) {
            choose(variants, i);
            describe(results[i]);
        }
        return results;
    }

    int turn_length() const { return std::clamp(frames_ / 20, shortest_turn, longest_turn); }

private:
    void wait() const
    {
        size_t count = 0;
        host_.extension().collected_times(&count);
    }

    void choose(const std::vector<Setting>& variants, size_t i)
    {
        if (!variants.empty())
            host_.cvars().set(variants[i].name, variants[i].value);
    }

    void check_choice(const std::vector<Setting>& variants, size_t i)
    {
        if (variants.empty())
            return;
        const auto& [name, value] = variants[i];
        if (!host_.cvars().was_asked_for(name))
            throw WrongUse(fmt::format("--ab {}: there is no such variable; `vkpt info --cvars` lists them", name));
        if (const std::string_view used = host_.cvars().find(name)->text; used != value)
            throw WrongUse(fmt::format(
                "--ab {}: the module uses {} instead of {}; `vkpt info --cvars` lists the values", name, used, value));
    }

    // In turns, every frame waits for the device: else a turn would begin with what the other value left in flight.
    void measure(BenchResult& result, int begin, int end)
    {
        const bool in_turns = end - begin < frames_;
        if (in_turns) {
            // The first frame with another value may have lost its history, which later ones have.
            source_->draw(host_, first_ + begin);
            wait();
        }
        host_.extension().forget_times();
        for (int frame = begin; frame < end; frame++) {
            source_->draw(host_, first_ + frame);
            if (in_turns)
                wait();
        }
        add_collected_times(host_.extension(), result);
    }

    // All that is not a time, after the measurement: counting rays costs time.
    void describe(BenchResult& result)
    {
        result.scene = options_.scene.scene;
        result.frames = frames_;
        result.width = host_.width();
        result.height = host_.height();
        result.first_frame_seconds = first_frame_seconds_;
        host_.cvars().set("pt_count_rays", "1");
        const int counted = std::min(counted_frames, frames_);
        for (int i = 0; i < counted; i++) {
            source_->draw(host_, first_ + i * frames_ / counted);
            const ModuleInfo info = host_.extension().info();
            result.nearest_rays += double(info.nearest_rays) / counted;
            result.visibility_rays += double(info.visibility_rays) / counted;
        }
        host_.cvars().set("pt_count_rays", "0");
        const ModuleInfo info = host_.extension().info();
        result.device = info.device;
        result.driver = info.driver;
        result.trace_backend = info.trace_backend;
        result.gpu_mib = find_device_mib(info);
        rusage usage {};
        getrusage(RUSAGE_SELF, &usage);
        result.peak_rss_mib = double(usage.ru_maxrss) / 1024; // Linux counts in KiB
        for (const CvarRow& row : cvar_rows)
            if (const engine::Cvar* cvar = host_.cvars().find(row.name); cvar && row.owner == CvarOwner::module
                && std::string_view(row.name) != "pt_times" && std::string_view(cvar->text) != row.initial)
                result.settings.emplace_back(row.name, cvar->text);
    }

    const BenchOptions& options_;
    const Clock::time_point start_;
    const std::unique_ptr<FrameSource> source_;
    Host host_;
    const int first_;
    int frames_ = 0;
    double first_frame_seconds_ = 0;
};

HostOptions make_bench_host(const BenchOptions& options)
{
    const Size size = parse_size(options.scene.size);
    HostOptions host = make_host_options(options.module);
    host.width = size.width;
    host.height = size.height;
    host.cvars.insert(host.cvars.begin(), { "pt_seed", std::to_string(options.scene.seed) });
    host.cvars.emplace_back("pt_times", "1");
    return host;
}

void check_same_scene(const BenchResult& before, const BenchResult& now, const std::string& file)
{
    if (before.scene != now.scene || before.width != now.width || before.height != now.height)
        throw Failure(fmt::format("--against {}: it measured {} at {} x {}, this run {} at {} x {}", file, before.scene,
            before.width, before.height, now.scene, now.width, now.height));
}

void run_bench(const BenchOptions& options)
{
    const std::vector<Setting> variants = options.ab.empty() ? std::vector<Setting> {} : parse_ab(options.ab);
    const HostOptions host_options = make_bench_host(options);
    std::optional<OutputFile> output;
    if (!options.json.empty())
        output.emplace(options.json);
    const std::optional<BenchResult> before
        = options.against.empty() ? std::nullopt : std::optional(read_bench_json(options.against));
    FileSystem files(options.scene.base_folder, options.scene.game);
    Bench bench(options, files, host_options);
    const std::vector<BenchResult> results = bench.run(variants);
    const size_t block = size_t(bench.turn_length());
    nlohmann::ordered_json json = to_json(results[0], BenchSamples::written);
    print_table(results[0]);
    if (!variants.empty()) {
        fmt::print("\n{}: {} against {}\n", variants[0].name, variants[1].value, variants[0].value);
        print_comparison(results[0], variants[0].value, results[1], variants[1].value, block);
        json["ab"] = { { "name", variants[0].name }, { "values", { variants[0].value, variants[1].value } },
            { "second", to_json(results[1], BenchSamples::written) },
            { "ratios", compare_to_json(results[0], results[1], block) } };
    }
    if (before) {
        check_same_scene(*before, results[0], options.against);
        fmt::print("\nagainst {}\n", options.against);
        print_comparison(*before, "before", results[0], "now", block);
        json["against"] = { { "file", options.against }, { "ratios", compare_to_json(*before, results[0], block) } };
    }
    if (output) {
        const std::string text = json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
        output->write(std::as_bytes(std::span(text)));
        output->commit();
    }
}

} // namespace

void add_bench_command(CLI::App& program)
{
    const auto options = std::make_shared<BenchOptions>();
    CLI::App* command = program.add_subcommand("bench", "Time each pass, count rays and memory");
    add_scene_options(*command, options->scene);
    command
        ->add_option("--frames", options->frames,
            "Frames to measure, from the scene's frame on (default: 200, or as many as the trace has)")
        ->type_name("N")
        ->check(CLI::Range(shortest_turn, 1 << 20));
    command->add_option("--warmup", options->warmup, "Frames before these that are not measured")
        ->type_name("N")
        ->check(CLI::Range(0, 1 << 20))
        ->capture_default_str();
    command->add_option("--json", options->json, "Also write all figures to FILE")->type_name("FILE");
    command->add_option("--against", options->against, "Compare with an earlier run's --json")->type_name("FILE");
    command->add_option("--ab", options->ab, "Measure two values of a variable in turns and compare them")
        ->type_name("NAME=VALUE,VALUE");
    add_module_options(*command, options->module);
    add_examples(*command,
        { "vkpt bench maps/vkpt1.bsp --size 640x360", "vkpt bench game.rtrace --frames 500 --json before.json",
            "vkpt bench game.rtrace --frames 500 --against before.json",
            "vkpt bench game.rtrace@700 --ab pt_light_sampler=subset,ris" });
    command->callback([options] { run_bench(*options); });
}

} // namespace vkpt::client

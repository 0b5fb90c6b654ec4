// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt_light_sampler_bench: what the light samplers cost, as ratio to `subset` with a subset of 8, and how that depends
// on the number of lights. Everything takes turns frame by frame, so that a busy machine slows all of it. Prints tables
// in Markdown, for docs/light-sampling.md.
#include "client/host/client_map.hpp"
#include "client/host/errors.hpp"
#include "common/quantile.hpp"
#include "tests/module/game_folder.hpp"
#include "tests/module/map_builder.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <sys/wait.h>
#include <unistd.h>

using namespace vkpt;

namespace {

struct Options {
    std::string base_folder, scene = "maps/vkpt1.bsp";
    int width = 640, height = 360, rounds = 9;
    std::vector<int> light_counts { 100, 10000 };
    std::vector<std::string> samplers; // empty: all
    bool only_counts = false, filtered = false;
};

struct Case {
    std::string sampler;
    int subset;
    auto operator<=>(const Case&) const = default;
};
const Case base { "subset", 8 };
const std::vector<Case> all_cases { base, { "subset", 16 }, { "subset", 32 }, { "subset", 64 },
    { "subset_onesweep", 8 }, { "subset_dynamic", 8 }, { "subset_pps", 8 }, { "subset_strides", 8 },
    { "subset_mis", 8 }, { "subset_mis_biased", 8 }, { "subset_mis_blue", 8 }, { "light_tree", 8 }, { "ris", 8 },
    { "uniform", 8 }, { "full", 8 } };

std::set<std::string> sampler_names()
{
    std::set<std::string> names;
    for (const Case& c : all_cases)
        names.insert(c.sampler);
    return names;
}

bool is_wanted(const Options& options, const Case& c)
{
    return options.samplers.empty() || std::ranges::find(options.samplers, c.sampler) != options.samplers.end();
}

struct Milliseconds {
    double light = 0; // the passes that choose lights
    double frame = 0; // all passes
};

// Of the part `what` of `times`, as ratio to those of the same round in `reference` where there are any.
double find_median_part(const std::vector<Milliseconds>& times, double Milliseconds::*what,
    const std::vector<Milliseconds>* reference = nullptr)
{
    std::vector<double> values;
    for (size_t i = 0; i < times.size(); i++)
        values.push_back(times[i].*what / (reference ? (*reference)[i].*what : 1));
    return find_median(std::move(values));
}

// A map in the module.
class Run {
public:
    Run(const Options& options, const std::string& base_folder, const std::string& scene)
        : options_(options)
        , files_(base_folder, "")
        , scene_(files_, client::parse_scene_name(scene))
    {
        client::HostOptions host;
        host.width = options.width;
        host.height = options.height;
        if (!options.filtered)
            host.cvars = { { "flt_denoiser", "off" }, { "flt_taa", "off" } };
        host_ = std::make_unique<client::Host>(host, &files_);
        scene_.register_with(*host_);
        host_->extension().time_every_pass();
    }

    Milliseconds measure(const Case& wanted)
    {
        host_->cvars().set("pt_light_sampler", wanted.sampler);
        host_->cvars().set("pt_light_subset", std::to_string(wanted.subset));
        host_->draw_frame(scene_.view(options_.width, options_.height, 0));
        size_t count = 0;
        const PassTime* times = host_->extension().pass_times(&count);
        Milliseconds sum;
        for (size_t i = 0; i < count; i++) {
            sum.frame += times[i].milliseconds;
            if (std::string_view(times[i].name).ends_with("direct_light"))
                sum.light += times[i].milliseconds;
        }
        if (sum.light <= 0)
            throw client::Failure("the module told no time of its passes");
        return sum;
    }

private:
    const Options& options_;
    client::FileSystem files_;
    client::ClientMap scene_;
    std::unique_ptr<client::Host> host_;
};

// A Run in a process of its own, as a process holds one module: so that runs of different maps can take turns.
class RunApart {
public:
    RunApart(const Options& options, const std::string& base_folder, const std::string& scene)
    {
        int to_child[2], from_child[2];
        if (pipe(to_child) != 0 || pipe(from_child) != 0)
            throw client::Failure("no pipe to another process");
        std::fflush(nullptr);
        child_ = fork();
        if (child_ < 0)
            throw client::Failure("no other process");
        close(to_child[child_ ? 0 : 1]);
        close(from_child[child_ ? 1 : 0]);
        if (child_ == 0)
            serve(options, base_folder, scene, to_child[0], from_child[1]);
        questions_ = to_child[1];
        answers_ = from_child[0];
    }
    ~RunApart()
    {
        // Later processes hold this pipe open, too, so that closing it would tell nothing.
        const size_t stop = all_cases.size();
        [[maybe_unused]] const ssize_t written = write(questions_, &stop, sizeof stop);
        close(questions_);
        close(answers_);
        waitpid(child_, nullptr, 0);
    }
    RunApart(const RunApart&) = delete;
    RunApart& operator=(const RunApart&) = delete;

    // As Run::measure, for a case of all_cases.
    Milliseconds measure(size_t wanted)
    {
        Milliseconds times;
        if (write(questions_, &wanted, sizeof wanted) != sizeof wanted
            || read(answers_, &times, sizeof times) != sizeof times)
            throw client::Failure("the process of one map has ended");
        return times;
    }

private:
    // Never returns, nor lets anything of the other process's be destroyed twice.
    [[noreturn]] static void serve(
        const Options& options, const std::string& base_folder, const std::string& scene, int questions, int answers)
    {
        try {
            Run run(options, base_folder, scene);
            size_t wanted = 0;
            while (read(questions, &wanted, sizeof wanted) == sizeof wanted && wanted < all_cases.size()) {
                const Milliseconds times = run.measure(all_cases[wanted]);
                if (write(answers, &times, sizeof times) != sizeof times)
                    break;
            }
        } catch (const std::exception& error) {
            fmt::print(stderr, "vkpt_light_sampler_bench: {}\n", error.what());
            _exit(1);
        }
        _exit(0);
    }

    pid_t child_ = -1;
    int questions_ = -1, answers_ = -1;
};

void print_costs(const Options& options)
{
    Run run(options, options.base_folder, options.scene);
    std::map<Case, std::vector<double>> ratios, times;
    std::vector<Case> cases;
    std::ranges::copy_if(all_cases, std::back_inserter(cases), [&](const Case& c) { return is_wanted(options, c); });
    run.measure(base); // compiles it
    for (const Case& c : cases)
        run.measure(c);
    for (int round = 0; round < options.rounds; round++)
        for (const Case& c : cases) {
            const double before = run.measure(base).light, time = run.measure(c).light, after = run.measure(base).light;
            ratios[c].push_back(2 * time / (before + after));
            times[c].push_back(time);
        }
    fmt::print("{} at {}x{}, medians of {} rounds\n\n| sampler | R | ratio | ms |\n|---|---|---|---|\n", options.scene,
        options.width, options.height, options.rounds);
    for (const Case& c : cases)
        fmt::print(
            "| `{}` | {} | {:.2f} | {:.0f} |\n", c.sampler, c.subset, find_median(ratios[c]), find_median(times[c]));
}

// What a hall under ten thousand small triangles differs in, apart from how many of them shine.
struct Hall {
    const char* name;
    const char* title;
    float triangle_size;
    bool has_window; // a large lamp in a wall, which is what the rays of a surface meet
};
const Hall halls[] = {
    { "window", "rays meet one large lamp, whatever the number of lights", 0.5f, true },
    { "lamps", "rays meet more lamps where more shine", 4, false },
};

// Geometry is the same for every number of lights.
formats::Bsp make_hall(const Hall& hall, int lights)
{
    constexpr int side = 100, all = side * side;
    tests::MapBuilder map;
    const uint16_t wall = map.add_material("wall"), dark = map.add_material("lamp"),
                   lamp = map.add_material("lamp", 0, 400);
    map.add_room({ -512, -512, 0 }, { 512, 512, 200 }, wall);
    if (hall.has_window)
        map.add({ { -511, -400, 20 }, { -511, 400, 20 }, { -511, 400, 180 }, { -511, -400, 180 } }, lamp);
    for (int i = 0; i < all; i++) {
        const glm::vec3 at(float(i % side) * 10 - 495, float(i / side) * 10 - 495, 190);
        const bool shines = i * lights / all != (i + 1) * lights / all; // evenly spread
        map.add({ at, at + glm::vec3(0, hall.triangle_size, 0), at + glm::vec3(hall.triangle_size, 0, 0) },
            shines ? lamp : dark);
    }
    return map.finish();
}

void print_counts(const Options& options, const Hall& hall)
{
    tests::GameFolder folder;
    folder.add_wall("wall", 170);
    folder.add_wall("lamp", tests::white_index);
    for (const int count : options.light_counts)
        folder.add_map(fmt::format("hall{}", count), make_hall(hall, count));
    std::vector<std::unique_ptr<RunApart>> runs;
    for (const int count : options.light_counts)
        runs.push_back(std::make_unique<RunApart>(
            options, folder.path(), fmt::format("maps/hall{}.bsp@-400,-400,100,10,45", count)));
    fmt::print("\n{}: {}; milliseconds of light and of the frame by number of small lights, and ratios to the "
               "first\n\n| sampler |",
        hall.name, hall.title);
    for (const int count : options.light_counts)
        fmt::print(" {} |", count);
    fmt::print("\n|---|");
    for (size_t i = 0; i < options.light_counts.size(); i++)
        fmt::print("---|");
    fmt::print("\n");
    for (size_t which = 0; which < all_cases.size(); which++) {
        const Case& c = all_cases[which];
        if (!is_wanted(options, c) || c.sampler == "full" || c.subset != base.subset)
            continue;
        std::vector<std::vector<Milliseconds>> times(runs.size());
        for (const auto& run : runs)
            run->measure(which); // compiles it
        for (int round = 0; round < options.rounds; round++)
            for (size_t i = 0; i < runs.size(); i++)
                times[i].push_back(runs[i]->measure(which));
        fmt::print("| `{}` |", c.sampler);
        for (const std::vector<Milliseconds>& of_run : times)
            fmt::print(" {:.0f} of {:.0f} ({:.2f}, {:.2f}) |", find_median_part(of_run, &Milliseconds::light),
                find_median_part(of_run, &Milliseconds::frame),
                find_median_part(of_run, &Milliseconds::light, &times[0]),
                find_median_part(of_run, &Milliseconds::frame, &times[0]));
        fmt::print("\n");
    }
}

} // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App program("Cost of the light samplers");
    program.add_option("--basedir", options.base_folder, "Folder that holds baseq2")->required();
    program.add_option("--scene", options.scene, "maps/NAME.bsp[@x,y,z,pitch,yaw]");
    program.add_option("--width", options.width)->check(CLI::Range(8, 8192));
    program.add_option("--height", options.height)->check(CLI::Range(8, 8192));
    program.add_option("--rounds", options.rounds)->check(CLI::Range(1, 1000));
    program.add_option("--lights", options.light_counts, "Numbers of lights in generated halls; at most 10000")
        ->check(CLI::Range(1, 10000));
    program.add_option("--samplers", options.samplers, "Only these; ratios of cost stay those to `subset`")
        ->delimiter(',')
        ->check(CLI::IsMember(sampler_names()));
    program.add_flag("--only-counts", options.only_counts, "Leave the table of costs out");
    program.add_flag("--filtered", options.filtered, "With the denoiser and anti-aliasing of the defaults");
    CLI11_PARSE(program, argc, argv);
    try {
        if (!options.only_counts)
            print_costs(options);
        for (const Hall& hall : halls) {
            std::fflush(stdout);
            print_counts(options, hall);
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "vkpt_light_sampler_bench: {}\n", error.what());
        return 1;
    }
}

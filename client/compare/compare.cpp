// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt compare: light samplers, their settings and filters against the converged picture.
#include "client/compare/report.hpp"
#include "client/compare/sheet.hpp"
#include "client/host/errors.hpp"
#include "client/host/name_list.hpp"
#include "client/options.hpp"
#include "client/output_folder.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <numeric>
#include <unistd.h>

namespace vkpt::client {

namespace fs = std::filesystem;

namespace {

struct CompareOptions {
    ModuleOptions module;
    std::vector<std::string> scenes;
    std::string size = "320x180", base_folder, game, output;
    VariantLists lists;
    MeasureOptions measure;
    bool has_all_samplers = false, makes_chapter_figures = false, ignores_cache = false;
};

// With the time that is left, on a terminal; else a line now and then.
class ProgressLine {
public:
    void set_title(std::string title) { title_ = std::move(title); }
    void show(int done, int total)
    {
        const auto now = std::chrono::steady_clock::now();
        const double since = std::chrono::duration<double>(now - last_).count();
        const bool is_terminal = isatty(STDERR_FILENO);
        if (done < total && since < (is_terminal ? 0.2 : 15))
            return;
        last_ = now;
        const double spent = std::chrono::duration<double>(now - start_).count();
        const int left = done > 0 ? int(spent * (total - done) / done) : 0;
        fmt::print(stderr, "{}{}: frame {} of {}, about {}:{:02} left{}", is_terminal ? "\r" : "", title_, done, total,
            left / 60, left % 60, is_terminal && done < total ? "  \033[K" : "\n");
        std::fflush(stderr);
    }

private:
    std::string title_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), last_ = start_;
};

std::string make_command(const CompareOptions& options)
{
    std::string command = "vkpt compare";
    if (options.makes_chapter_figures)
        command += " --figures";
    else
        command
            += fmt::format(" {} --samplers {} --subsets {} --noise {} --denoisers {}", fmt::join(options.scenes, " "),
                options.has_all_samplers ? "all" : fmt::format("{}", fmt::join(options.lists.samplers, ",")),
                fmt::join(options.lists.subsets, ","), fmt::join(options.lists.noises, ","),
                fmt::join(options.lists.denoisers, ","));
    const MeasureOptions& m = options.measure;
    command += fmt::format(" --size {} --spp {} --runs {} --frames {} --warmup {} --reference-spp {}", options.size,
        m.samples, m.runs, m.frames, m.warmup, m.reference.samples);
    if (!m.reference.sampler.empty())
        command += " --reference-sampler " + m.reference.sampler;
    for (const std::string& setting : options.module.settings)
        command += " --set " + setting;
    return command + " -o " + options.output;
}

// Scene by scene; the plan needs to know what the module has, which the first one's stage can tell.
void measure_all(const CompareOptions& options, Report& report)
{
    const StageOptions stage_options { options.module, options.base_folder, options.game, report.size };
    FigurePlan plan;
    for (const std::string& scene : options.scenes)
        plan.scenes.push_back({ scene, {} });
    auto stage = std::make_unique<Stage>(
        stage_options, options.makes_chapter_figures ? first_figure_scene() : options.scenes[0]);
    if (options.makes_chapter_figures) {
        plan = plan_chapter_figures(stage->info());
    } else {
        VariantLists lists = options.lists;
        if (options.has_all_samplers)
            lists.samplers = list_names(stage->info().light_samplers);
        for (FigureScene& scene : plan.scenes)
            scene.variants = make_variants(lists, stage->info());
    }
    std::vector<int> expected; // frames a scene, as if all were of the first one's kind
    for (const FigureScene& scene : plan.scenes)
        expected.push_back(count_frames(scene.variants, options.measure, stage->is_still()));
    int earlier = 0, later = std::accumulate(expected.begin(), expected.end(), 0);
    ProgressLine line;
    for (size_t i = 0; i < plan.scenes.size(); i++) {
        const std::string& name = plan.scenes[i].scene;
        if (i > 0) {
            stage.reset(); // the refresh API serves one host at a time
            stage = std::make_unique<Stage>(stage_options, name);
        }
        line.set_title(fmt::format("{} ({} of {})", name, i + 1, plan.scenes.size()));
        later -= expected[i];
        int drawn = 0;
        report.scenes.push_back(measure_scene(*stage, name, plan.scenes[i].variants, options.measure,
            [&](int done, int total) { line.show(earlier + (drawn = done), earlier + total + later); }));
        earlier += drawn;
        for (const std::string& note : report.scenes.back().notes)
            fmt::print(stderr, "vkpt: {}\n", note);
    }
    report.figures = std::move(plan.figures);
    for (Figure& figure : plan_plain_figures(plan.scenes))
        report.figures.push_back(std::move(figure));
}

// As Markdown: fit for a terminal and for a document.
void print_table(const Report& report)
{
    for (const SceneResult& scene : report.scenes) {
        fmt::print("\n{}, frame {}: reference of {} samples, its own RMSE {:.4f}\n\n", scene.scene, scene.frame,
            scene.reference.samples, scene.reference.rmse);
        fmt::print("| variant | RMSE | relative MSE | FLIP | bias % | low/high | flicker | ms | light ratio | "
                   "equal-time RMSE |\n"
                   "|---|---|---|---|---|---|---|---|---|---|\n");
        for (const VariantResult& r : scene.variants)
            fmt::print(
                "| `{}` | {:.3f} | {:.2f} | {:.3f} | {:+.2f} ± {:.2f} | {:.2f} | {:.3f} | {:.1f} | {:.2f} | {} |\n",
                r.variant.label(), r.error.rmse, r.error.relative_mse, r.flip, 100 * r.bias.mean, 100 * r.bias.interval,
                r.spectrum.low_to_high(), r.flicker, r.ms, r.light_ratio,
                r.equal_time_rmse ? fmt::format("{:.3f}", *r.equal_time_rmse) : "");
    }
}

void run_compare(CompareOptions options)
{
    if (options.makes_chapter_figures != options.scenes.empty())
        throw WrongUse(options.scenes.empty() ? "compare: name a SCENE, or use --figures"
                                              : "compare: --figures has scenes of its own; leave SCENE out");
    for (const std::string& setting : options.module.settings)
        if (setting.starts_with("flt_taa="))
            throw WrongUse(
                "compare: --set flt_taa: pictures are compared pixel by pixel and without anti-aliasing, which "
                "would blur the converged ones, too; leave it out");
    options.has_all_samplers = options.lists.samplers == std::vector<std::string> { "all" };
    Report report;
    report.size = parse_size(options.size);
    if (!options.ignores_cache)
        options.measure.reference.cache_folder = find_reference_folder();
    report.options = options.measure;
    report.settings = options.module.settings;
    report.command = make_command(options);
    OutputFolder output(options.output, { "index.html", "figures.json", "figures.csv", "sheet.png" });
    measure_all(options, report);
    output.write(0, make_page(report));
    output.write(1, make_json(report));
    output.write(2, make_csv(report));
    output.write(3, formats::write_png(make_sheet(report.scenes[0])));
    output.commit();
    print_table(report);
    fmt::print("\nOpen {} in a browser.\n", (fs::path(options.output) / "index.html").string());
}

void add_variant_options(CLI::App& command, VariantLists& lists)
{
    command.add_option("--samplers", lists.samplers, "Light samplers, or \"all\" (`vkpt info` lists them)")
        ->delimiter(',')
        ->type_name("A,B,...")
        ->capture_default_str();
    command.add_option("--subsets", lists.subsets, "Lengths of the subset, 1 to 64")
        ->delimiter(',')
        ->type_name("R,...")
        ->capture_default_str();
    command.add_option("--noise", lists.noises, "blue, white or both")
        ->delimiter(',')
        ->type_name("A,B")
        ->capture_default_str();
    command.add_option("--denoisers", lists.denoisers, "off, and filters (`vkpt info` lists them)")
        ->delimiter(',')
        ->type_name("A,B,...")
        ->capture_default_str();
}

void add_measure_options(CLI::App& command, MeasureOptions& options)
{
    const auto add_count = [&](const char* name, int& value, const char* help, int least, int most) {
        command.add_option(name, value, help)->type_name("N")->check(CLI::Range(least, most))->capture_default_str();
    };
    add_count("--spp", options.samples, "Samples per pixel of unfiltered pictures", 1, 1 << 16);
    add_count("--runs", options.runs, "Independent pictures of every variant", 2, 10000);
    add_count("--frames", options.frames, "Frames in a row that flicker is measured over", 2, 10000);
    add_count("--warmup", options.warmup, "Frames before them that filters see", 0, 10000);
    add_count("--reference-spp", options.reference.samples, "Samples per pixel of the converged picture", 16, 1 << 24);
    command
        .add_option(
            "--reference-sampler", options.reference.sampler, "Light sampler that draws it (default: subset_mis)")
        ->type_name("NAME");
}

} // namespace

void add_compare_command(CLI::App& program)
{
    const auto options = std::make_shared<CompareOptions>();
    CLI::App* command = program.add_subcommand(
        "compare", "Light samplers against the converged picture: one page for a browser, JSON and CSV");
    command->add_option("SCENE", options->scenes, "Maps with a camera, or frames of traces; see `vkpt render --help`");
    command->add_flag("--figures", options->makes_chapter_figures,
        "Instead: figures 47-1, 47-4, 47-5, 47-6 and 47-7 of Ray Tracing Gems II on our own map");
    add_variant_options(*command, options->lists);
    command->add_option("--size", options->size, "Picture size in pixels")->type_name("WxH")->capture_default_str();
    add_measure_options(*command, options->measure);
    command->add_flag("--no-cache", options->ignores_cache, "Draw converged pictures anew, and keep none");
    command
        ->add_option("-o,--output", options->output, "Folder for index.html, figures.json, figures.csv and sheet.png")
        ->required()
        ->type_name("DIR");
    command
        ->add_option(
            "--basedir", options->base_folder, "The folder that contains \"baseq2\" (default: the usual places)")
        ->type_name("DIR");
    command->add_option("--game", options->game, "A game folder beside baseq2, searched first")->type_name("NAME");
    add_module_options(*command, options->module);
    command->footer(
        "Example: vkpt compare maps/vkpt1.bsp --samplers subset,subset_mis --subsets 1,8,64 --noise blue,white "
        "--denoisers off,asvgf -o compared");
    command->callback([options] { run_compare(*options); });
}

} // namespace vkpt::client

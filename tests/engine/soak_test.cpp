// SPDX-License-Identifier: GPL-2.0-or-later
// Hours of play in minutes: maps, restarts, window sizes, settings, nonsense and demos in one run of the engine, in an
// order that a seed decides. Nothing may crash or pile up, and the validation layers have to stay silent.
//   VKPT_SOAK_MINUTES   how long, half of it with the validation layers (default 1); VKPT_SOAK_SEED   the order
//   (default 1)
#include "common/quantile.hpp"
#include "ref_vkpt/cvars_rows.hpp"
#include "tests/engine/engine_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <random>
#include <regex>
#include <sstream>
#include <string_view>

namespace vkpt::tests {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int max_rounds = 100, maps_per_round = 5; // 500 map changes and 100 restarts
constexpr double mebibyte = 1 << 20;
constexpr size_t first_width = 160, first_height = 90;
constexpr int settle_waits = 3;
constexpr size_t warm_up_rounds = 2, min_judged_rounds = 4;
constexpr size_t filling_rounds = 8; // until the heaps are full of holes: docs/notes/frame-times.md
constexpr double max_growth = 0.01; // of the memory in use after the warm-up
// Of resident memory, which is up to 4 % off from round to round: how much free memory lies between what is used hangs
// on the order in which threads asked for it.
constexpr double max_resident_growth = 0.05;

// Not set at random: they write files, end the run, or take another driver's measure of time.
constexpr std::string_view left_alone[]
    = { "pt_validation", "pt_device", "pt_capture_dir", "pt_capture_every", "pt_bench_json", "pt_shader_dir",
          "pt_table_reads", "pt_times", "r_mode", "r_customwidth", "r_customheight", "vid_fullscreen", "r_lightlevel" };

int read_number(const char* variable, int otherwise)
{
    const char* text = std::getenv(variable);
    return text && *text ? std::atoi(text) : otherwise;
}

class Script {
public:
    explicit Script(unsigned seed)
        : random_(seed)
    {
    }

    // What one round does; it ends in a state that is the same in every round.
    std::string write_round(std::vector<std::string>& display_commands)
    {
        counts_.emplace_back();
        std::string text;
        for (int i = 0; i < maps_per_round; i++)
            text += "map " + std::string(own_map) + "\nwait_25\n" + write_play(display_commands);
        for (const CvarRow& row : cvar_rows)
            if (is_touched(row))
                text += "set " + std::string(row.name) + " \"" + row.initial + "\"\n";
        text += write_window_size(first_width, first_height, display_commands);
        text += "vid_restart\nmap " + std::string(own_map) + "\n";
        for (int i = 0; i < settle_waits; i++) // shaders are compiled beside the first frames
            text += "wait_100\n";
        return text + "pt_info\n" + memory_mark;
    }

    // How often each kind of action stood in the first rounds.
    std::map<std::string, size_t> counts(size_t rounds) const
    {
        std::map<std::string, size_t> sum;
        for (size_t round = 0; round < std::min(rounds, counts_.size()); round++)
            for (const auto& [what, count] : counts_[round])
                sum[what] += count;
        return sum;
    }

private:
    size_t pick(size_t count) { return random_() % count; }

    static bool is_touched(const CvarRow& row)
    {
        return std::ranges::find(left_alone, row.name) == std::end(left_alone);
    }

    std::string write_play(std::vector<std::string>& display_commands)
    {
        std::string text;
        for (size_t action = 2 + pick(4); action > 0; action--)
            switch (pick(9)) {
            case 0:
                counts_.back()["demos"]++;
                text += "demomap " + std::string(own_demo) + "\nwait_100\n";
                break;
            case 1:
                counts_.back()["window sizes"]++;
                text += write_window_size(64 + pick(300), 48 + pick(200), display_commands);
                break;
            case 2:
            case 3:
                counts_.back()["lines of nonsense"]++;
                text += write_nonsense() + "\nwait_5\n";
                break;
            case 4:
                counts_.back()["commands of the module"]++;
                text += write_module_command() + "\nwait_5\n";
                break;
            case 5:
                text += "+forward\n+right\n+attack\nwait_25\n-attack\n-right\n-forward\n";
                break;
            default:
                counts_.back()["settings"]++;
                text += write_setting() + "\nwait_5\n";
            }
        return text;
    }

    static std::string write_window_size(size_t width, size_t height, std::vector<std::string>& display_commands)
    {
        display_commands.push_back(
            "xdotool search --class quake2 windowsize " + std::to_string(width) + " " + std::to_string(height));
        return display_mark;
    }

    // A cvar somewhere in its range, now and then outside of it.
    std::string write_setting()
    {
        const CvarRow* row = nullptr;
        do
            row = &cvar_rows[pick(std::size(cvar_rows))];
        while (!is_touched(*row));
        return std::string("set ") + row->name + " \"" + write_value(*row) + "\"";
    }

    std::string write_value(const CvarRow& row)
    {
        if (std::string_view(row.name) == "pt_light_sampler")
            return std::array { "subset_pps", "uniform", "light_tree", "nothing_of_the_kind" }[pick(4)];
        if (row.type == CvarType::text) {
            std::vector<std::string> choices { row.initial };
            for (std::string_view rest = row.choices; !rest.empty();) {
                const size_t end = rest.find('|');
                choices.emplace_back(rest.substr(0, end));
                rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
            }
            return choices[pick(choices.size())];
        }
        const double low = row.owner == CvarOwner::module ? row.lowest : 0,
                     high = row.owner == CvarOwner::module ? row.highest : 2;
        if (pick(10) == 0)
            return std::array { "-1", "nan", "inf", "1e300", "", "a" }[pick(6)];
        // Most values of a wide range are near its lower end, as are those that players set.
        const double at = std::uniform_real_distribution<>(0, 1)(random_);
        const double value = low + (high - low) * (high - low > 100 ? std::pow(at, 8) : at);
        return row.type == CvarType::integer ? std::to_string(std::lround(value)) : std::to_string(value);
    }

    // What stops the game goes on again at once, and no file is written.
    std::string write_module_command()
    {
        static constexpr const char* lines[] = { "pt_menu;wait;wait;pt_menu",
            "pt_photo;wait;wait;wait;pt_photo fov 60;pt_photo nothing;wait;pt_photo off",
            "pt_replay;wait;wait;wait;pt_replay seek -1;pt_replay play 0.5;wait;pt_replay off",
            "pt_photo;wait;pt_menu;pt_replay;wait;wait;pt_replay off;pt_photo off;pt_menu;wait;pt_menu",
            "mat;mat roughness_override 0.1;wait;mat kind CHROME;wait;mat nothing 1;mat reset",
            "pt_lights;pt_lights mute 1;wait;pt_lights solo 2;wait;pt_lights mute 1e9;pt_lights all",
            "flashlight;wait;wait;flashlight", "pt_preset low;wait;pt_preset nothing;pt_preset high", "camera" };
        return lines[pick(std::size(lines))];
    }

    // None that could end the engine or write a file.
    std::string write_nonsense()
    {
        static constexpr const char* words[]
            = { "pt_info", "imagelist", "modellist", "pt_times_print", "viewpos", "give all", "god", "noclip", "score",
                  "inven", "toggleconsole;wait;toggleconsole", "menu_video;wait;forcemenuoff", "zzz \"", "set", "set a",
                  "map nothere", "pt_bounces", "pt_bounces 1 2 3", "gamemap \"*\"", "sky", "kill", "use blaster",
                  "weapnext", "cmd", "say \xff\xfe\x80", "crosshair 99", "viewsize 1e9", "fov -5", "fov 1000",
                  "fov 90;viewsize 100", "bind", "alias x y;x", "pt_trace_measure", "demomap nothere.dm2" };
        if (const size_t word = pick(std::size(words) + 1); word < std::size(words))
            return words[word];
        std::string noise;
        for (size_t i = 10 + pick(200); i > 0; i--)
            noise += char('!' + pick(94));
        std::erase_if(noise, [](char c) { return c == ';' || c == '$' || c == '"'; });
        return "echo " + noise;
    }

    std::mt19937 random_;
    std::vector<std::map<std::string, size_t>> counts_; // by round
};

std::string file_of_round(int round) { return "soak" + std::to_string(round) + ".cfg"; }

// Plays rounds until half of the time is over, each of the two tests having one half, and `min_rounds` at least.
class Play {
public:
    Play(bool validation, size_t min_rounds)
    {
        const int seed = read_number("VKPT_SOAK_SEED", 1);
        const std::chrono::duration<double, std::ratio<60>> minutes(read_number("VKPT_SOAK_MINUTES", 1) / 2.0);
        Script script { unsigned(seed) };
        EngineOptions options = write_options(script, min_rounds);
        options.validation = validation;
        const auto start = Clock::now();
        bool told = false;
        options.while_running = [&](const std::filesystem::path& folder) {
            if (told || Clock::now() - start < minutes)
                return;
            std::ofstream(folder / "soak_end.cfg") << "quit\n";
            told = true;
        };
        const EngineRun run(options);
        run.expect_clean();
        resident_.assign(run.result().marked_memory.begin(), run.result().marked_memory.end());
        read_memory_in_use(run.result().console);
        handles_ = run.result().marked_handles;
        std::printf("seed %d, %.1f minutes: %zu rounds, %zu map changes, %zu restarts of video\n", seed,
            std::chrono::duration<double, std::ratio<60>>(Clock::now() - start).count(), resident_.size(),
            run.lines_with("server initialization").size(),
            run.lines_with("Successfully loaded ref_vkpt.so").size() - 1);
        for (const auto& [what, count] : script.counts(resident_.size()))
            std::printf("%zu %s\n", count, what.c_str());
        for (size_t i = 0; i < resident_.size(); i++)
            std::printf("after round %zu: %.1f MiB resident, heaps %.1f, device memory %.1f, %zu open files\n", i + 1,
                resident_[i] / mebibyte, heaps_.at(i) / mebibyte, device_.at(i) / mebibyte, handles_[i]);
        EXPECT_GE(resident_.size(), min_rounds);
    }

    void expect_flat_handles() const
    {
        for (size_t i = warm_up_rounds; i < handles_.size(); i++)
            EXPECT_EQ(handles_[i], handles_[warm_up_rounds - 1]) << "open files after round " << i + 1;
    }

    // What the heaps and the device hold, and what of it is resident, by the medians of the last third of the rounds
    // and of the third before. In the first rounds heaps fill with holes, until what is freed and what is asked for
    // fit.
    void expect_flat_memory() const
    {
        ASSERT_GE(resident_.size(), filling_rounds + min_judged_rounds);
        ASSERT_GT(heaps_.front(), 0) << "pt_info told nothing of the heaps";
        ASSERT_GT(device_.front(), 0);
        expect_flat("heaps", heaps_, max_growth);
        expect_flat("device memory", device_, max_growth);
        expect_flat("resident", resident_, max_resident_growth);
    }

private:
    static EngineOptions write_options(Script& script, size_t min_rounds)
    {
        EngineOptions options;
        options.width = int(first_width);
        options.height = int(first_height);
        options.cpu_seconds = 1e9; // as long as it was told to
        for (int round = 0; round < max_rounds; round++)
            options.files[file_of_round(round)] = script.write_round(options.display_commands)
                + (size_t(round) + 1 < min_rounds ? "" : "exec soak_end.cfg\n") // a slow machine takes longer
                + (round + 1 < max_rounds ? "exec " + file_of_round(round + 1) + "\n" : "quit\n");
        options.files["soak_end.cfg"] = "// where the time is over, this quits\n";
        options.script = "exec " + file_of_round(0) + "\n";
        options.arguments = { "+exec", "test.cfg" };
        return options;
    }

    // What the last pt_info before each mark has told.
    void read_memory_in_use(const std::string& console)
    {
        std::istringstream lines(console);
        double heaps = 0, device = 0;
        for (std::string line; std::getline(lines, line);)
            if (line.find("heaps (MiB)") != line.npos)
                heaps = read_numbers(line).at(0); // used, free
            else if (line.find("memory (MiB)") != line.npos) {
                const std::vector<double> kinds = read_numbers(line);
                device = std::accumulate(kinds.begin(), kinds.end(), 0.0);
            } else if (line.find("memory mark") != line.npos) {
                heaps_.push_back(heaps * mebibyte);
                device_.push_back(device * mebibyte);
            }
    }

    static std::vector<double> read_numbers(const std::string& line)
    {
        static const std::regex number("[0-9]+\\.[0-9]+");
        std::vector<double> numbers;
        for (std::sregex_iterator found(line.begin(), line.end(), number), end; found != end; ++found)
            numbers.push_back(std::stod(found->str()));
        return numbers;
    }

    static void expect_flat(const char* what, const std::vector<double>& bytes, double allowed)
    {
        const size_t warm_up = std::max(filling_rounds, bytes.size() / 3);
        const auto begin = bytes.begin() + std::ptrdiff_t(warm_up),
                   middle = begin + std::ptrdiff_t((bytes.size() - warm_up) / 2);
        const double before = find_median(std::vector<double>(begin, middle)),
                     after = find_median(std::vector<double>(middle, bytes.end()));
        std::printf("%s: median %.1f MiB, then %.1f\n", what, before / mebibyte, after / mebibyte);
        EXPECT_LT(after, before * (1 + allowed)) << what;
    }

    // At the end of each round: resident bytes, and those in use of which the C library and the module know.
    std::vector<double> resident_, heaps_, device_;
    std::vector<size_t> handles_; // open files
};

} // namespace

// Without the layers, which keep notes of their own on all that they have seen.
TEST(Soak, LongNothingPilesUp)
{
    const Play play(false, filling_rounds + min_judged_rounds);
    play.expect_flat_handles();
    play.expect_flat_memory();
}

TEST(Soak, LongTheLayersStaySilent)
{
    const Play play(true, warm_up_rounds + min_judged_rounds);
    play.expect_flat_handles();
}

} // namespace vkpt::tests

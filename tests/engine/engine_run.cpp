// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/engine/engine_run.hpp"

#include "common/read_text.hpp"
#include "common/temporary_folder.hpp"
#include "tests/runner/process_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

namespace vkpt::tests {

namespace {

constexpr std::chrono::milliseconds poll_interval { 20 };
constexpr int looks_per_measurement = 25; // of CPU time
constexpr int grace = 1500; // looks between asking to end and killing

size_t count_occurrences(const std::string& text, const std::string& part)
{
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
        count++;
    return count;
}

// Resident memory in bytes, 0: no such process.
uint64_t read_resident_memory(int process)
{
    std::ifstream file("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("VmRSS:"))
            return std::stoull(line.substr(6)) * 1024;
    return 0;
}

// While the harness runs a display command, this file has the engine wait. After it, the file says nothing.
std::string name_of_wait(size_t mark) { return fmt::format("display{}.cfg", mark); }
constexpr const char* wait_on = "await\n";

// Whatever the machine's speed, what stands behind a mark runs when its command has.
std::string wait_at_marks(std::string script, std::map<std::string, std::string>& files)
{
    const std::string mark = display_mark;
    for (size_t at = script.find(mark), i = 0; at != std::string::npos; at = script.find(mark, at), i++) {
        files[name_of_wait(i)] = wait_on;
        const std::string waiting
            = fmt::format("echo display mark\nalias await \"wait_5;exec {}\"\nawait\nwait_25\n", name_of_wait(i));
        script.replace(at, mark.size(), waiting);
        at += waiting.size();
    }
    return script;
}

std::string last_lines(const std::string& text, int count)
{
    size_t at = text.size();
    for (int i = 0; i <= count && at != std::string::npos && at > 0; i++)
        at = text.rfind('\n', at - 1);
    return at == std::string::npos ? text : text.substr(at);
}

} // namespace

std::string wait_aliases()
{
    return "alias wait_5 \"wait;wait;wait;wait;wait\"\n"
           "alias wait_25 \"wait_5;wait_5;wait_5;wait_5;wait_5\"\n"
           "alias wait_100 \"wait_25;wait_25;wait_25;wait_25\"\n";
}

std::string press_keys(const std::vector<std::string>& keys)
{
    std::string command = "xdotool search --class quake2 windowfocus --sync";
    for (const std::string& key : keys)
        command += " && sleep 0.2 && xdotool keydown " + key + " && sleep 0.2 && xdotool keyup " + key;
    return command;
}

EngineRun::EngineRun(const EngineOptions& options)
{
    make_folder(options);
    watch(start(options), options);
    outcome.console = read_text(outcome.game_folder / "qconsole.log");
    outcome.output = read_text(folder / "output.txt");
}

EngineRun::~EngineRun()
{
    std::error_code error;
    std::filesystem::remove_all(folder, error);
}

void EngineRun::make_folder(const EngineOptions& options)
{
    folder = make_temporary_folder("vkpt-engine-");
    std::filesystem::permissions(folder, std::filesystem::perms(0755)); // the engine's user has to enter
    std::filesystem::create_directories(folder / "files");
    std::map<std::string, std::string> files = options.files;
    files["test.cfg"] = wait_aliases() + wait_at_marks(options.script, files);
    for (const auto& [path, contents] : files) {
        std::filesystem::create_directories((folder / "files" / path).parent_path());
        std::ofstream(folder / "files" / path, std::ios::binary) << contents;
    }
    outcome.game_folder = folder / "home" / ".yq2" / options.game;
}

int EngineRun::start(const EngineOptions& options)
{
    std::vector<std::string> words { VKPT_SOURCE_DIR "/scripts/run_engine.sh", folder.string(),
        std::to_string(options.width) + "x" + std::to_string(options.height), "+set", "pt_validation",
        options.validation ? "1" : "0", "+set", "pt_seed", "1", "+set", "pt_render_scale",
        std::to_string(options.render_scale) };
    words.insert(words.end(), options.arguments.begin(), options.arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);

    const int process = fork();
    if (process != 0)
        return process;
    setsid(); // its own process group, so that all of it can be ended
    setenv("VKPT_BUILD_DIR", VKPT_TEST_BUILD_DIR, 1);
    setenv("VKPT_CACHE_DIR", VKPT_TEST_BUILD_DIR "/tests/engine/cache", 1);
    setenv("VKPT_GAME", options.game.c_str(), 1);
    for (const std::string& variable : options.environment)
        setenv(variable.substr(0, variable.find('=')).c_str(), variable.substr(variable.find('=') + 1).c_str(), 1);
    const int output = open((folder / "output.txt").c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
}

void EngineRun::watch(int process, const EngineOptions& options)
{
    int status = 0;
    // Only asked to end at first, so that the script ends its display as well. `grace` looks later it has to.
    for (int look = 0, asked_at = -1; waitpid(process, &status, WNOHANG) == 0; look++) {
        std::this_thread::sleep_for(poll_interval);
        follow_console(options);
        if (options.while_running)
            options.while_running(outcome.game_folder);
        if (look % looks_per_measurement == 0)
            outcome.took_too_long |= measure_cpu_seconds(process) > options.cpu_seconds;
        if (!is_over && !outcome.took_too_long)
            continue;
        if (asked_at < 0) {
            asked_at = look;
            kill(-process, SIGTERM);
        } else if (look - asked_at > grace) {
            kill(-process, SIGKILL);
        }
    }
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void EngineRun::follow_console(const EngineOptions& options)
{
    std::ifstream log(outcome.game_folder / "qconsole.log", std::ios::binary);
    log.seekg(console_read);
    const std::string text { std::istreambuf_iterator<char>(log), {} };
    console_read += std::streamoff(text.size());
    for (const char c : text) {
        if (c != '\n')
            console_line += c;
        else
            obey(std::exchange(console_line, {}), options);
    }
}

void EngineRun::obey(const std::string& line, const EngineOptions& options)
{
    is_over |= !options.end_at.empty() && line.find(options.end_at) != std::string::npos;
    if (line.find("memory mark") != std::string::npos)
        note_mark();
    if (line.find("display mark") != std::string::npos && display_marks < options.display_commands.size()) {
        run_on_display(options.display_commands[display_marks]);
        if (const auto wait = outcome.game_folder / name_of_wait(display_marks++); std::filesystem::exists(wait))
            std::ofstream(wait) << "// go on\n";
    }
}

// Those that stay open: a cache that is just being written is not, so the least of some readings counts.
static size_t count_open_files(int process)
{
    size_t least = SIZE_MAX;
    for (int reading = 0; reading < 5; reading++) {
        std::error_code error;
        const std::filesystem::directory_iterator handles("/proc/" + std::to_string(process) + "/fd", error);
        least = std::min(least, size_t(std::distance(begin(handles), end(handles))));
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return least;
}

void EngineRun::note_mark()
{
    int engine = 0;
    std::ifstream(folder / "engine.pid") >> engine;
    outcome.marked_memory.push_back(read_resident_memory(engine));
    outcome.marked_handles.push_back(count_open_files(engine));
}

void EngineRun::run_on_display(const std::string& command)
{
    std::string number = read_text(folder / "home" / "display");
    number.erase(std::remove(number.begin(), number.end(), '\n'), number.end());
    const std::string line = "DISPLAY=:" + number + "; export DISPLAY; " + command;
    EXPECT_EQ(std::system(line.c_str()), 0) << line;
}

std::filesystem::path EngineRun::captures(int start) const
{
    return outcome.game_folder / "vkpt" / "captures"
        / (start == 1 ? std::string(capture_name) : fmt::format("{}-{}", capture_name, start));
}

std::vector<std::string> EngineRun::lines_with(const std::string& text) const
{
    std::vector<std::string> found;
    std::istringstream lines(outcome.console);
    for (std::string line; std::getline(lines, line);)
        if (line.find(text) != std::string::npos)
            found.push_back(line);
    return found;
}

void EngineRun::expect_clean() const
{
    EXPECT_FALSE(outcome.took_too_long) << last_lines(outcome.output, 30);
    EXPECT_EQ(outcome.status, 0) << last_lines(outcome.output, 40);
    // The video menu's choice, vk, is a link to our module.
    EXPECT_EQ(count_occurrences(outcome.console, "Loading library: ref_"),
        count_occurrences(outcome.console, "Successfully loaded ref_vkpt.so")
            + count_occurrences(outcome.console, "Successfully loaded ref_vk.so"))
        << last_lines(outcome.console, 40);
    EXPECT_GE(count_occurrences(outcome.console, "Successfully loaded ref_vkpt.so"), 1u);
    for (const std::string* text : { &outcome.console, &outcome.output })
        for (const char* sign : { "vkpt validation:", "VUID-", "SYNC-HAZARD" })
            EXPECT_EQ(text->find(sign), std::string::npos)
                << text->substr(std::min(text->find(sign), text->size()), 2000);
}

} // namespace vkpt::tests

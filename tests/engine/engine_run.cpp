// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/engine/engine_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace vkpt::tests {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds poll_interval { 20 };
constexpr std::chrono::seconds grace { 5 }; // between asking to end and killing

std::string read_text(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

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
    std::string name = (std::filesystem::temp_directory_path() / "vkpt-engine-XXXXXX").string();
    if (!mkdtemp(name.data()))
        throw std::runtime_error("cannot make a folder " + name);
    folder = name;
    std::filesystem::permissions(folder, std::filesystem::perms(0755)); // the engine's user has to enter
    std::filesystem::create_directories(folder / "files");
    std::ofstream(folder / "files" / "test.cfg") << wait_aliases() << options.script;
    for (const auto& [path, contents] : options.files) {
        std::filesystem::create_directories((folder / "files" / path).parent_path());
        std::ofstream(folder / "files" / path, std::ios::binary) << contents;
    }
    outcome.game_folder = folder / "home" / ".yq2" / "baseq2";
}

int EngineRun::start(const EngineOptions& options)
{
    std::vector<std::string> words { VKPT_SOURCE_DIR "/scripts/run_engine.sh", folder.string(),
        std::to_string(options.width) + "x" + std::to_string(options.height), "+set", "pt_validation",
        options.validation ? "1" : "0", "+set", "pt_seed", "1" };
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
    const auto started = Clock::now();
    int status = 0;
    while (waitpid(process, &status, WNOHANG) == 0) {
        note_marks(options);
        if (Clock::now() - started > options.limit && !outcome.timed_out) {
            outcome.timed_out = true;
            kill(-process, SIGTERM);
        }
        if (Clock::now() - started > options.limit + grace)
            kill(-process, SIGKILL);
        std::this_thread::sleep_for(poll_interval);
    }
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void EngineRun::note_marks(const EngineOptions& options)
{
    const std::string console = read_text(outcome.game_folder / "qconsole.log");
    const size_t marks = count_occurrences(console, "memory mark");
    if (marks != outcome.marked_memory.size()) {
        int engine = 0;
        std::ifstream(folder / "engine.pid") >> engine;
        outcome.marked_memory.resize(marks, read_resident_memory(engine));
    }
    const size_t commands = std::min(count_occurrences(console, "display mark"), options.display_commands.size());
    while (display_marks < commands)
        run_on_display(options.display_commands[display_marks++]);
}

void EngineRun::run_on_display(const std::string& command)
{
    std::string number = read_text(folder / "home" / "display");
    number.erase(std::remove(number.begin(), number.end(), '\n'), number.end());
    const std::string line = "DISPLAY=:" + number + "; export DISPLAY; " + command;
    EXPECT_EQ(std::system(line.c_str()), 0) << line;
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
    EXPECT_FALSE(outcome.timed_out) << last_lines(outcome.output, 30);
    EXPECT_EQ(outcome.status, 0) << last_lines(outcome.output, 40);
    EXPECT_EQ(count_occurrences(outcome.console, "Loading library: ref_"),
        count_occurrences(outcome.console, "Successfully loaded ref_vkpt.so"))
        << last_lines(outcome.console, 40);
    EXPECT_GE(count_occurrences(outcome.console, "Successfully loaded ref_vkpt.so"), 1u);
    for (const std::string* text : { &outcome.console, &outcome.output })
        for (const char* sign : { "vkpt validation:", "VUID-", "SYNC-HAZARD" })
            EXPECT_EQ(text->find(sign), std::string::npos)
                << text->substr(std::min(text->find(sign), text->size()), 2000);
}

} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// Runs one of ctest's entries: ends it where it takes more CPU time than it may, leaves no process behind, and notes
// what it took and how many cases it had.
//
//   run_test NAME CPU-SECONDS RESULTS COMMAND...
//
// VKPT_CACHE_DIR, where it is not set, becomes the one folder of all tests: test_cache/shared beside RESULTS.
// RESULTS/NAME.result gets a line "CPU-SECONDS PASSED FAILED SKIPPED NAME" and one line for each skipped case: its name
// and its reason. A command that is no GoogleTest program counts as one case. Exit status: the command's; 124 over
// time.
#include "tests/runner/process_tree.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace vkpt::tests {
namespace {

constexpr int over_time = 124;
constexpr timespec check_interval { 0, 250000000 }; // between two looks at the CPU time

struct Counts {
    int passed = 0, failed = 0;
    std::vector<std::string> skipped;
};

double seconds_of(const timeval& time) { return double(time.tv_sec) + double(time.tv_usec) * 1e-6; }

constexpr int skip_status = 77; // of commands that lack what they need, as with automake

// The report that GoogleTest writes: one <testcase> for each, with a <failure> or a <skipped> within.
Counts count_cases(const std::filesystem::path& report, int status)
{
    std::ifstream file(report);
    const std::string text { std::istreambuf_iterator<char>(file), {} };
    Counts counts;
    if (text.empty()) { // no GoogleTest, or one that did not come to its end
        if (status == skip_status)
            counts.skipped.push_back(report.stem().string() + ": its output tells what is missing");
        else
            (status == 0 ? counts.passed : counts.failed)++;
        return counts;
    }
    static const std::regex attribute(R"re( (name|classname|result)="([^"]*)")re");
    static const std::regex reason(R"re(<skipped message="([^"]*)")re");
    for (size_t at = text.find("<testcase "); at != std::string::npos;) {
        const size_t next = text.find("<testcase ", at + 1);
        const std::string entry = text.substr(at, next == std::string::npos ? next : next - at);
        at = next;
        const std::string head = entry.substr(0, entry.find('>'));
        std::string name, suite, result;
        for (std::sregex_iterator i(head.begin(), head.end(), attribute), end; i != end; ++i)
            ((*i)[1] == "name" ? name : (*i)[1] == "classname" ? suite : result) = (*i)[2];
        if (entry.find("<failure") != std::string::npos) {
            counts.failed++;
        } else if (result == "skipped") {
            std::smatch message;
            std::string why = std::regex_search(entry, message, reason) ? message[1].str() : "";
            why = why.substr(why.rfind("&#x0A;") == std::string::npos ? 0 : why.rfind("&#x0A;") + 6);
            counts.skipped.push_back(suite + "." + name + ": " + why);
        } else if (result == "completed") {
            counts.passed++;
        }
    }
    if (status != 0 && counts.failed == 0)
        counts.failed = 1; // what failed is outside of the cases
    return counts;
}

void write_result(const std::filesystem::path& stem, const std::string& name, int status)
{
    rusage used {};
    getrusage(RUSAGE_CHILDREN, &used);
    const Counts counts = count_cases(stem.string() + ".xml", status);
    std::ofstream file(stem.string() + ".result");
    file << seconds_of(used.ru_utime) + seconds_of(used.ru_stime) << ' ' << counts.passed << ' ' << counts.failed << ' '
         << counts.skipped.size() << ' ' << name << '\n';
    for (const std::string& line : counts.skipped)
        file << "skipped " << line << '\n';
}

pid_t start(char** command, const std::filesystem::path& report)
{
    const pid_t process = fork();
    if (process != 0)
        return process;
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    setenv("GTEST_OUTPUT", ("xml:" + report.string()).c_str(), 1);
    // All tests share what the driver has compiled: the first time takes two to three times as long. Tests of caches
    // name their own.
    const std::filesystem::path build = std::filesystem::absolute(report).parent_path().parent_path();
    setenv("VKPT_CACHE_DIR", (build / "test_cache/shared").c_str(), 0);
    execvp(command[0], command);
    std::fprintf(stderr, "run_test: cannot run %s\n", command[0]);
    _exit(127);
}

void end_all()
{
    while (signal_descendants(getpid(), SIGKILL) > 0)
        while (waitpid(-1, nullptr, 0) > 0) { }
}

// What is left when ctest ends this program, or the user does.
void end_with_all(int signal)
{
    end_all();
    _exit(128 + signal);
}

// Waits for the process; over_time where it was ended.
int watch(pid_t process, double limit)
{
    int status = 0;
    sigset_t child_ends;
    sigemptyset(&child_ends);
    sigaddset(&child_ends, SIGCHLD);
    for (;;) {
        // Ended children of others that became ours are taken as well.
        for (pid_t ended = 0; (ended = waitpid(-1, &status, WNOHANG)) > 0;)
            if (ended == process)
                return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        sigtimedwait(&child_ends, nullptr, &check_interval);
        if (const double seconds = measure_cpu_seconds(getpid()); seconds > limit) {
            std::printf("run_test: ended after %.0f s of CPU time, more than its %.0f s\n", seconds, limit);
            return over_time;
        }
    }
}

} // namespace
} // namespace vkpt::tests

int main(int count, char** words)
{
    using namespace vkpt::tests;
    if (count < 5) {
        std::fprintf(stderr, "usage: run_test NAME CPU-SECONDS RESULTS COMMAND...\n");
        return 2;
    }
    const std::string name = words[1];
    std::string file_name = name;
    for (char& c : file_name)
        if (c == '/')
            c = '_';
    const std::filesystem::path folder = words[3], stem = folder / file_name;
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    std::filesystem::remove(stem.string() + ".xml", ignored);
    prctl(PR_SET_CHILD_SUBREAPER, 1); // so that nobody leaves the tree
    signal(SIGTERM, end_with_all);
    signal(SIGINT, end_with_all);
    sigset_t child_ends;
    sigemptyset(&child_ends);
    sigaddset(&child_ends, SIGCHLD);
    sigprocmask(SIG_BLOCK, &child_ends, nullptr); // waited for
    const pid_t process = start(words + 4, stem.string() + ".xml");
    const int status = watch(process, std::atof(words[2]));
    end_all();
    write_result(stem, name, status);
    return status;
}

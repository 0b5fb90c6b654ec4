// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/formats/file_budget.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vkpt::tests {

namespace {

// Far over the budget, so that what exceeds it is measured, and near enough to protect the machine.
constexpr size_t hard_bytes = 4 * budget_bytes;
constexpr rlim_t hard_cpu_seconds = 30;

constexpr int expectation_failed = 3; // the child's exit status

#if defined(__SANITIZE_ADDRESS__)
constexpr bool has_sanitizer = true;
#elif defined(__has_feature)
constexpr bool has_sanitizer = __has_feature(address_sanitizer);
#else
constexpr bool has_sanitizer = false;
#endif

// "VmRSS" and its like, in bytes.
size_t own_memory(const char* name)
{
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(name))
            return std::stoull(line.substr(line.find(':') + 1)) * 1024;
    return 0;
}

void limit_resources()
{
    if (!has_sanitizer) { // whose shadow memory takes terabytes of addresses
        const rlim_t bytes = own_memory("VmSize") + hard_bytes;
        const rlimit memory { bytes, bytes };
        setrlimit(RLIMIT_AS, &memory);
    }
    const rlimit cpu { hard_cpu_seconds, hard_cpu_seconds };
    setrlimit(RLIMIT_CPU, &cpu);
    const rlimit core { 0, 0 };
    setrlimit(RLIMIT_CORE, &core);
}

double own_cpu_seconds()
{
    rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) { return double(time.tv_sec) + double(time.tv_usec) * 1e-6; };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// In the child: "peak seconds outcome" into the pipe.
void report_cost(const std::function<void()>& use, int pipe)
{
    limit_resources();
    std::ofstream("/proc/self/clear_refs") << "5"; // the peak starts anew
    const size_t before = own_memory("VmRSS");
    std::string outcome = "read";
    try {
        use();
    } catch (const std::exception& error) {
        outcome = std::string("refused: ") + error.what();
    }
    const size_t peak = std::max(own_memory("VmHWM"), before);
    std::string text = std::to_string(peak - before) + " " + std::to_string(own_cpu_seconds()) + " ";
    text += outcome.substr(0, 1000);
    if (write(pipe, text.data(), text.size()) != ssize_t(text.size()))
        _exit(2);
}

} // namespace

Cost measure_cost(const std::function<void()>& use)
{
    int ends[2];
    if (pipe(ends) != 0)
        return { false, "no pipe", 0, 0 };
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        const bool had_failed = testing::Test::HasFailure();
        report_cost(use, ends[1]);
        std::fflush(nullptr);
        _exit(!had_failed && testing::Test::HasFailure() ? expectation_failed : 0);
    }
    close(ends[1]);
    std::string text;
    char buffer[512];
    for (ssize_t got = 0; (got = read(ends[0], buffer, sizeof(buffer))) > 0;)
        text.append(buffer, size_t(got));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    Cost cost;
    cost.ended = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (!cost.ended) {
        cost.outcome = WIFSIGNALED(status)              ? std::string("killed: ") + strsignal(WTERMSIG(status))
            : WEXITSTATUS(status) == expectation_failed ? "an expectation failed, see above"
                                                        : "did not end well";
        return cost;
    }
    size_t at = 0, used = 0;
    cost.peak_bytes = std::stoull(text, &at);
    cost.cpu_seconds = std::stod(text.substr(at), &used);
    cost.outcome = text.substr(at + used + 1);
    return cost;
}

Cost expect_within_budget(const std::string& what, const std::function<void()>& use)
{
    const Cost cost = measure_cost(use);
    EXPECT_TRUE(cost.ended) << what << ": " << cost.outcome;
    EXPECT_EQ(cost.outcome.find("bad_alloc"), std::string::npos) << what << ": " << cost.outcome;
    if (has_sanitizer) // slower, and keeps freed memory for a while
        return cost;
    EXPECT_LE(cost.peak_bytes, budget_bytes) << what << ": " << cost.outcome;
    EXPECT_LE(cost.cpu_seconds, budget_cpu_seconds) << what << ": " << cost.outcome;
    return cost;
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, const std::string& ending)
{
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ending)
            files.push_back(entry.path());
    std::ranges::sort(files);
    EXPECT_FALSE(files.empty()) << "no " << ending << " in " << folder;
    return files;
}

std::vector<std::byte> file_bytes(const std::filesystem::path& path)
{
    std::ifstream stream(path, std::ios::binary);
    EXPECT_TRUE(stream) << path;
    const std::string text { std::istreambuf_iterator<char>(stream), {} };
    std::vector<std::byte> bytes(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
}

} // namespace vkpt::tests

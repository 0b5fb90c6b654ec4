// SPDX-License-Identifier: GPL-2.0-or-later
// A harness without libFuzzer: runs the inputs that it is given, files or folders of files, and fails where one takes
// more memory or CPU time than any may. What a sanitizer finds ends the program; the input's name is told then, too.
#include "fuzz/support/harness.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <sys/time.h>
#include <unistd.h>
#include <vector>

#if defined(__SANITIZE_ADDRESS__)
#define VKPT_COUNTS_MEMORY
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define VKPT_COUNTS_MEMORY
#endif
#endif
#ifdef VKPT_COUNTS_MEMORY
#include <sanitizer/common_interface_defs.h>
// Of <sanitizer/allocator_interface.h>, which GCC's packages leave out.
extern "C" size_t __sanitizer_get_allocated_size(const volatile void* memory);
extern "C" int __sanitizer_install_malloc_and_free_hooks(
    void (*allocated)(const volatile void*, size_t), void (*freed)(const volatile void*));
#endif

namespace {

namespace fs = std::filesystem;

constexpr size_t max_memory = size_t(512) << 20; // bytes held at once, above what was held before the input
#ifdef VKPT_COUNTS_MEMORY
constexpr double max_seconds = 25; // of CPU: sanitizers take up to five times as long
#else
constexpr double max_seconds = 5; // of CPU
#endif
constexpr long seconds_until_end = 60; // of CPU: it will not come to an end by itself

const char* current_input = "(none)";

void tell_input()
{
    // Nothing but what a signal handler may do.
    for (const char* text : { "while reading ", current_input, "\n" })
        if (write(STDERR_FILENO, text, std::string_view(text).size()) < 0)
            return;
}

#ifdef VKPT_COUNTS_MEMORY
std::atomic<size_t> held { 0 }, held_before { 0 };

void count_allocation(const volatile void*, size_t size)
{
    held += size;
    if (held > held_before + max_memory) {
        tell_input();
        __sanitizer_print_stack_trace();
        std::fprintf(stderr, "more than %zu bytes at once\n", max_memory);
        _exit(1);
    }
}

void count_release(const volatile void* memory)
{
    if (memory)
        held -= __sanitizer_get_allocated_size(memory);
}

void watch_memory()
{
    __sanitizer_set_death_callback(tell_input);
    __sanitizer_install_malloc_and_free_hooks(count_allocation, count_release);
}
void start_counting() { held_before = held.load(); }
#else
// Without the address sanitizer: the largest resident set, which the system counts from the last reset.
void watch_memory() { }

size_t read_peak()
{
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:"))
            return size_t(std::strtoull(line.c_str() + 6, nullptr, 10)) << 10;
    return 0;
}

size_t held_before = 0;
void start_counting()
{
    std::ofstream("/proc/self/clear_refs") << "5";
    held_before = read_peak();
}
#endif

size_t memory_is_over()
{
#ifdef VKPT_COUNTS_MEMORY
    return 0; // count_allocation has ended the program
#else
    const size_t peak = read_peak();
    return peak > held_before + max_memory ? peak - held_before : 0;
#endif
}

double cpu_seconds()
{
    timespec now {};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + double(now.tv_nsec) * 1e-9;
}

void set_alarm(long seconds)
{
    itimerval timer {};
    timer.it_value.tv_sec = seconds;
    setitimer(ITIMER_PROF, &timer, nullptr);
}

void watch_time()
{
    std::signal(SIGPROF, [](int) {
        tell_input();
        const std::string_view text = "it does not come to an end\n";
        if (write(STDERR_FILENO, text.data(), text.size()) >= 0)
            _exit(1);
        _exit(2);
    });
#ifndef VKPT_COUNTS_MEMORY
    for (const int signal : { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT })
        std::signal(signal, [](int number) {
            tell_input();
            std::signal(number, SIG_DFL);
            raise(number);
        });
#endif
}

std::vector<fs::path> find_inputs(int count, char** arguments)
{
    std::vector<fs::path> inputs;
    for (int i = 1; i < count; i++) {
        if (!fs::is_directory(arguments[i])) {
            inputs.emplace_back(arguments[i]);
            continue;
        }
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(arguments[i]))
            if (entry.is_regular_file())
                inputs.push_back(entry.path());
    }
    std::ranges::sort(inputs);
    return inputs;
}

// False: over one of the limits.
bool run(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        std::fprintf(stderr, "%s: cannot be read\n", path.c_str());
        return false;
    }
    const std::vector<char> bytes { std::istreambuf_iterator<char>(file), {} };
    // Without room behind its end: the address sanitizer sees every byte that is read too far.
    std::vector<uint8_t> input(bytes.begin(), bytes.end());
    input.shrink_to_fit();
    current_input = path.c_str();
    start_counting();
    const double start = cpu_seconds();
    set_alarm(seconds_until_end);
    LLVMFuzzerTestOneInput(input.data(), input.size());
    set_alarm(0);
    const double seconds = cpu_seconds() - start;
    if (seconds > max_seconds)
        std::fprintf(stderr, "%s: %.1f s of CPU time, more than %.0f\n", path.c_str(), seconds, max_seconds);
    const size_t memory = memory_is_over();
    if (memory > 0)
        std::fprintf(stderr, "%s: %zu bytes of memory, more than %zu\n", path.c_str(), memory, max_memory);
    return seconds <= max_seconds && memory == 0;
}

} // namespace

int main(int count, char** arguments)
{
    const std::vector<fs::path> inputs = find_inputs(count, arguments);
    if (inputs.empty()) {
        std::fprintf(stderr, "usage: %s FILE-OR-FOLDER...\nNo input was found, so nothing was tested.\n", arguments[0]);
        return 2;
    }
    watch_memory();
    watch_time();
    size_t failed = 0;
    for (const fs::path& input : inputs)
        failed += !run(input);
    std::printf("%zu inputs, %zu over a limit\n", inputs.size(), failed);
    return failed == 0 ? 0 : 1;
}

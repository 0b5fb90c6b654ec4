// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/client/run_program.hpp"

#include "formats/bsp.hpp"
#include "tests/formats/samples.hpp"

#include <algorithm>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vkpt::tests {

namespace fs = std::filesystem;

void ScratchFolder::write(const std::string& name, const std::string& text) const
{
    fs::create_directories((path() / name).parent_path());
    std::ofstream(path() / name, std::ios::binary) << text;
}

std::string ScratchFolder::read(const std::string& name) const
{
    std::ifstream stream(path() / name, std::ios::binary);
    return { std::istreambuf_iterator<char>(stream), {} };
}

std::vector<std::string> ScratchFolder::names() const
{
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(path()))
        names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

namespace {

// Only what may be called between fork and exec.
[[noreturn]] void become(const char* folder, int output, int errors, char* const* arguments, char* const* environment)
{
    const int input = open("/dev/null", O_RDONLY);
    if (chdir(folder) == 0 && dup2(input, 0) >= 0 && dup2(output, 1) >= 0 && dup2(errors, 2) >= 0)
        execve(arguments[0], arguments, environment);
    _exit(127);
}

std::vector<char*> make_pointers(std::vector<std::string>& texts)
{
    std::vector<char*> pointers;
    for (std::string& text : texts)
        pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
}

} // namespace

ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments, const fs::path& folder,
    const std::vector<std::string>& environment)
{
    const ScratchFolder log;
    std::vector<std::string> words { program };
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<std::string> variables(environment);
    for (char** variable = environ; *variable; variable++)
        variables.emplace_back(*variable);
    const std::vector<char*> word_pointers = make_pointers(words), variable_pointers = make_pointers(variables);
    const int output = open((log.path() / "output").c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
    const int errors = open((log.path() / "errors").c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
    const pid_t child = fork();
    if (child == 0)
        become(folder.c_str(), output, errors, word_pointers.data(), variable_pointers.data());
    close(output);
    close(errors);
    int status = 0;
    rusage usage {};
    wait4(child, &status, 0, &usage);
    const auto seconds = [](const timeval& time) { return double(time.tv_sec) + double(time.tv_usec) / 1e6; };
    return { WIFEXITED(status) ? WEXITSTATUS(status) : -1, log.read("output"), log.read("errors"),
        seconds(usage.ru_utime) + seconds(usage.ru_stime), double(usage.ru_maxrss) / 1024 };
}

void write_sample_map(const ScratchFolder& folder, const std::string& name, const std::string& entity_text)
{
    formats::Bsp bsp = samples::make_bsp();
    bsp.entity_text = entity_text;
    const std::vector<std::byte> bytes = formats::write_bsp(bsp);
    folder.write("baseq2/maps/" + name + ".bsp", { reinterpret_cast<const char*>(bytes.data()), bytes.size() });
}

} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/runner/process_tree.hpp"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace vkpt::tests {

namespace {

struct Process {
    pid_t id = 0, parent = 0;
    double seconds = 0; // its own, and those of the children that it waited for
};

// A line of /proc/ID/stat, see proc(5): the name in parentheses may itself hold any character.
bool read_process(const std::filesystem::path& folder, Process& process)
{
    std::ifstream file(folder / "stat");
    std::string line;
    std::getline(file, line, '\0'); // iterators would throw where the process has ended since
    const size_t name_end = line.rfind(')');
    if (name_end == std::string::npos)
        return false;
    std::istringstream fields(line.substr(name_end + 1));
    std::string skipped;
    long ticks = 0;
    constexpr int first_time = 14, last_time = 17; // utime, stime, cutime, cstime
    fields >> skipped >> process.parent;
    for (int field = 5; field < first_time; field++)
        fields >> skipped;
    for (int field = first_time; field <= last_time; field++) {
        long time = 0;
        fields >> time;
        ticks += time;
    }
    process.seconds = double(ticks) / double(sysconf(_SC_CLK_TCK));
    return bool(fields);
}

std::vector<Process> list_processes()
{
    std::vector<Process> processes;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
        Process process;
        process.id = std::atoi(entry.path().filename().c_str());
        if (process.id > 0 && read_process(entry.path(), process))
            processes.push_back(process);
    }
    return processes;
}

// `root` first, where it is there.
std::vector<Process> list_tree(pid_t root)
{
    const std::vector<Process> all = list_processes();
    std::vector<Process> tree;
    for (const Process& process : all)
        if (process.id == root)
            tree.push_back(process);
    for (size_t i = 0; i < tree.size(); i++)
        for (const Process& process : all)
            if (process.parent == tree[i].id)
                tree.push_back(process);
    return tree;
}

int send_signal(const std::vector<Process>& processes, size_t first, int signal)
{
    int reached = 0;
    for (size_t i = first; i < processes.size(); i++)
        reached += kill(processes[i].id, signal) == 0;
    return reached;
}

} // namespace

double measure_cpu_seconds(pid_t root)
{
    double seconds = 0;
    for (const Process& process : list_tree(root))
        seconds += process.seconds;
    return seconds;
}

int signal_tree(pid_t root, int signal) { return send_signal(list_tree(root), 0, signal); }

int signal_descendants(pid_t root, int signal) { return send_signal(list_tree(root), 1, signal); }

} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/temporary_folder.hpp"

#include "client/host/errors.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace vkpt::client {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& name)
{
    throw Failure(
        fmt::format("cannot make a folder {}: {}; set $TMPDIR to use another place", name, std::strerror(errno)));
}

// A process of its own removes the folder when the pipe's other end is closed: by the owner, or by the kernel once the
// owner is dead. Nothing else of the owner's stays open, and no signal that is meant for the owner ends it.
[[noreturn]] void clean_up(const fs::path& folder, int end)
{
    for (const int signal : { SIGHUP, SIGINT, SIGTERM })
        std::signal(signal, SIG_IGN);
    setsid();
    dup2(end, 3);
    const int nothing = open("/dev/null", O_RDWR);
    for (int standard = 0; standard < 3; standard++)
        dup2(nothing, standard);
    close_range(4, ~0u, 0);
    char byte = 0;
    while (read(3, &byte, 1) < 0 && errno == EINTR) { }
    // What the owner has started dies with it, but may still be writing.
    constexpr int attempts = 100;
    std::error_code error;
    for (int i = 0; i < attempts && (fs::remove_all(folder, error), fs::exists(folder, error)); i++)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    _exit(0);
}

} // namespace

TemporaryFolder::TemporaryFolder(const std::string& prefix)
{
    std::string name = (fs::temp_directory_path() / (prefix + "XXXXXX")).string();
    if (!mkdtemp(name.data()))
        fail(name);
    path_ = name;
    int ends[2];
    const bool has_pipe = pipe2(ends, O_CLOEXEC) == 0;
    cleaner_ = has_pipe ? fork() : -1;
    if (cleaner_ == 0) {
        close(ends[1]);
        clean_up(path_, ends[0]);
    }
    if (cleaner_ < 0) {
        rmdir(name.c_str());
        fail(name);
    }
    close(ends[0]);
    end_ = ends[1];
}

TemporaryFolder::~TemporaryFolder()
{
    close(end_);
    while (waitpid(cleaner_, nullptr, 0) < 0 && errno == EINTR) { }
}

} // namespace vkpt::client

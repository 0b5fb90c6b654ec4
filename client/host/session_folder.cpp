// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/session_folder.hpp"

#include "client/host/errors.hpp"
#include "common/temporary_folder.hpp"

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

[[noreturn]] void fail(const fs::path& folder, const char* reason)
{
    throw Failure(
        fmt::format("cannot make a folder {}: {}; set $TMPDIR to use another place", folder.string(), reason));
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

SessionFolder::SessionFolder(const std::string& prefix)
{
    try {
        path_ = make_temporary_folder(prefix);
    } catch (const fs::filesystem_error& error) {
        fail(error.path1(), error.code().message().c_str());
    }
    int ends[2];
    const bool has_pipe = pipe2(ends, O_CLOEXEC) == 0;
    cleaner_ = has_pipe ? fork() : -1;
    if (cleaner_ == 0) {
        close(ends[1]);
        clean_up(path_, ends[0]);
    }
    if (cleaner_ < 0) {
        const int error = errno;
        rmdir(path_.c_str());
        fail(path_, std::strerror(error));
    }
    close(ends[0]);
    end_ = ends[1];
}

SessionFolder::~SessionFolder()
{
    close(end_);
    while (waitpid(cleaner_, nullptr, 0) < 0 && errno == EINTR) { }
}

} // namespace vkpt::client

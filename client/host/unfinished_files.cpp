// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/unfinished_files.hpp"

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <unistd.h>

namespace vkpt::client {

namespace {

// The handler may run between any two instructions and may neither allocate nor lock: a fixed table of C strings. More
// files than it has places are not removed by a signal.
constexpr size_t capacity = 64;
std::array<std::atomic<char*>, capacity> paths;
static_assert(std::atomic<char*>::is_always_lock_free);

// SA_RESETHAND has put the default back, so that the program ends as if nobody had listened.
void remove_and_end(int signal)
{
    for (size_t i = capacity; i-- > 0;)
        if (const char* path = paths[i].load()) {
            unlink(path);
            rmdir(path);
        }
    raise(signal);
}

// Only where nobody has other plans: nohup ignores the hang-up, SDL turns signals into events.
void listen()
{
    for (const int signal : { SIGHUP, SIGINT, SIGTERM }) {
        struct sigaction now { };
        if (sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL)
            continue;
        struct sigaction action { };
        action.sa_handler = remove_and_end;
        action.sa_flags = int(SA_RESETHAND | SA_NODEFER);
        sigaction(signal, &action, nullptr);
    }
}

} // namespace

UnfinishedFile::UnfinishedFile(const std::filesystem::path& path)
    : place_(0)
{
    listen();
    char* const text = strdup(path.c_str());
    for (char* empty = nullptr; place_ < capacity; place_++, empty = nullptr)
        if (paths[place_].compare_exchange_strong(empty, text))
            return;
    std::free(text);
}

UnfinishedFile::~UnfinishedFile()
{
    if (place_ < capacity)
        std::free(paths[place_].exchange(nullptr));
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/report/apart.hpp"

#include "client/host/errors.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <poll.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace vkpt::client {

namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

Json make_error(const std::string& text) { return { { "error", text } }; }

// One end of a pipe.
class End {
public:
    explicit End(int file)
        : file_(file)
    {
    }
    ~End() { close(); }
    End(const End&) = delete;
    End& operator=(const End&) = delete;

    void close()
    {
        if (file_ >= 0)
            ::close(file_);
        file_ = -1;
    }
    int file() const { return file_; }

private:
    int file_;
};

[[noreturn]] void work_and_exit(const std::function<Json()>& work, int file)
{
    Json result;
    try {
        result = work();
    } catch (const std::exception& error) {
        result = make_error(error.what());
    }
    const std::string text = result.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (size_t at = 0; at < text.size();) {
        const ssize_t count = write(file, text.data() + at, text.size() - at);
        if (count < 0 && errno != EINTR)
            break;
        at += size_t(std::max<ssize_t>(count, 0));
    }
    std::fflush(nullptr);
    _exit(0);
}

// All that comes until the other end is closed; false: that took too long.
bool read_all(int file, Clock::time_point end, std::string& text)
{
    char part[4096];
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        pollfd wanted { file, POLLIN, 0 };
        const int ready = left > 0 ? poll(&wanted, 1, int(left)) : 0;
        if (ready < 0 && errno == EINTR)
            continue;
        if (ready <= 0)
            return false;
        const ssize_t count = read(file, part, sizeof part);
        if (count == 0)
            return true;
        text.append(part, size_t(std::max<ssize_t>(count, 0)));
    }
}

} // namespace

Json run_apart(const std::function<Json()>& work, std::chrono::seconds limit)
{
    int files[2];
    if (pipe(files) != 0)
        throw Failure(fmt::format("no pipe to a process: {}", std::strerror(errno)));
    End from(files[0]), into(files[1]);
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0)
        throw Failure(fmt::format("no process can be started: {}", std::strerror(errno)));
    if (child == 0) {
        from.close();
        work_and_exit(work, into.file());
    }
    into.close();
    std::string text;
    const bool is_in_time = read_all(from.file(), Clock::now() + limit, text);
    if (!is_in_time)
        kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) { }
    if (!is_in_time)
        return make_error(fmt::format("it had not ended after {} seconds", limit.count()));
    if (WIFSIGNALED(status))
        return make_error(fmt::format("it crashed: {}", strsignal(WTERMSIG(status))));
    Json result = Json::parse(text, nullptr, false);
    return result.is_discarded() ? make_error("it ended without a result") : result;
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/film/encoder.hpp"

#include "client/host/errors.hpp"
#include "common/read_text.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

extern char** environ;

namespace vkpt::client {

namespace {

constexpr const char* program = "ffmpeg";

// Starts ffmpeg with `input` as its standard input, and its output in the file. 0, or the number of the error.
int start(std::vector<std::string> words, int input, const std::filesystem::path& output, pid_t& process)
{
    words.insert(words.begin(), program);
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (input >= 0)
        posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    else
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    const int error = posix_spawnp(&process, program, &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

[[noreturn]] void fail_to_start(int error)
{
    if (error == ENOENT)
        throw Failure("the film is written by the program ffmpeg, which is not installed: apt install ffmpeg, or name "
                      "a folder of pictures with -o FOLDER/");
    throw Failure(fmt::format("ffmpeg does not start: {}", std::strerror(error)));
}

// H.264 where ffmpeg can write it.
std::vector<std::string> codec_options(const std::filesystem::path& folder)
{
    const std::filesystem::path list = folder / "encoders.txt";
    pid_t process = -1;
    if (const int error = start({ "-hide_banner", "-encoders" }, -1, list, process))
        fail_to_start(error);
    waitpid(process, nullptr, 0);
    if (read_text(list).find("libx264") != std::string::npos)
        return { "-c:v", "libx264", "-crf", "18" };
    return { "-c:v", "mpeg4", "-q:v", "2" };
}

// The second input, and what is made of it.
std::vector<std::string> sound_options(const Encoder::Sound& sound)
{
    if (sound.file.empty())
        return {};
    return { "-ss", fmt::format("{:.6f}", sound.from), "-i", sound.file.string(), "-map", "0:v:0", "-map", "1:a:0",
        "-af", "apad", "-t", fmt::format("{:.6f}", sound.seconds), "-c:a", "aac", "-b:a", "192k" };
}

} // namespace

void check_ffmpeg()
{
    pid_t process = -1;
    if (const int error = start({ "-version" }, -1, "/dev/null", process))
        fail_to_start(error);
    waitpid(process, nullptr, 0);
}

Encoder::Encoder(const std::filesystem::path& film, const std::filesystem::path& folder, int width, int height,
    double rate, const Sound& sound)
    : messages_(folder / "ffmpeg.txt")
{
    std::vector<std::string> words { "-hide_banner", "-loglevel", "error", "-nostdin", "-y", "-f", "rawvideo",
        "-pixel_format", "rgba", "-video_size", fmt::format("{}x{}", width, height), "-framerate",
        fmt::format("{}", rate), "-i", "pipe:0" };
    const std::vector<std::string> codec = codec_options(folder), sound_words = sound_options(sound);
    words.insert(words.end(), sound_words.begin(), sound_words.end());
    words.insert(words.end(), codec.begin(), codec.end());
    words.insert(words.end(), { "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4", film.string() });
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        throw Failure(fmt::format("cannot make a pipe to ffmpeg: {}", std::strerror(errno)));
    const int error = start(words, ends[0], messages_, process_);
    close(ends[0]);
    pipe_ = ends[1];
    if (error) {
        close(std::exchange(pipe_, -1));
        fail_to_start(error);
    }
    old_handler_ = std::signal(SIGPIPE, SIG_IGN); // an ffmpeg that has ended is told by write()
}

Encoder::~Encoder()
{
    if (process_ > 0) {
        kill(process_, SIGTERM);
        wait();
    }
    std::signal(SIGPIPE, old_handler_);
}

int Encoder::wait()
{
    if (pipe_ >= 0)
        close(std::exchange(pipe_, -1));
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) { }
    process_ = -1;
    return status;
}

void Encoder::fail()
{
    if (process_ > 0)
        wait();
    throw Failure(fmt::format("ffmpeg made no film; it said\n{}", read_text(messages_)));
}

void Encoder::add(const formats::Image& picture)
{
    const auto bytes = std::as_bytes(std::span(picture.pixels));
    for (size_t at = 0; at < bytes.size();) {
        const ssize_t written = ::write(pipe_, bytes.data() + at, bytes.size() - at);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            fail();
        at += size_t(written);
    }
}

void Encoder::finish()
{
    const int status = wait();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        fail();
}

} // namespace vkpt::client

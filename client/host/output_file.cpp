// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/output_file.hpp"

#include "client/host/errors.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <random>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace vkpt::client {

namespace fs = std::filesystem;

namespace {

constexpr int max_links = 40; // as the kernel

// Links in /proc (/dev/stdout leads there) are open files and no names.
bool is_in_proc(const fs::path& path) { return path.string().starts_with("/proc/"); }

// In a folder like /tmp, where everybody may make links and only their owners remove them, those of others are no way
// to anywhere; Linux's fs.protected_symlinks is the same rule.
bool is_planted(const fs::path& link)
{
    struct stat found {
    }, around {};
    const fs::path parent = link.parent_path();
    if (lstat(link.c_str(), &found) != 0 || stat(parent.empty() ? "." : parent.c_str(), &around) != 0)
        return true;
    const bool is_shared = (around.st_mode & S_ISVTX) && (around.st_mode & S_IWOTH);
    return is_shared && found.st_uid != geteuid() && found.st_uid != around.st_uid;
}

fs::path random_neighbour(const fs::path& path)
{
    std::random_device random;
    return path.parent_path() / fmt::format(".vkpt-{:08x}{:08x}.part", random(), random());
}

// The new file gets the old one's owner and permissions. Its group's are for its group alone.
bool copy_access(int file, const struct stat& from)
{
    mode_t mode = from.st_mode & 0777;
    struct stat now { };
    if (fchown(file, from.st_uid, from.st_gid) != 0 && (fstat(file, &now) != 0 || now.st_gid != from.st_gid))
        mode &= mode_t(~0070);
    return fchmod(file, mode) == 0;
}

} // namespace

OutputFile::OutputFile(const fs::path& path)
    : path_(path)
    , target_(follow_links())
{
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    if (fs::is_directory(status))
        throw Failure(fmt::format("cannot write {}: it is a folder; name a file", path.string()));
    try {
        if (is_in_proc(target_) || (fs::exists(status) && !fs::is_regular_file(status)))
            open_directly();
        else
            open_neighbour();
    } catch (...) {
        discard();
        throw;
    }
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::discard()
{
    if (file_ >= 0)
        close(file_);
    if (unfinished_)
        unlink(working_path_.c_str());
}

// Where writing to the path would write; also for a link to what is not there yet.
fs::path OutputFile::follow_links() const
{
    fs::path path = path_;
    std::error_code ignored;
    for (int links = 0; fs::is_symlink(path, ignored) && !is_in_proc(path); links++) {
        if (links == max_links)
            fail(ELOOP);
        if (is_planted(path))
            fail(EACCES);
        path = path.parent_path() / fs::read_symlink(path, ignored);
    }
    return path;
}

void OutputFile::open_directly()
{
    file_ = open(path_.c_str(), O_WRONLY | O_TRUNC | O_NOCTTY | O_CLOEXEC);
    if (file_ < 0)
        fail(errno);
}

void OutputFile::open_neighbour()
{
    struct stat old { };
    const bool replaces = stat(target_.c_str(), &old) == 0;
    if (replaces && access(target_.c_str(), W_OK) != 0)
        fail(errno);
    const auto mode = mode_t(replaces ? 0600 : 0666); // nobody reads what the old file would not have shown
    int error = EEXIST;
    while (error == EEXIST) {
        working_path_ = random_neighbour(target_);
        unfinished_.emplace(working_path_);
        file_ = open(working_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
        error = file_ < 0 ? errno : 0;
        if (error != 0)
            unfinished_.reset();
    }
    if (error != 0)
        fail(error);
    if (replaces && !copy_access(file_, old))
        fail(errno);
}

void OutputFile::write(formats::Bytes bytes)
{
    while (!bytes.empty()) {
        const ssize_t count = ::write(file_, bytes.data(), bytes.size());
        if (count < 0 && errno != EINTR)
            fail(errno);
        bytes = bytes.subspan(size_t(std::max<ssize_t>(count, 0)));
    }
}

void OutputFile::take(const fs::path& file)
{
    errno = 0;
    std::ifstream from(file, std::ios::binary);
    std::array<std::byte, 1 << 16> part;
    while (from) {
        from.read(reinterpret_cast<char*>(part.data()), std::streamsize(part.size()));
        write(formats::Bytes(part).first(size_t(from.gcount())));
    }
    if (!from.eof())
        fail(errno);
}

void OutputFile::commit()
{
    const int file = std::exchange(file_, -1);
    if (close(file) != 0) // a full disk may show only here
        fail(errno);
    if (!unfinished_)
        return;
    if (rename(working_path_.c_str(), target_.c_str()) != 0)
        fail(errno);
    unfinished_.reset();
}

void OutputFile::fail(int error) const
{
    const bool is_full = error == ENOSPC || error == EDQUOT || error == EFBIG;
    throw Failure(fmt::format("cannot write {}: {}; {}", path_.string(), error ? std::strerror(error) : "unknown error",
        is_full ? "free some space, or name a file in another place" : "name a file in an existing, writable folder"));
}

} // namespace vkpt::client

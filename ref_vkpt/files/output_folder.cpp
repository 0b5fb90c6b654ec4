// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/files/output_folder.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace vkpt {

namespace {

constexpr int folder_flags = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
constexpr mode_t folder_mode = 0755, file_mode = 0644;

std::string describe_errno()
{
    if (errno == ELOOP || errno == ENOTDIR) // links are not followed
        return "there is a link or a file in its place";
    return std::error_code(errno, std::generic_category()).message();
}

// A file descriptor, closed at the end of life.
class Descriptor {
public:
    explicit Descriptor(int value)
        : value_(value)
    {
    }
    Descriptor& operator=(Descriptor&& other) noexcept
    {
        std::swap(value_, other.value_);
        return *this;
    }
    ~Descriptor()
    {
        if (value_ >= 0)
            ::close(value_);
    }
    explicit operator bool() const { return value_ >= 0; }
    int value() const { return value_; }
    int release() { return std::exchange(value_, -1); }
    // Disks that are full may say so only here.
    bool close() { return ::close(release()) == 0; }

private:
    int value_;
};

bool write_all(int descriptor, std::span<const std::byte> bytes)
{
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return false;
        bytes = bytes.subspan(size_t(written));
    }
    return true;
}

bool begins_with(int descriptor, std::string_view mark)
{
    std::array<char, 64> head {};
    assert(mark.size() <= head.size());
    const ssize_t length = read(descriptor, head.data(), mark.size());
    return length >= 0 && std::string_view(head.data(), size_t(length)) == mark;
}

} // namespace

bool is_plain_name(std::string_view name)
{
    constexpr size_t longest = 64;
    constexpr std::string_view allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
    return !name.empty() && name.size() <= longest && name.find_first_not_of(allowed) == std::string_view::npos;
}

OutputFolder::OutputFolder(int descriptor, std::filesystem::path path)
    : descriptor_(descriptor)
    , path_(std::move(path))
{
}

OutputFolder::OutputFolder(const std::filesystem::path& base, std::initializer_list<std::string_view> names)
    : path_(base)
{
    std::error_code error;
    std::filesystem::create_directories(base, error);
    Descriptor folder(open(base.c_str(), folder_flags));
    for (const std::string_view name : names) {
        if (!folder)
            break;
        path_ /= name;
        const std::string text(name);
        if (mkdirat(folder.value(), text.c_str(), folder_mode) != 0 && errno != EEXIST)
            throw FileError("cannot make the folder " + path_.string() + ": " + describe_errno());
        Descriptor next(openat(folder.value(), text.c_str(), folder_flags | O_NOFOLLOW));
        folder = std::move(next);
    }
    if (!folder)
        throw FileError("cannot use the folder " + path_.string() + ": " + describe_errno());
    descriptor_ = folder.release();
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1))
    , path_(std::move(other.path_))
{
}

OutputFolder::~OutputFolder()
{
    if (descriptor_ >= 0)
        ::close(descriptor_);
}

void OutputFolder::fail(const std::string& name, std::string_view reason) const
{
    throw FileError("cannot write " + (path_ / name).string() + ": " + std::string(reason));
}

OutputFolder OutputFolder::make_new(std::string_view name) const
{
    constexpr int most = 10000;
    for (int number = 1; number <= most; number++) {
        const std::string text = number == 1 ? std::string(name) : fmt::format("{}-{}", name, number);
        if (mkdirat(descriptor_, text.c_str(), folder_mode) != 0) {
            if (errno == EEXIST)
                continue;
            fail(text, describe_errno());
        }
        const int folder = openat(descriptor_, text.c_str(), folder_flags | O_NOFOLLOW);
        if (folder < 0)
            fail(text, describe_errno());
        return { folder, path_ / text };
    }
    fail(std::string(name), fmt::format("there are {} such folders: remove some", most));
}

void OutputFolder::check_replaceable(const std::string& name, std::string_view mark) const
{
    const Descriptor file(openat(descriptor_, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (!file) {
        if (errno != ENOENT)
            fail(name, describe_errno());
        return;
    }
    struct stat status { };
    if (fstat(file.value(), &status) != 0 || !S_ISREG(status.st_mode) || mark.empty()
        || !begins_with(file.value(), mark))
        fail(name, "something that the module did not write is there: move it away, or choose another name");
}

void OutputFolder::write(const std::string& name, std::span<const std::byte> bytes, std::string_view mark) const
{
    check_replaceable(name, mark);
    const std::string partial = "." + name + ".part";
    unlinkat(descriptor_, partial.c_str(), 0); // of a run that was killed
    Descriptor file(
        openat(descriptor_, partial.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, file_mode));
    if (!file)
        fail(name, describe_errno());
    const bool written = write_all(file.value(), bytes) && file.close();
    if (written && renameat(descriptor_, partial.c_str(), descriptor_, name.c_str()) == 0)
        return;
    const std::string reason = describe_errno();
    unlinkat(descriptor_, partial.c_str(), 0);
    fail(name, reason);
}

bool OutputFolder::has(const std::string& name) const
{
    struct stat status { };
    return fstatat(descriptor_, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0 || errno != ENOENT;
}

std::string OutputFolder::read(const std::string& name, size_t most) const
{
    const auto refuse
        = [&](const std::string& reason) { throw FileError("cannot read " + (path_ / name).string() + ": " + reason); };
    const Descriptor file(openat(descriptor_, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat status { };
    if (!file || fstat(file.value(), &status) != 0)
        refuse(describe_errno());
    if (!S_ISREG(status.st_mode))
        refuse("it is no file");
    std::string text(most + 1, '\0');
    size_t length = 0;
    while (length < text.size()) {
        const ssize_t got = ::read(file.value(), text.data() + length, text.size() - length);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            refuse(describe_errno());
        if (got == 0)
            break;
        length += size_t(got);
    }
    if (length > most)
        refuse(fmt::format("it is longer than {} bytes", most));
    text.resize(length);
    return text;
}

uint64_t OutputFolder::bytes() const
{
    uint64_t sum = 0;
    std::error_code error;
    for (std::filesystem::recursive_directory_iterator entry(path_, error), end; !error && entry != end;
         entry.increment(error)) {
        std::error_code vanished;
        if (entry->symlink_status(vanished).type() == std::filesystem::file_type::regular)
            sum += entry->file_size(vanished);
    }
    return sum;
}

uint64_t OutputFolder::free_bytes() const
{
    struct statvfs system { };
    return fstatvfs(descriptor_, &system) == 0 ? uint64_t(system.f_bavail) * system.f_frsize : 0;
}

void OutputFolder::check_room(uint64_t bytes, const FileRoom& room) const
{
    constexpr uint64_t left_on_disk = 256 * mebibyte; // for everybody else
    if (room.used + bytes > room.most)
        throw FileError(fmt::format("all {} in {} may take {} MiB: move some away, or start with +set pt_capture_mib "
                                    "and a larger number",
            room.what, room.folder.string(), room.most / mebibyte));
    if (free_bytes() < left_on_disk + bytes)
        throw FileError(fmt::format("the disk that holds {} is nearly full", path_.string()));
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/output_file.hpp"

#include "client/host/errors.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

namespace vkpt::client {

namespace fs = std::filesystem;

OutputFile::OutputFile(const fs::path& path)
    : path_(path)
{
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        throw Failure(fmt::format("cannot write {}: it is a folder; name a file", path.string()));
    working_path_ = path.parent_path() / fmt::format(".{}.{}.part", path.filename().string(), getpid());
    errno = 0;
    if (!std::ofstream(working_path_, std::ios::binary))
        fail(errno);
}

OutputFile::~OutputFile()
{
    std::error_code ignored;
    if (!is_committed_)
        fs::remove(working_path_, ignored);
}

void OutputFile::write(formats::Bytes bytes)
{
    errno = 0;
    std::ofstream stream(working_path_, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    stream.close();
    if (!stream)
        fail(errno);
}

void OutputFile::take(const fs::path& file)
{
    // By hand: fs::copy_file calls a full disk an input/output error, operator<< may not notice it.
    errno = 0;
    std::ifstream from(file, std::ios::binary);
    std::ofstream to(working_path_, std::ios::binary | std::ios::trunc);
    std::array<char, 1 << 16> part;
    while (from && to) {
        from.read(part.data(), std::streamsize(part.size()));
        to.write(part.data(), from.gcount());
    }
    to.close();
    if (!from.eof() || !to)
        fail(errno);
}

void OutputFile::commit()
{
    std::error_code error;
    fs::rename(working_path_, path_, error);
    if (error)
        fail(error.value());
    is_committed_ = true;
}

void OutputFile::fail(int error) const
{
    const bool is_full = error == ENOSPC || error == EDQUOT || error == EFBIG;
    throw Failure(fmt::format("cannot write {}: {}; {}", path_.string(), error ? std::strerror(error) : "unknown error",
        is_full ? "make room, or name a file in another place"
                : "name a file in a folder that exists and may be written to"));
}

} // namespace vkpt::client

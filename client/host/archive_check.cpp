// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/archive_check.hpp"

#include "formats/byte_reader.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <vector>

namespace vkpt::client {

namespace {

// The engine's own limit is 128. Each folder of a name takes memory for all of the name up to it.
constexpr size_t max_name_bytes = 255;
// Of a link within the archive: PhysicsFS reads all of it.
constexpr size_t max_link_bytes = 4096;
// Directories are read as a whole: 65,535 files with names of that length and as much of other fields.
constexpr size_t max_directory_bytes = size_t(64) << 20;

// Signatures, and the sizes of the records' fixed parts.
constexpr uint32_t zip_end = 0x06054b50, zip_file = 0x02014b50, zip64_locator = 0x07064b50;
constexpr size_t zip_end_bytes = 22, zip_locator_bytes = 20, zip_max_comment = 65535;
constexpr uint32_t unix_link = 0xa000, unix_kind = 0xf000; // upper half of a file's external attributes

using Block = std::vector<std::byte>;

class Archive {
public:
    explicit Archive(const std::filesystem::path& path)
        : stream_(path, std::ios::binary | std::ios::ate)
        , name_(path.filename().string())
    {
        size_ = stream_ ? size_t(std::max<std::streamoff>(stream_.tellg(), 0)) : 0;
    }

    bool is_readable() const { return bool(stream_); }
    size_t size() const { return size_; }
    const std::string& name() const { return name_; }

    Block read(size_t offset, size_t count)
    {
        Block block(std::min(count, size_ - std::min(offset, size_)));
        stream_.seekg(std::streamoff(offset));
        stream_.read(reinterpret_cast<char*>(block.data()), std::streamsize(block.size()));
        return block;
    }

private:
    std::ifstream stream_;
    std::string name_;
    size_t size_ = 0;
};

uint32_t number_at(const Block& block, size_t offset)
{
    uint32_t number = 0;
    std::memcpy(&number, block.data() + offset, sizeof(number));
    return number;
}

// Offset of the last end record in the file's last bytes.
std::optional<size_t> find_zip_end(const Block& tail)
{
    for (size_t at = tail.size() < zip_end_bytes ? 0 : tail.size() - zip_end_bytes + 1; at-- > 0;)
        if (number_at(tail, at) == zip_end)
            return at;
    return {};
}

// One file's record in the directory.
std::string check_file(formats::ByteReader& reader)
{
    if (reader.read<uint32_t>() != zip_file)
        return "its directory is damaged";
    reader.take(20); // versions, flags, method, time, checksum, packed size
    const auto unpacked = reader.read<uint32_t>();
    const auto name = reader.read<uint16_t>(), extra = reader.read<uint16_t>(), comment = reader.read<uint16_t>();
    reader.take(4); // disk, internal attributes
    const auto attributes = reader.read<uint32_t>();
    reader.take(4); // offset of the data
    if (name > max_name_bytes)
        return fmt::format("it has a name of {} bytes, more than {}", name, max_name_bytes);
    if ((attributes >> 16 & unix_kind) == unix_link && unpacked > max_link_bytes)
        return fmt::format("it has a link of {} bytes", unpacked);
    reader.take(size_t(name) + extra + comment);
    return {};
}

std::string check_directory(const Block& directory, size_t count, const std::string& name)
try {
    formats::ByteReader reader(directory, name);
    for (size_t i = 0; i < count; i++)
        if (std::string fault = check_file(reader); !fault.empty())
            return fault;
    return {};
} catch (const formats::FormatError&) {
    return fmt::format("its directory ends before its {} files", count);
}

std::string check_zip(Archive& archive)
{
    const size_t wanted = zip_max_comment + zip_end_bytes + zip_locator_bytes;
    const size_t tail_start = archive.size() - std::min(archive.size(), wanted);
    const Block tail = archive.read(tail_start, wanted);
    const std::optional<size_t> end = find_zip_end(tail);
    if (!end)
        return "it is neither PAK nor ZIP, or its end is missing";
    if (*end >= zip_locator_bytes && number_at(tail, *end - zip_locator_bytes) == zip64_locator)
        return "it is a ZIP64 archive, which is not supported";
    formats::ByteReader reader(tail, archive.name());
    reader.seek(*end + 8);
    reader.take(2);
    const auto count = reader.read<uint16_t>();
    const auto directory_size = reader.read<uint32_t>();
    const size_t end_offset = tail_start + *end;
    if (directory_size > end_offset || directory_size > max_directory_bytes)
        return fmt::format("its directory of {} bytes is not in it", directory_size);
    return check_directory(archive.read(end_offset - directory_size, directory_size), count, archive.name());
}

} // namespace

std::string find_archive_fault(const std::filesystem::path& path)
{
    Archive archive(path);
    if (!archive.is_readable())
        return "it cannot be opened";
    const Block head = archive.read(0, 4);
    constexpr std::array<char, 4> pak_ident { 'P', 'A', 'C', 'K' };
    if (head.size() == 4 && std::memcmp(head.data(), pak_ident.data(), 4) == 0)
        return {}; // names are of a fixed length
    return check_zip(archive);
}

} // namespace vkpt::client

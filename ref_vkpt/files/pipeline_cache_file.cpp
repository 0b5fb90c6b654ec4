// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/files/pipeline_cache_file.hpp"

#include "common/hash.hpp"

#include <cstring>

namespace vkpt {

namespace {

struct Header {
    std::array<char, 8> magic { 'V', 'K', 'P', 'T', 'P', 'I', 'P', 'E' };
    uint64_t version = 1;
    DriverIdentity driver;
    uint64_t cache_bytes = 0;
    uint64_t cache_hash = 0;
};
static_assert(sizeof(Header) == 80);

Header make_header(const DriverIdentity& driver, std::span<const std::byte> cache)
{
    Header header;
    header.driver = driver;
    header.cache_bytes = cache.size();
    header.cache_hash = hash_bytes(cache);
    return header;
}

} // namespace

std::vector<std::byte> write_pipeline_cache(const DriverIdentity& driver, std::span<const std::byte> cache)
{
    const Header header = make_header(driver, cache);
    std::vector<std::byte> file(sizeof header + cache.size());
    std::memcpy(file.data(), &header, sizeof header);
    if (!cache.empty())
        std::memcpy(file.data() + sizeof header, cache.data(), cache.size());
    return file;
}

std::span<const std::byte> read_pipeline_cache(const DriverIdentity& driver, std::span<const std::byte> file)
{
    if (file.size() < sizeof(Header))
        return {};
    const std::span<const std::byte> cache = file.subspan(sizeof(Header));
    const Header wanted = make_header(driver, cache);
    return std::memcmp(file.data(), &wanted, sizeof wanted) == 0 ? cache : std::span<const std::byte>();
}

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// A driver gets back what it gave, or nothing.
#include "ref_vkpt/files/pipeline_cache_file.hpp"

#include <gtest/gtest.h>
#include <string>

namespace vkpt::tests {
namespace {

const std::string compiled = "what the driver compiled";

DriverIdentity some_driver()
{
    DriverIdentity driver;
    driver.driver_uuid.fill(3);
    driver.cache_uuid.fill(4);
    driver.vendor = 0x10005;
    driver.driver_version = 25;
    return driver;
}

std::string read(const DriverIdentity& driver, std::span<const std::byte> file)
{
    const std::span<const std::byte> cache = read_pipeline_cache(driver, file);
    return { reinterpret_cast<const char*>(cache.data()), cache.size() };
}

TEST(PipelineCacheFile, ComesBack)
{
    const auto file = write_pipeline_cache(some_driver(), std::as_bytes(std::span(compiled)));
    EXPECT_EQ(read(some_driver(), file), compiled);
    EXPECT_EQ(read(some_driver(), write_pipeline_cache(some_driver(), {})), "");
}

TEST(PipelineCacheFile, IsIgnoredWithAnyByteChanged)
{
    auto file = write_pipeline_cache(some_driver(), std::as_bytes(std::span(compiled)));
    for (std::byte& byte : file) {
        byte ^= std::byte(1);
        EXPECT_EQ(read(some_driver(), file), "") << &byte - file.data();
        byte ^= std::byte(1);
    }
    EXPECT_EQ(read(some_driver(), file), compiled);
}

TEST(PipelineCacheFile, IsIgnoredWhenCutOrLonger)
{
    auto file = write_pipeline_cache(some_driver(), std::as_bytes(std::span(compiled)));
    for (size_t length = 0; length < file.size(); length++)
        EXPECT_EQ(read(some_driver(), std::span(file).first(length)), "") << length;
    file.push_back(std::byte(0));
    EXPECT_EQ(read(some_driver(), file), "");
    EXPECT_EQ(read(some_driver(), std::as_bytes(std::span(compiled))), "") << "as older versions wrote it";
}

TEST(PipelineCacheFile, IsOfOneDriver)
{
    const auto file = write_pipeline_cache(some_driver(), std::as_bytes(std::span(compiled)));
    DriverIdentity updated = some_driver();
    updated.driver_version++;
    EXPECT_EQ(read(updated, file), "");
    DriverIdentity other = some_driver();
    other.driver_uuid[15]++;
    EXPECT_EQ(read(other, file), "");
    other = some_driver();
    other.cache_uuid[0]++;
    EXPECT_EQ(read(other, file), "");
}

} // namespace
} // namespace vkpt::tests

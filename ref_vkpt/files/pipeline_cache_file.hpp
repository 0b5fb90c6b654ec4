// SPDX-License-Identifier: GPL-2.0-or-later
// A driver's pipeline cache as a file. Drivers believe what they are given, so it goes back only to the driver that
// made it, and only whole.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

// Which driver of which device; every byte counts, so there is no padding.
struct DriverIdentity {
    std::array<uint8_t, 16> driver_uuid {}, cache_uuid {};
    uint32_t vendor = 0, device = 0, driver_version = 0, api_version = 0;
};
static_assert(sizeof(DriverIdentity) == 48);

std::vector<std::byte> write_pipeline_cache(const DriverIdentity& driver, std::span<const std::byte> cache);
// The driver's own bytes, in `file`; empty: the file is damaged, of another version, or not this driver's.
std::span<const std::byte> read_pipeline_cache(const DriverIdentity& driver, std::span<const std::byte> file);

} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vkpt::client {

// Linear radiance as OpenEXR, three float32 channels, rows given top to bottom. Throws Failure.
std::vector<std::byte> write_exr(int width, int height, std::span<const float> rgb);

} // namespace vkpt::client

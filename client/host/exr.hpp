// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <filesystem>
#include <span>

namespace vkpt::client {

// Linear radiance as OpenEXR, three float32 channels, rows given top to bottom. Throws Failure.
void write_exr(const std::filesystem::path& path, int width, int height, std::span<const float> rgb);

} // namespace vkpt::client

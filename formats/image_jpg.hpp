// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "formats/image.hpp"

namespace formats {

bool is_jpg(Bytes file);
Image read_jpg(Bytes file, std::string_view name);

} // namespace formats

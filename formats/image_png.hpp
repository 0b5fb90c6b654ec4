// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "formats/image.hpp"

namespace formats {

bool is_png(Bytes file);
Image read_png(Bytes file, std::string_view name);

} // namespace formats

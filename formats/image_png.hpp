// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "formats/image.hpp"

namespace formats {

bool is_png(Bytes file);
Image read_png(Bytes file, std::string_view name, size_t room); // see image_room.hpp

} // namespace formats

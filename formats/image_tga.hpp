// SPDX-License-Identifier: GPL-2.0-or-later
// TGA has no signature: read_common_image tries it last.
#pragma once

#include "formats/image.hpp"

namespace formats {

Image read_tga(Bytes file, std::string_view name, size_t room); // see image_room.hpp

} // namespace formats

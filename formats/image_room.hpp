// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures whose pixels are counted together: what an archive of a megabyte may ask for.
#pragma once

#include "formats/image.hpp"

namespace formats {

// TGA, PNG, JPG by content, as without `room`. More pixels than that are refused before memory is taken for them.
Image read_common_image(Bytes file, std::string_view name, size_t room);

} // namespace formats

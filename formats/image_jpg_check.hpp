// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "formats/byte_reader.hpp"

namespace formats {

// Throws FormatError if the file holds a Huffman table of more than 256 codes: stb_image before 2.28 writes past its
// own table there.
void check_huffman_tables(Bytes jpg, std::string_view name);

} // namespace formats

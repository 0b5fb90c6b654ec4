// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/output.hpp"
#include "tools/asset_generator/palette.hpp"
#include "tools/asset_generator/pixel_font.hpp"

namespace vkpt::tools {

void write_palette_and_font(const Output& out)
{
    out.write("pics/colormap.pcx", formats::write_pcx(make_colormap()));
    out.write("pics/conchars.pcx", formats::write_pcx(make_character_sheet()));
}

} // namespace vkpt::tools

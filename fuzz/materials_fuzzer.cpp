// SPDX-License-Identifier: GPL-2.0-or-later
// A file of materials: read, written and read again, which gives the same.
#include "formats/material_file.hpp"
#include "fuzz/support/harness.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace vkpt;
    try {
        const formats::MaterialFile file = formats::read_materials(fuzz::text_of(data, size), "input");
        const std::string text = formats::write_materials(file.entries);
        const formats::MaterialFile again = formats::read_materials(text, "again");
        fuzz::require(again.messages.empty(), "what was written can be read");
        fuzz::require(formats::write_materials(again.entries) == text, "what was read is written the same");
    } catch (const formats::FormatError&) {
    }
    return 0;
}

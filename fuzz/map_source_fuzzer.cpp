// SPDX-License-Identifier: GPL-2.0-or-later
// A map source through the whole map compiler, with visibility and light where the first character asks for them; what
// it makes must be a map that the module's reader takes.
#include "fuzz/support/harness.hpp"
#include "tools/map_compiler/compiler.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace vkpt;
    if (size == 0)
        return 0;
    tools::CompileOptions options;
    options.visibility = (data[0] & 1) != 0;
    options.light = (data[0] & 2) != 0;
    options.threads = 1;
    formats::Bsp compiled;
    try {
        compiled = tools::compile_map(fuzz::text_of(data + 1, size - 1), "input.map", options);
    } catch (const tools::MapError&) {
        return 0;
    } catch (const formats::FormatError&) {
        return 0;
    }
    const std::vector<std::byte> file = formats::write_bsp(compiled);
    fuzz::use(formats::read_bsp(file, "input.bsp")); // FormatError here is a finding
    return 0;
}

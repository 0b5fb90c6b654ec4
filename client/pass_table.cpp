// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/pass_table.hpp"

#include "ref_vkpt/frame/pass_rows.hpp"

#include <fmt/format.h>

namespace vkpt::client {

namespace {

// "FRAME_A | FRAME_B" as "FRAME_A, FRAME_B"; "0": nothing.
std::string list_flags(std::string_view flags, const char* before)
{
    std::string list;
    for (const char c : flags == "0" ? std::string_view() : flags)
        if (c == '|')
            list.back() = ',';
        else
            list += c;
    return list.empty() ? list : fmt::format("{}`{}`", before, list);
}

std::string list_conditions(const Pass& pass)
{
    const std::string when = list_flags(pass.when_text, "with "), unless = list_flags(pass.unless_text, "not with ");
    return when + (when.empty() || unless.empty() ? "" : ", ") + unless;
}

std::string list_resources(PassResources resources)
{
    std::string list;
    for (uint32_t resource = 0; resource < resource_count; resource++)
        if (resources >> resource & 1 && resource != resource_trace_stack)
            list += fmt::format("{}{}", list.empty() ? "" : ", ", pass_resource_names[resource]);
    return list;
}

const char* describe(PassKind kind)
{
    switch (kind) {
    case PassKind::plain:
        return "once";
    case PassKind::traced:
        return "per trace backend";
    case PassKind::lit:
        return "per light sampler and trace backend";
    case PassKind::choosing:
        return "per light sampler";
    }
    return "";
}

} // namespace

std::string make_pass_page()
{
    std::string page = "# Passes\n\n"
                       "<!-- Written by `vkpt info --passes` from shaders/passes.def: edit the rows there. -->\n\n"
                       "In the order in which a view is recorded; \"apart\" come from the 2D layer, the window or a "
                       "host's question. A "
                       "pass is run\nwhere the flags of `shaders/shared/frame.h` say so. It reads and writes rows of "
                       "`shaders/shared/screen_buffers.def`, and\nwaits only for passes that it shares one with.\n\n"
                       "| pass | what it does | run | shader built | reads | writes |\n|---|---|---|---|---|---|\n";
    for (const Pass& pass : pass_rows)
        page += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", pass.name, pass.help,
            pass.extent == PassExtent::other ? "apart" : list_conditions(pass), describe(pass.kind),
            list_resources(pass.reads), list_resources(pass.writes));
    return page;
}

} // namespace vkpt::client

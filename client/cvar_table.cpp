// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/cvar_table.hpp"

#include "ref_vkpt/cvars_rows.hpp"

#include <fmt/format.h>

namespace vkpt::client {

namespace {

// In a table cell a bar would end the cell.
std::string escape_bars(std::string_view text)
{
    std::string escaped;
    for (const char c : text)
        escaped += c == '|' ? std::string("\\|") : std::string(1, c);
    return escaped;
}

std::string show_values(const CvarRow& row)
{
    if (row.type == CvarType::text)
        return *row.choices ? escape_bars(row.choices) : "text";
    const char* kind = row.type == CvarType::integer ? "whole number" : "number";
    return row.owner == CvarOwner::engine ? kind : fmt::format("{}, {} to {}", kind, row.lowest, row.highest);
}

const char* describe_keep(CvarKeep keep)
{
    return keep == CvarKeep::session ? "no" : keep == CvarKeep::start ? "no; at the start only" : "yes";
}

const char* describe_counts(CvarCounts counts)
{
    switch (counts) {
    case CvarCounts::at_once:
        return "at once";
    case CvarCounts::map:
        return "with the next map";
    case CvarCounts::restart:
        return "after `vid_restart`";
    }
    return "";
}

std::string make_table(CvarOwner owner, bool diagnostic = false)
{
    std::string table
        = "| name | default | values | saved | a change counts | what it does |\n|---|---|---|---|---|---|\n";
    for (const CvarRow& row : cvar_rows)
        if (row.owner == owner && row.diagnostic == diagnostic)
            table += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.name,
                *row.initial ? fmt::format("`{}`", row.initial) : std::string("(empty)"), show_values(row),
                describe_keep(row.keep), describe_counts(row.counts), escape_bars(row.help));
    return table;
}

} // namespace

std::string make_cvar_page()
{
    return "# Console variables\n\n"
           "<!-- Written by `vkpt info --cvars` from shaders/shared/cvars.def: edit the rows there. -->\n\n"
           "Set one in the game's console (`pt_bounces 2`), on the engine's command line (`+set pt_bounces 2`) or for "
           "the tools\n"
           "(`--set pt_bounces=2`). A value out of range is corrected, with a message in the console.\n"
           "Variables marked \"at the start only\" belong on the command line or in autoexec.cfg: servers cannot "
           "change "
           "them there.\n\n"
           "## The renderer's own\n\n"
        + make_table(CvarOwner::module) + "\n## For measuring and finding faults\n\n"
        + make_table(CvarOwner::module, true) + "\n## Shared with the engine's renderers\n\n"
        + make_table(CvarOwner::engine);
}

} // namespace vkpt::client

// SPDX-License-Identifier: GPL-2.0-or-later
// Console variables as a player, a configuration or a server sets them. The input: lines, each a byte that says which
// variable, then its text. Whatever was set, the module's own values stay in their ranges.
#include "ref_vkpt/cvars.hpp"

#include "fuzz/support/harness.hpp"
#include "fuzz/support/input.hpp"
#include "ref_vkpt/cvars_rows.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "tests/contract/mock_engine.hpp"

#include <cmath>
#include <cstdlib>
#include <iterator>

namespace {

using namespace vkpt;

void check_rows(const tests::MockEngine& engine)
{
    for (const CvarRow& row : cvar_rows) {
        if (row.owner != CvarOwner::module || row.keep == CvarKeep::start) // the engine keeps what those are set to
            continue;
        const std::string& text = engine.variables.at(row.name).text;
        if (row.type == CvarType::text) {
            fuzz::require(*row.choices == '\0' || find_choice(row.choices, text) >= 0, "a choice is one of its row's");
            continue;
        }
        const double number = std::strtod(text.c_str(), nullptr);
        fuzz::require(
            number >= row.lowest - 1e-6 * std::abs(row.lowest) && number <= row.highest + 1e-6 * std::abs(row.highest),
            "a number is in its row's range");
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    static tests::MockEngine engine;
    static const bool attached = [] {
        engine::attach(engine.imports());
        cvars::register_all();
        return true;
    }();
    fuzz::use(attached);
    engine.console.clear();
    fuzz::Input input(data, size);
    std::vector<const CvarRow*> changed;
    while (!input.is_empty() && changed.size() < 16) {
        const CvarRow& row = cvar_rows[input.take<uint8_t>() % std::size(cvar_rows)];
        engine.set(row.name, std::string(input.take_until('\n')).c_str()); // the engine's texts end at a zero
        changed.push_back(&row);
        cvars::update();
    }
    check_rows(engine);
    fuzz::use(cvars::shader_values());
    cvars::update();
    // A change of a variable that counts later may be told of, too.
    fuzz::require(engine.console.size() <= 2 * changed.size(), "a wrong value is told once");
    for (const CvarRow* row : changed)
        engine.set(row->name, row->initial);
    cvars::update();
    return 0;
}

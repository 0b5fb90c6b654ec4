// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/cvars.hpp"

#include "common/numbers.hpp"
#include "ref_vkpt/cvars_rows.hpp"
#include "ref_vkpt/engine/engine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace vkpt::cvars {

namespace {

constexpr size_t row_count = std::size(cvar_rows);

static_assert(std::string_view(find_cvar_row("pt_table_reads")->choices) == "auto|texels|address"); // enum TableReads

constexpr std::string_view choices_of(std::string_view cvar) { return find_cvar_row(cvar)->choices; }

// The constants of a list of choices are their places in its text.
#define VKPT_CHOICE_IS_ITS_PLACE(constant, number, text)                                                               \
    static_assert(find_choice(row_choices, text) == shared::constant);
#define VKPT_SHADER_CHOICE(name, initial, choices, keep, help)                                                         \
    namespace name##_choices                                                                                           \
    {                                                                                                                  \
        constexpr std::string_view row_choices = choices_of(#name);                                                    \
        choices(VKPT_CHOICE_IS_ITS_PLACE)                                                                              \
    }
#include "shaders/shared/cvars.def"
#undef VKPT_CHOICE_IS_ITS_PLACE

struct State {
    std::array<engine::Cvar*, row_count> cvars {}; // the engine's, in the order of the rows
    std::array<std::optional<std::string>, row_count> texts; // as last read
    CvarValues values;
};
State state;

int engine_flags(CvarKeep keep)
{
    switch (keep) {
    case CvarKeep::session:
        return engine::CVAR_NONE;
    case CvarKeep::archive:
        return engine::CVAR_ARCHIVE;
    case CvarKeep::user_info:
        return engine::CVAR_ARCHIVE | engine::CVAR_USERINFO;
    case CvarKeep::start:
        return engine::CVAR_NOSET;
    }
    return engine::CVAR_NONE;
}

// All of `text` must be one finite number, spaces around it and a plus sign aside.
std::optional<double> parse_value(std::string_view text)
{
    const size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos)
        return std::nullopt;
    text = text.substr(first, text.find_last_not_of(" \t") - first + 1);
    if (text.front() == '+')
        text.remove_prefix(1);
    return parse_number<double>(text);
}

std::string number_text(double number) { return fmt::format("{}", float(number)); }

// What the row makes of `text`: the same text where it is valid.
std::string correct_number(const CvarRow& row, const std::string& text)
{
    const std::optional<double> number = parse_value(text);
    if (!number) {
        engine::print("ref_vkpt: {} \"{}\" is not a number; range {} to {}, using the default {}", row.name, text,
            row.lowest, row.highest, row.initial);
        return row.initial;
    }
    double corrected = std::clamp(*number, row.lowest, row.highest);
    if (row.type == CvarType::integer)
        corrected = std::trunc(corrected);
    if (corrected == *number)
        return text;
    engine::print("ref_vkpt: {} {} is outside its range of {}{} to {} (default {}), using {}", row.name, text,
        row.type == CvarType::integer ? "whole numbers " : "", row.lowest, row.highest, row.initial,
        number_text(corrected));
    return number_text(corrected);
}

// Values that had another name in earlier versions; players' configurations still hold them.
struct RenamedChoice {
    std::string_view cvar, old_name, name;
};
constexpr RenamedChoice renamed_choices[] = { { "pt_light_weight", "chapter", "brdf_centre" } };

std::string correct_choice(const CvarRow& row, const std::string& text)
{
    for (const RenamedChoice& renamed : renamed_choices)
        if (renamed.cvar == row.name && renamed.old_name == text)
            return std::string(renamed.name);
    if (*row.choices == '\0' || find_choice(row.choices, text) >= 0)
        return text;
    engine::print(
        "ref_vkpt: {} \"{}\" is not one of {}; using the default {}", row.name, text, row.choices, row.initial);
    return row.initial;
}

// The row's text as it counts, put right in the engine where it was wrong.
const std::string& read_text(size_t index)
{
    const CvarRow& row = cvar_rows[index];
    std::string text = state.cvars[index] && state.cvars[index]->text ? state.cvars[index]->text : row.initial;
    if (row.owner == CvarOwner::module) {
        std::string corrected = row.type == CvarType::text ? correct_choice(row, text) : correct_number(row, text);
        if (corrected != text && row.keep != CvarKeep::start) // those refuse it
            engine::set_cvar(row.name, corrected);
        text = std::move(corrected);
    }
    return state.texts[index].emplace(std::move(text));
}

double read_number(size_t index) { return parse_value(read_text(index)).value_or(0); }

void read_field(size_t index, int& field) { field = int(std::clamp(read_number(index), -2147483648.0, 2147483647.0)); }
void read_field(size_t index, float& field) { field = float(read_number(index)); }
void read_field(size_t index, std::string& field) { field = read_text(index); }

// Reads what differs from the last reading.
void read_all(CvarValues& values)
{
    size_t index = 0;
    const auto read_next = [&](auto& field) {
        const size_t i = index++;
        const engine::Cvar* cvar = state.cvars[i];
        // CVAR_NOSET alone does not keep the value: "set NAME VALUE u" goes past it.
        const bool may_change = cvar_rows[i].keep != CvarKeep::start && cvar && cvar->text;
        if (!state.texts[i] || (may_change && *state.texts[i] != cvar->text))
            read_field(i, field);
    };
#define VKPT_SHADER_INT(name, initial, lowest, highest, keep, help) read_next(values.name);
#define VKPT_SHADER_FLOAT(name, initial, lowest, highest, keep, help) read_next(values.name);
#define VKPT_SHADER_CHOICE(name, initial, choices, keep, help) read_next(values.name);
#define VKPT_HOST_INT(name, initial, lowest, highest, keep, help) read_next(values.name);
#define VKPT_HOST_FLOAT(name, initial, lowest, highest, keep, help) read_next(values.name);
#define VKPT_HOST_STRING(name, initial, choices, keep, help) read_next(values.name);
#define VKPT_ENGINE_INT(name, initial, keep, help) read_next(values.name);
#define VKPT_ENGINE_FLOAT(name, initial, keep, help) read_next(values.name);
#define VKPT_ENGINE_STRING(name, initial, keep, help) read_next(values.name);
#include "shaders/shared/cvars.def"
}

} // namespace

void register_all()
{
    state = {};
    for (size_t i = 0; i < row_count; i++)
        state.cvars[i] = engine::get_cvar(cvar_rows[i].name, cvar_rows[i].initial, engine_flags(cvar_rows[i].keep));
    read_all(state.values);
}

// A change that shows nothing at first is told of.
void tell_late_changes(const std::array<std::optional<std::string>, row_count>& before)
{
    for (size_t i = 0; i < row_count; i++) {
        const CvarRow& row = cvar_rows[i];
        if (row.counts != CvarCounts::at_once && row.owner == CvarOwner::module && before[i] != state.texts[i])
            engine::print("ref_vkpt: {} counts {}", row.name,
                row.counts == CvarCounts::map ? "with the next map" : "after vid_restart");
    }
}

bool update()
{
    const CvarValues before = state.values;
    const auto texts_before = state.texts;
    read_all(state.values);
    tell_late_changes(texts_before);
    return !(state.values == before);
}

const CvarValues& values() { return state.values; }

CvarValues players_values()
{
    CvarValues values = state.values;
    values.r_lightlevel = 0;
    return values;
}

shared::ShaderCvars shader_values()
{
    shared::ShaderCvars numbers {};
#define VKPT_SHADER_INT(name, initial, lowest, highest, keep, help) numbers.name = state.values.name;
#define VKPT_SHADER_FLOAT(name, initial, lowest, highest, keep, help) numbers.name = state.values.name;
#define VKPT_SHADER_CHOICE(name, initial, choices, keep, help)                                                         \
    {                                                                                                                  \
        static constexpr std::string_view row_choices = choices_of(#name);                                             \
        numbers.name = find_choice(row_choices, state.values.name);                                                    \
    }
#include "shaders/shared/cvars.def"
    return numbers;
}

void set(const char* name, const std::string& text) { engine::set_cvar(name, text); }

} // namespace vkpt::cvars

// SPDX-License-Identifier: GPL-2.0-or-later
// The rows of shaders/shared/cvars.def as data: for registration, clamping and the table in the docs. Header only, no
// engine.
#pragma once

#include <span>
#include <string_view>

namespace vkpt {

enum class CvarType { integer, number, text };
// start: not saved either, and only the command line and autoexec.cfg change it: servers can run console commands.
enum class CvarKeep { session, archive, user_info, start };
enum class CvarOwner { module, engine };
// When a change counts.
enum class CvarCounts { at_once, map, restart };

struct CvarRow {
    const char* name;
    CvarType type;
    CvarOwner owner;
    CvarKeep keep;
    CvarCounts counts;
    bool diagnostic; // for people who look for faults or measure
    const char* initial;
    double lowest, highest; // module's numbers only
    const char* choices; // module's texts only: "a|b|c"; "": any text
    const char* help;
};

// The place of `choice` in "a|b|c", -1: not one of them.
constexpr int find_choice(std::string_view choices, std::string_view choice)
{
    for (int place = 0;; place++) {
        const size_t end = choices.find('|');
        if (choices.substr(0, end) == choice)
            return place;
        if (end == std::string_view::npos)
            return -1;
        choices.remove_prefix(end + 1);
    }
}

namespace cvar_row_names {
// What stands in a row's column `keep`.
struct Keep {
    CvarKeep keep = CvarKeep::session;
    CvarCounts counts = CvarCounts::at_once;
    bool diagnostic = false;
};
// `right`: MAP, RESTART or DIAGNOSTIC.
constexpr Keep operator|(Keep left, const Keep& right)
{
    if (right.counts != CvarCounts::at_once)
        left.counts = right.counts;
    left.diagnostic |= right.diagnostic;
    return left;
}
inline constexpr Keep SESSION { CvarKeep::session }, ARCHIVE { CvarKeep::archive }, USERINFO { CvarKeep::user_info },
    START { CvarKeep::start }, MAP { CvarKeep::session, CvarCounts::map },
    RESTART { CvarKeep::session, CvarCounts::restart }, DIAGNOSTIC { CvarKeep::session, CvarCounts::at_once, true };

constexpr CvarRow make_row(const char* name, CvarType type, CvarOwner owner, const Keep& keep, const char* initial,
    double lowest, double highest, const char* choices, const char* help)
{
    return { name, type, owner, keep.keep, keep.counts, keep.diagnostic, initial, lowest, highest, choices, help };
}
#define VKPT_NUMBER_ROW(name, type, initial, lowest, highest, keep, help)                                              \
    make_row(#name, type, CvarOwner::module, keep, #initial, lowest, highest, "", help),
#define VKPT_TEXT_ROW(name, initial, choices, keep, help)                                                              \
    make_row(#name, CvarType::text, CvarOwner::module, keep, initial, 0, 0, choices, help),
#define VKPT_ENGINE_ROW(name, type, initial, keep, help)                                                               \
    make_row(#name, type, CvarOwner::engine, keep, initial, 0, 0, "", help),

#define VKPT_SHADER_INT(name, initial, lowest, highest, keep, help)                                                    \
    VKPT_NUMBER_ROW(name, CvarType::integer, initial, lowest, highest, keep, help)
#define VKPT_SHADER_FLOAT(name, initial, lowest, highest, keep, help)                                                  \
    VKPT_NUMBER_ROW(name, CvarType::number, initial, lowest, highest, keep, help)
#define VKPT_CHOICE_TEXT(constant, number, text) "|" text
#define VKPT_SHADER_CHOICE(name, initial, choices, keep, help)                                                         \
    VKPT_TEXT_ROW(name, initial, &(choices(VKPT_CHOICE_TEXT))[1], keep, help)
#define VKPT_HOST_INT(name, initial, lowest, highest, keep, help)                                                      \
    VKPT_NUMBER_ROW(name, CvarType::integer, initial, lowest, highest, keep, help)
#define VKPT_HOST_FLOAT(name, initial, lowest, highest, keep, help)                                                    \
    VKPT_NUMBER_ROW(name, CvarType::number, initial, lowest, highest, keep, help)
#define VKPT_HOST_STRING(name, initial, choices, keep, help) VKPT_TEXT_ROW(name, initial, choices, keep, help)
#define VKPT_ENGINE_INT(name, initial, keep, help) VKPT_ENGINE_ROW(name, CvarType::integer, #initial, keep, help)
#define VKPT_ENGINE_FLOAT(name, initial, keep, help) VKPT_ENGINE_ROW(name, CvarType::number, #initial, keep, help)
#define VKPT_ENGINE_STRING(name, initial, keep, help) VKPT_ENGINE_ROW(name, CvarType::text, initial, keep, help)

inline constexpr CvarRow rows[] = {
#include "shaders/shared/cvars.def"
};

#undef VKPT_NUMBER_ROW
#undef VKPT_TEXT_ROW
#undef VKPT_ENGINE_ROW
#undef VKPT_CHOICE_TEXT
} // namespace cvar_row_names

inline constexpr auto& cvar_rows = cvar_row_names::rows;

constexpr const CvarRow* find_cvar_row(std::string_view name)
{
    for (const CvarRow& row : cvar_rows)
        if (name == row.name)
            return &row;
    return nullptr;
}

} // namespace vkpt

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

struct CvarRow {
    const char* name;
    CvarType type;
    CvarOwner owner;
    CvarKeep keep;
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

namespace cvar_keep_names {
inline constexpr CvarKeep SESSION = CvarKeep::session;
inline constexpr CvarKeep ARCHIVE = CvarKeep::archive;
inline constexpr CvarKeep USERINFO = CvarKeep::user_info;
inline constexpr CvarKeep START = CvarKeep::start;
} // namespace cvar_keep_names

#define VKPT_NUMBER_ROW(name, type, initial, lowest, highest, keep, help)                                              \
    CvarRow { #name, type, CvarOwner::module, cvar_keep_names::keep, #initial, lowest, highest, "", help },
#define VKPT_TEXT_ROW(name, initial, choices, keep, help)                                                              \
    CvarRow { #name, CvarType::text, CvarOwner::module, cvar_keep_names::keep, initial, 0, 0, choices, help },
#define VKPT_ENGINE_ROW(name, type, initial, keep, help)                                                               \
    CvarRow { #name, type, CvarOwner::engine, cvar_keep_names::keep, initial, 0, 0, "", help },

#define VKPT_SHADER_INT(name, initial, lowest, highest, keep, help)                                                    \
    VKPT_NUMBER_ROW(name, CvarType::integer, initial, lowest, highest, keep, help)
#define VKPT_SHADER_FLOAT(name, initial, lowest, highest, keep, help)                                                  \
    VKPT_NUMBER_ROW(name, CvarType::number, initial, lowest, highest, keep, help)
#define VKPT_SHADER_CHOICE(name, initial, choices, keep, help) VKPT_TEXT_ROW(name, initial, choices, keep, help)
#define VKPT_HOST_INT(name, initial, lowest, highest, keep, help)                                                      \
    VKPT_NUMBER_ROW(name, CvarType::integer, initial, lowest, highest, keep, help)
#define VKPT_HOST_FLOAT(name, initial, lowest, highest, keep, help)                                                    \
    VKPT_NUMBER_ROW(name, CvarType::number, initial, lowest, highest, keep, help)
#define VKPT_HOST_STRING(name, initial, choices, keep, help) VKPT_TEXT_ROW(name, initial, choices, keep, help)
#define VKPT_ENGINE_INT(name, initial, keep, help) VKPT_ENGINE_ROW(name, CvarType::integer, #initial, keep, help)
#define VKPT_ENGINE_FLOAT(name, initial, keep, help) VKPT_ENGINE_ROW(name, CvarType::number, #initial, keep, help)
#define VKPT_ENGINE_STRING(name, initial, keep, help) VKPT_ENGINE_ROW(name, CvarType::text, initial, keep, help)

inline constexpr CvarRow cvar_rows[] = {
#include "shaders/shared/cvars.def"
};

#undef VKPT_NUMBER_ROW
#undef VKPT_TEXT_ROW
#undef VKPT_ENGINE_ROW

constexpr const CvarRow* find_cvar_row(std::string_view name)
{
    for (const CvarRow& row : cvar_rows)
        if (name == row.name)
            return &row;
    return nullptr;
}

} // namespace vkpt

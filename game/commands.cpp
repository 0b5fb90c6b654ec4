// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/commands.hpp"

#include "game/module.hpp"

#include <fmt/format.h>

namespace vkpt::game {

namespace {

void print_version(Module& module, const Command& command)
{
    Host& host = module.host();
    host.say(command.sender,
        fmt::format("vkpt: wraps {}; {} of {} entities in use; writes to {}", module.library().path().string(),
            host.game->edict_count, host.game->max_edicts, host.write_folder.string()));
}

struct Entry {
    std::string_view name;
    CommandHandler handler;
};
constexpr Entry commands[] {
    { "light", [](Module& module, const Command& command) { module.lights().run(command); } },
    { "flare", [](Module& module, const Command& command) { module.flares().run(command); } },
    { "stress", [](Module& module, const Command& command) { module.stress().run(command); } },
    { "walk", [](Module& module, const Command& command) { module.walker().run(command, module.is_client()); } },
    { "vkpt_game", print_version },
};

} // namespace

CommandHandler find_command(std::string_view name)
{
    for (const Entry& entry : commands)
        if (entry.name == name)
            return entry.handler;
    return nullptr;
}

} // namespace vkpt::game

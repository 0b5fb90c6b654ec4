// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/host.hpp"

#include <cmath>
#include <glm/trigonometric.hpp>

namespace vkpt::game {

void Host::say(Edict* player, std::string_view text)
{
    if (player)
        replies.say(engine, player, std::string(text));
    else // the console takes all at once
        engine.client_print(nullptr, PRINT_HIGH, "%s\n", std::string(text).c_str());
}

Trace Host::trace(glm::vec3 from, glm::vec3 to, const Box& box, const Edict* ignored, int mask) const
{
    return engine.trace(&from.x, &box.mins.x, &box.maxs.x, &to.x, ignored, mask);
}

glm::vec3 forward_of(glm::vec3 angles)
{
    const glm::vec3 a = glm::radians(angles);
    return { std::cos(a.x) * std::cos(a.y), std::cos(a.x) * std::sin(a.y), -std::sin(a.x) };
}

Eye eye_of(const Edict& player)
{
    const PlayerState& state = player.client->state;
    const glm::vec3 angles = to_vec3(state.view_angles);
    return { to_vec3(player.state.origin) + to_vec3(state.view_offset), angles, forward_of(angles) };
}

} // namespace vkpt::game

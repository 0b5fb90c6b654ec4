// SPDX-License-Identifier: GPL-2.0-or-later
// The running map as navigation sees it: through the server's traces, with doors and trains out of the way.
#pragma once

#include "game/host.hpp"
#include "game/navigation.hpp"

#include <string_view>
#include <vector>

namespace vkpt::game {

// What the map's entity text says of its brush models.
struct BrushEntities {
    struct Platform {
        int model; // inline model's number
        float height, lip; // keys; height 0: not given
    };
    std::vector<int> doors; // inline models of what gives way: doors and trains
    std::vector<Platform> platforms; // that rise when somebody steps on
};
BrushEntities read_brush_entities(std::string_view entity_text);

// While it lives, doors and trains are not solid: make it for a moment, between calls into the game.
class ServerSpace final : public Space {
public:
    ServerSpace(const Host& host, const BrushEntities& brushes, const Edict& player);
    ~ServerSpace() override;
    ServerSpace(const ServerSpace&) = delete;
    ServerSpace& operator=(const ServerSpace&) = delete;

    Hit move(glm::vec3 from, glm::vec3 to) const override;
    Medium medium(glm::vec3 p) const override;

private:
    const Host& host_;
    const Edict& player_;
    std::vector<Edict*> opened_;
};

// As they stand now, which is at their lowest once the level has begun.
std::vector<Lift> find_lifts(const Host& host, const BrushEntities& brushes);

} // namespace vkpt::game

// SPDX-License-Identifier: GPL-2.0-or-later
// Many moving lights for benchmarks: `stress N [SEED] [drift|fast|still]`. They fly through the map's empty space,
// turned back by its walls, the same way in every run. A message and a frame of the engine have no room for a thousand
// entities: beyond 64 lights an entity carries several that circle it.
#pragma once

#include "game/host.hpp"
#include "game/random.hpp"

#include <cstdint>
#include <vector>

namespace vkpt::game {

class Stress {
public:
    explicit Stress(Host& host)
        : host_(host)
    {
    }

    void run(const Command& command);
    void begin_level() { swarms_.clear(); }
    // Once a server frame.
    void update();

    static constexpr int max_swarms = 64, max_emitters = 1024;

private:
    struct Swarm {
        int entity;
        glm::vec3 origin, velocity;
        float radius; // of the free ball that it needs
    };
    void clear();
    void add(Random& random, glm::vec3 start, uint32_t count, float speed);
    glm::vec3 find_place(Random& random, glm::vec3 start, float radius) const;
    void move(Swarm& swarm);

    Host& host_;
    std::vector<Swarm> swarms_;
};

} // namespace vkpt::game

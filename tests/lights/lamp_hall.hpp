// SPDX-License-Identifier: GPL-2.0-or-later
// One open hall of cells, each a cluster, lamps of very different strength all over its ceiling in no order.
#pragma once

#include "ref_vkpt/lights/light_lists.hpp"
#include "synthetic_bsp.hpp"

#include <cmath>
#include <random>
#include <vector>

namespace vkpt::test {

struct LampHall {
    static constexpr int size = 6; // cells

    explicit LampHall(size_t lamp_count)
        : bsp(make_cell_map(size, std::vector<bool>(size_t(size * size), true)))
    {
        std::uniform_real_distribution<float> unit(0, 1);
        for (size_t i = 0; i < lamp_count; i++) {
            shared::Emitter lamp {};
            lamp.p0
                = glm::vec3(cell_size * float(size) * unit(rng), cell_size * float(size) * unit(rng), cell_size - 4);
            lamp.p1 = lamp.p0 + glm::vec3(0, 6, 0);
            lamp.p2 = lamp.p0 + glm::vec3(6, 0, 0);
            lamp.radiance = glm::vec3(std::exp(5 * unit(rng)));
            lamps.push_back(lamp);
        }
        lists.build(bsp, lamps);
    }

    int cluster_at(glm::vec3 p) const { return bsp.find_cluster(p); }
    glm::vec3 point_on_floor()
    {
        std::uniform_real_distribution<float> unit(0, 1);
        const float x = cell_size * float(size) * unit(rng);
        return glm::vec3(x, cell_size * float(size) * unit(rng), 0.1f);
    }

    std::mt19937 rng { 3 };
    formats::Bsp bsp;
    std::vector<shared::Emitter> lamps;
    LightLists lists;
};

} // namespace vkpt::test

// SPDX-License-Identifier: GPL-2.0-or-later
// measure_coverage MAP.bsp STATES: what share of a map's reachable leaves the player of a probe's file of states has
// seen.
#include "tests/game/coverage.hpp"

#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

using namespace vkpt::tests;

int main(int count, char** arguments)
{
    if (count < 3)
        return 2;
    std::ifstream file(arguments[1], std::ios::binary);
    const std::vector<char> bytes { std::istreambuf_iterator<char>(file), {} };
    const formats::Bsp bsp = formats::read_bsp(std::as_bytes(std::span(bytes)), arguments[1]);
    std::vector<glm::vec3> way;
    std::ifstream states(arguments[2]);
    for (std::string line; std::getline(states, line);) {
        std::istringstream words(line);
        std::string hash;
        int entities = 0, health = 0;
        glm::vec3 p;
        if (words >> hash >> entities >> p.x >> p.y >> p.z >> health && health > -999)
            way.push_back(p);
    }
    const std::set<size_t> reachable = find_reachable_leaves(bsp), seen = find_seen_leaves(bsp, way);
    size_t both = 0;
    for (const size_t leaf : reachable) {
        both += seen.contains(leaf);
        if (!seen.contains(leaf) && count > 3) {
            const auto& l = bsp.leaves[leaf];
            std::cout << "missing leaf " << leaf << " contents " << l.contents << " " << l.mins[0] << " " << l.mins[1]
                      << " " << l.mins[2] << " .. " << l.maxs[0] << " " << l.maxs[1] << " " << l.maxs[2] << "\n";
        }
    }
    std::cout << both << " of " << reachable.size() << " reachable leaves (of " << bsp.leaves.size() << ") seen, "
              << way.size() << " frames\n";
}

// SPDX-License-Identifier: GPL-2.0-or-later
// Navigation in spaces made of boxes.
#include "game/navigation.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <vector>

namespace vkpt::game {

namespace {

struct Block {
    glm::vec3 mins, maxs;
};

// A box of a player moved among blocks, in small steps.
class Blocks final : public Space {
public:
    std::vector<Block> blocks, water, lava;

    Hit move(glm::vec3 from, glm::vec3 to) const override
    {
        Hit hit { 1, to, { 0, 0, 1 }, is_solid(from) };
        const int steps = std::max(1, int(glm::distance(from, to) * 4));
        for (int i = 1; i <= steps && !hit.starts_solid; i++) {
            const glm::vec3 p = glm::mix(from, to, float(i) / float(steps));
            if (!is_solid(p))
                continue;
            hit.fraction = float(i - 1) / float(steps);
            hit.end = glm::mix(from, to, hit.fraction);
            return hit;
        }
        if (hit.starts_solid)
            hit.fraction = 0;
        return hit;
    }
    Medium medium(glm::vec3 p) const override
    {
        const auto is_in = [&](const Block& b) {
            return p.x > b.mins.x && p.y > b.mins.y && p.z > b.mins.z && p.x < b.maxs.x && p.y < b.maxs.y
                && p.z < b.maxs.z;
        };
        if (std::ranges::any_of(lava, is_in))
            return Medium::deadly;
        return std::ranges::any_of(water, is_in) ? Medium::water : Medium::air;
    }

private:
    bool is_solid(glm::vec3 p) const
    {
        return std::ranges::any_of(blocks, [&](const Block& b) {
            return p.x + 16 > b.mins.x && p.x - 16 < b.maxs.x && p.y + 16 > b.mins.y && p.y - 16 < b.maxs.y
                && p.z + 32 > b.mins.z && p.z - 24 < b.maxs.z;
        });
    }
};

// A floor from -256 to 256 with walls around.
Blocks make_room()
{
    Blocks room;
    room.blocks = { { { -300, -300, -64 }, { 300, 300, 0 } }, { { -300, -300, 0 }, { -256, 300, 300 } },
        { { 256, -300, 0 }, { 300, 300, 300 } }, { { -300, -300, 0 }, { 300, -256, 300 } },
        { { -300, 256, 0 }, { 300, 300, 300 } } };
    return room;
}

std::vector<uint32_t> find_way(Navigation& navigation, const Space& space, glm::vec3 from, glm::vec3 to)
{
    const uint32_t start = navigation.find_or_add(space, from);
    while (navigation.grow(space, 1000)) { }
    return navigation.find_path(
        start, 0, [&](uint32_t node) { return glm::distance(navigation.nodes()[node].position, to) < 20; });
}

bool uses(const Navigation& navigation, uint32_t from, const std::vector<uint32_t>& path, Navigation::Way way)
{
    for (const uint32_t node : path) {
        if (const auto* edge = navigation.find_edge(from, node); edge && edge->way == way)
            return true;
        from = node;
    }
    return false;
}

} // namespace

TEST(Navigation, WalksAroundAWall)
{
    Blocks room = make_room();
    room.blocks.push_back({ { -16, -256, 0 }, { 16, 180, 300 } });
    Navigation navigation;
    const auto path = find_way(navigation, room, { -200, -200, 25 }, { 200, -200, 24 });
    ASSERT_FALSE(path.empty());
    float farthest = -1000;
    for (const uint32_t node : path)
        farthest = std::max(farthest, navigation.nodes()[node].position.y);
    EXPECT_GT(farthest, 190) << "through the gap";
    EXPECT_FALSE(navigation.is_straight_walk({ -200, -200, 24 }, { 200, -200, 24 }));
    EXPECT_TRUE(navigation.is_straight_walk({ -200, -200, 24 }, { -200, 200, 24 }));
}

TEST(Navigation, StepsJumpsAndFalls)
{
    Blocks room = make_room();
    room.blocks.push_back({ { 64, -256, 0 }, { 256, 256, 40 } }); // to be jumped on
    Navigation navigation;
    const auto up = find_way(navigation, room, { -200, 0, 25 }, { 200, 0, 64 });
    ASSERT_FALSE(up.empty());
    EXPECT_TRUE(uses(navigation, navigation.find_near({ -200, 0, 25 }), up, Navigation::Way::jump));
    const uint32_t top = up.back();
    const auto down = navigation.find_path(top, 0,
        [&](uint32_t node) { return glm::distance(navigation.nodes()[node].position, glm::vec3(-200, 0, 24)) < 20; });
    EXPECT_TRUE(uses(navigation, top, down, Navigation::Way::fall));

    Blocks high = make_room();
    high.blocks.push_back({ { 64, -256, 0 }, { 256, 256, 70 } }); // too high
    Navigation other;
    EXPECT_TRUE(find_way(other, high, { -200, 0, 25 }, { 200, 0, 94 }).empty());
}

TEST(Navigation, ALiftCarriesWhereNoJumpGoes)
{
    Blocks room = make_room();
    room.blocks.push_back({ { 64, -256, 0 }, { 256, 256, 150 } });
    room.blocks.push_back({ { -16, -40, 0 }, { 63, 40, 4 } }); // at its lowest
    Navigation navigation;
    navigation.set_lifts({ { { -16, -40, 0 }, { 63, 40, 4 }, 146 } });
    const auto path = find_way(navigation, room, { -200, 0, 25 }, { 200, 0, 174 });
    ASSERT_FALSE(path.empty());
    EXPECT_TRUE(uses(navigation, navigation.find_near({ -200, 0, 25 }), path, Navigation::Way::ride));
}

TEST(Navigation, LeavesLavaAlone)
{
    Blocks room = make_room();
    room.lava.push_back({ { -40, -256, -10 }, { 40, 256, 60 } });
    Navigation navigation;
    EXPECT_TRUE(find_way(navigation, room, { -200, 0, 25 }, { 200, 0, 24 }).empty());
}

TEST(Navigation, SwimsAndClimbsOut)
{
    Blocks room = make_room();
    room.blocks[0] = { { -300, -300, -264 }, { 300, 300, -200 } };
    room.blocks.push_back({ { -300, -300, -200 }, { -100, 300, 0 } });
    room.blocks.push_back({ { 100, -300, -200 }, { 300, 300, 0 } });
    for (Block& wall : room.blocks)
        wall.mins.z = std::min(wall.mins.z, -200.0f);
    room.water.push_back({ { -100, -256, -200 }, { 100, 256, -8 } });
    Navigation navigation;
    const auto path = find_way(navigation, room, { -200, 0, 25 }, { 200, 0, 24 });
    ASSERT_FALSE(path.empty());
    EXPECT_TRUE(uses(navigation, navigation.find_near({ -200, 0, 25 }), path, Navigation::Way::swim));
}

TEST(Navigation, BlockedEdgesAreAvoidedForATime)
{
    const Blocks room = make_room();
    Navigation navigation;
    const auto path = find_way(navigation, room, { -200, 0, 25 }, { 200, 0, 24 });
    ASSERT_GT(path.size(), 3u);
    navigation.block(path[0], path[1], 100);
    const uint32_t start = navigation.find_near({ -200, 0, 25 });
    const auto wanted = [&](uint32_t node) { return node == path.back(); };
    EXPECT_NE(navigation.find_path(start, 50, wanted), path);
    EXPECT_EQ(navigation.find_path(start, 100, wanted), path);
}

} // namespace vkpt::game

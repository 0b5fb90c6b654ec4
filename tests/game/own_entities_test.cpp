// SPDX-License-Identifier: GPL-2.0-or-later
// Our entities in a game's array, without an engine.
#include "game/own_entities.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace vkpt::game {

namespace {

int links = 0;

struct Entity : Edict {
    int private_field = 0;
};

class OwnEntitiesTest : public testing::Test {
protected:
    OwnEntitiesTest()
        : array(max_edicts)
    {
        game.edicts = array.data();
        game.edict_size = sizeof(Entity);
        game.edict_count = 60;
        game.max_edicts = max_edicts;
        engine.link_entity = [](Edict*) { links++; };
        links = 0;
    }
    int count_shown() const
    {
        int shown = 0;
        for (const Entity& entity : array)
            shown += entity.in_use;
        return shown;
    }

    std::vector<Entity> array;
    Exports game {};
    Imports engine {};
    OwnEntities own;
};

TEST_F(OwnEntitiesTest, AreThereOnlyWhileTheServerLooks)
{
    const int handle = own.add();
    own.state(handle).skin = 7;
    own.touch(handle, 100);
    EXPECT_EQ(own.show(game, engine), max_edicts);
    EXPECT_EQ(array.back().state.skin, 7);
    EXPECT_EQ(array.back().state.number, max_edicts - 1);
    EXPECT_EQ(links, 1);
    array.back().link_count = 5; // the server's note
    own.hide(game);
    const Entity nothing {};
    EXPECT_EQ(std::memcmp(static_cast<Edict*>(&array.back()), static_cast<const Edict*>(&nothing), sizeof(Edict)), 0);
    own.show(game, engine);
    EXPECT_EQ(array.back().link_count, 5);
    EXPECT_EQ(links, 1) << "only what has moved is linked";
    own.hide(game);
    own.remove(handle);
    EXPECT_EQ(own.show(game, engine), game.edict_count);
    EXPECT_EQ(count_shown(), 0);
}

TEST_F(OwnEntitiesTest, TheGameMayUseEverySlot)
{
    for (int i = 0; i < 10; i++)
        own.add();
    game.edict_count = max_edicts - 4;
    own.show(game, engine);
    EXPECT_EQ(count_shown(), 4);
    EXPECT_EQ(own.without_slot(), 6);
    own.hide(game);
    game.edict_count = max_edicts;
    EXPECT_EQ(own.show(game, engine), max_edicts);
    EXPECT_EQ(count_shown(), 0);
    EXPECT_EQ(own.without_slot(), 10);
}

TEST_F(OwnEntitiesTest, ComeAFewAFrame)
{
    for (int i = 0; i < 3 * OwnEntities::max_new_per_frame; i++)
        own.add();
    for (int frame = 1; frame <= 3; frame++) {
        own.begin_frame();
        for (int call = 0; call < 3; call++) {
            own.show(game, engine);
            EXPECT_EQ(count_shown(), frame * OwnEntities::max_new_per_frame);
            own.hide(game);
        }
    }
}

// Each is sent as a new one every few frames, in a slot that has rested.
TEST_F(OwnEntitiesTest, AllAreRenewedInTurn)
{
    constexpr int count = 8;
    std::vector<int> last_used(max_edicts, -100), renewals(count, 0);
    for (int i = 0; i < count; i++)
        own.state(own.add()).skin = i + 1;
    std::vector<int> slot_of(count, -1);
    for (int frame = 0; frame < 12; frame++) {
        own.begin_frame();
        own.show(game, engine);
        EXPECT_EQ(count_shown(), count);
        for (int slot = 0; slot < max_edicts; slot++) {
            if (!array[size_t(slot)].in_use)
                continue;
            const size_t light = size_t(array[size_t(slot)].state.skin) - 1;
            if (slot_of[light] != slot) {
                EXPECT_LT(last_used[size_t(slot)], frame - 4);
                renewals[light] += frame > 0;
            }
            slot_of[light] = slot;
            last_used[size_t(slot)] = frame;
        }
        own.hide(game);
    }
    for (const int number : renewals)
        EXPECT_GE(number, 3) << "in 12 frames";
}

TEST_F(OwnEntitiesTest, ThereIsAnEndOfThem)
{
    for (int i = 0; i < OwnEntities::most; i++)
        EXPECT_GE(own.add(), 0);
    EXPECT_EQ(own.add(), -1);
}

} // namespace

} // namespace vkpt::game

// SPDX-License-Identifier: GPL-2.0-or-later
// Reading the source: what is wrong with it is told with file and line.
#include "tests/map_compiler/map_text.hpp"
#include "tests/map_compiler/texture_folder.hpp"
#include "tools/map_compiler/compiler.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {

using namespace formats;
using namespace tools;

namespace {

std::string failure(const std::string& text)
{
    try {
        compile_map(text, "broken.map", {});
    } catch (const MapError& error) {
        return error.what();
    }
    return "no error";
}

struct Broken {
    const char *name, *text, *message; // what the message must begin with
    const char* mention;
};

class BrokenSource : public testing::TestWithParam<Broken> { };

TEST_P(BrokenSource, IsToldWithFileAndLine)
{
    const std::string message = failure(GetParam().text);
    EXPECT_TRUE(message.starts_with(GetParam().message)) << message;
    EXPECT_NE(message.find(GetParam().mention), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(All, BrokenSource,
    testing::Values(Broken { "empty", "// nothing\n", "broken.map:2: ", "worldspawn" },
        Broken { "stray", "{\n\"classname\" \"worldspawn\"\n}\n}\n", "broken.map:4: ", "}" },
        Broken { "unclosed_entity", "\n{\n\"classname\" \"worldspawn\"\n", "broken.map:2: ", "not closed" },
        Broken { "unclosed_brush", "{\n\"classname\" \"worldspawn\"\n{\n", "broken.map:3: ", "not closed" },
        Broken { "unclosed_quote", "{\n\"classname\" \"worldspawn\n}\n", "broken.map:2: ", "quote" },
        Broken { "no_value", "{\n\"classname\"\n}\n", "broken.map:3: ", "no quoted value" },
        Broken { "not_a_number",
            "{\n\"classname\" \"worldspawn\"\n{\n( 0 0 x ) ( 0 1 0 ) ( 1 0 0 ) t 0 0 0 1 1\n}\n}\n",
            "broken.map:4: ", "'x'" },
        Broken { "missing_bracket",
            "{\n\"classname\" \"worldspawn\"\n{\n( 0 0 0 ( 0 1 0 ) ( 1 0 0 ) t 0 0 0 1 1\n}\n}\n",
            "broken.map:4: ", "')'" },
        Broken { "few_sides", "{\n\"classname\" \"worldspawn\"\n{\n( 0 0 0 ) ( 0 1 0 ) ( 1 0 0 ) t 0 0 0 1 1\n}\n}\n",
            "broken.map:3: ", "4 sides" },
        Broken { "line_for_plane",
            "{\n\"classname\" \"worldspawn\"\n{\n( 0 0 0 ) ( 0 1 0 ) ( 0 2 0 ) t 0 0 0 1 1\n( 0 0 0 ) ( 0 1 0 ) ( 0 2 "
            "0 ) t 0 0 0 1 1\n"
            "( 0 0 0 ) ( 0 1 0 ) ( 0 2 0 ) t 0 0 0 1 1\n( 0 0 0 ) ( 0 1 0 ) ( 0 2 0 ) t 0 0 0 1 1\n}\n}\n",
            "broken.map:4: ", "one line" },
        Broken { "wrong_first", "{\n\"classname\" \"light\"\n}\n", "broken.map:1: ", "worldspawn" },
        Broken { "no_brushes", "{\n\"classname\" \"worldspawn\"\n}\n", "broken.map:1: ", "no brushes" },
        Broken {
            "primitive", "{\n\"classname\" \"worldspawn\"\n{\nbrushDef\n{\n}\n}\n}\n", "broken.map:4: ", "Quake II" }),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Source, InsideOutBrushIsRejected)
{
    std::string brush = box_brush({ { 0, 0, 0 }, { 64, 64, 64 } }, "wall");
    const std::string good = "( 0 0 64 ) ( 0 64 64 ) ( 64 0 64 )", flipped = "( 0 0 -64 ) ( 0 64 -64 ) ( 64 0 -64 )";
    brush.replace(brush.find(good), good.size(), flipped);
    const std::string message = failure(entity_text({ { "classname", "worldspawn" } }, brush));
    EXPECT_TRUE(message.starts_with("broken.map:3: ")) << message;
}

TEST(Source, LeakNamesTheEntityAndGivesAWay)
{
    try {
        compile_map(open_room_text(), "leak.map", {});
        FAIL() << "no leak found";
    } catch (const LeakError& leak) {
        EXPECT_NE(std::string(leak.what()).find("info_player_start"), std::string::npos) << leak.what();
        EXPECT_TRUE(std::string(leak.what()).starts_with("leak.map:")) << leak.what();
        ASSERT_GE(leak.points().size(), 2u);
        EXPECT_EQ(leak.points().back(), dvec3(0, 0, 24));
    }
}

// Entities stand exactly on floors: there the room begins, not the solid.
TEST(Source, AnEntityOnTheFloorIsInside)
{
    const Box room { { -64, -64, 0 }, { 64, 64, 128 } };
    const auto map = [](const std::string& brushes) {
        return entity_text({ { "classname", "worldspawn" } }, brushes)
            + entity_text({ { "classname", "info_player_start" }, { "origin", "0 0 0" } });
    };
    EXPECT_EQ(failure(map(walls_around({ room }, "wall"))), "no error");
    const std::string floor = box_brush({ { -64, -64, -16 }, { 64, 64, 0 } }, "floor");
    EXPECT_THROW(compile_map(map(floor), "leak.map", {}), LeakError);
    // What is out of every entity's reach is filled.
    const Bsp bsp = compile_map(map(walls_around({ room, { { 256, 0, 0 }, { 320, 64, 64 } } }, "wall")), "two.map", {});
    EXPECT_FALSE(bsp.leaves[bsp.find_leaf({ 0, 0, 64 })].contents & CONTENTS_SOLID);
    EXPECT_TRUE(bsp.leaves[bsp.find_leaf({ 288, 32, 32 })].contents & CONTENTS_SOLID);
}

TEST(Textures, WalFlagsAndAnimationsAreTakenAndTheMapOverrides)
{
    const TextureFolder folder;
    folder.add({ .name = "lamp1", .next_animation = "lamp2", .flags = SURF_LIGHT, .value = 300 }, 1);
    folder.add({ .name = "lamp2", .next_animation = "lamp1", .flags = SURF_LIGHT, .value = 300 }, 1);
    folder.add({ .name = "pond", .flags = SURF_WARP, .contents = CONTENTS_SLIME }, 2);
    folder.add({ .name = "wall" }, 2);
    const std::string text
        = entity_text({ { "classname", "worldspawn" } },
              walls_around({ two_rooms::room_a }, "wall") + box_brush({ { 0, 0, 64 }, { 32, 32, 80 } }, "lamp1")
                  + box_brush({ { 100, 0, 64 }, { 132, 32, 80 } }, "lamp1", " 0 1 77")
                  + box_brush({ { -100, -100, 0 }, { -50, -50, 50 } }, "pond")
                  + box_brush({ { 100, 100, 0 }, { 132, 132, 50 } }, "nowhere"))
        + entity_text({ { "classname", "info_player_start" }, { "origin", "200 200 24" } });
    std::vector<std::string> warnings;
    CompileOptions options;
    options.textures = folder.textures();
    options.warn = [&](const std::string& warning) { warnings.push_back(warning); };
    const Bsp bsp = compile_map(text, "t.map", options);
    int plain = 0, own = 0;
    for (const BspTexinfo& info : bsp.texinfos) {
        if (info.texture != "lamp1")
            continue;
        EXPECT_EQ(info.flags, uint32_t(SURF_LIGHT));
        (info.value == 300 ? plain : own)++;
        ASSERT_GE(info.next, 0);
        const BspTexinfo& next = bsp.texinfos[size_t(info.next)];
        EXPECT_EQ(next.texture, "lamp2");
        EXPECT_EQ(bsp.texinfos[size_t(next.next)].texture, "lamp1");
    }
    EXPECT_GT(plain, 0);
    EXPECT_GT(own, 0);
    EXPECT_TRUE(bsp.leaves[bsp.find_leaf({ -75, -75, 25 })].contents & CONTENTS_SLIME);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("nowhere"), std::string::npos);
}

} // namespace

} // namespace vkpt::tests

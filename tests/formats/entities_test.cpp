// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/byte_reader.hpp"
#include "formats/entities.hpp"

#include <gtest/gtest.h>

namespace formats {

namespace {

TEST(Entities, ReadsPairsCommentsAndBareWords)
{
    const auto entities = parse_entities("// made by hand\n{ \"classname\" \"light\" \"light\" \"300\" // bright\n }\n"
                                         "{ classname info_null \"message\" \"a } b // c\" }",
        "sample");
    ASSERT_EQ(entities.size(), 2u);
    EXPECT_EQ(entities[0].class_name(), "light");
    EXPECT_EQ(entities[0].number("light", 0), 300);
    EXPECT_EQ(entities[1].class_name(), "info_null");
    EXPECT_EQ(entities[1].get("message"), "a } b // c");
    EXPECT_EQ(entities[1].get("absent", "fallback"), "fallback");
}

TEST(Entities, TheLastOfEqualKeysCounts)
{
    const auto entities = parse_entities("{ \"a\" \"1\" \"a\" \"2\" }", "sample");
    EXPECT_EQ(entities.at(0).get("a"), "2");
}

TEST(Entities, SkipsTheBrushesOfMapSources)
{
    const auto entities = parse_entities(
        "{ \"classname\" \"worldspawn\" { ( 0 0 0 ) ( 1 0 0 ) { nested } a/b 0 0 } \"sky\" \"x\" } {}", "m");
    ASSERT_EQ(entities.size(), 2u);
    EXPECT_EQ(entities[0].get("sky"), "x");
    EXPECT_TRUE(entities[1].pairs.empty());
}

TEST(Entities, NumbersAndVectors)
{
    const EntityText e = parse_entities(
        "{ a \" -1.5e2 \" b \"12x\" c \"nan\" d \"+7\" e \"\" v \"1 -2.5 .5\" w \"1 2\" x \"1 2 z\" y \"1 2 3 4\" z "
        "\"1e99 0 0\" }",
        "sample")
                             .at(0);
    EXPECT_EQ(e.number("a", 9), -150);
    for (const char* key : { "b", "c", "e", "absent" })
        EXPECT_EQ(e.number(key, 9), 9) << key;
    EXPECT_EQ(e.number("d", 9), 7);
    EXPECT_EQ(e.vector("v"), glm::vec3(1, -2.5f, 0.5f));
    EXPECT_EQ(e.vector("y"), glm::vec3(1, 2, 3));
    for (const char* key : { "w", "x", "z", "e", "absent" })
        EXPECT_FALSE(e.vector(key)) << key;
}

TEST(Entities, RefusesWhatIsNotClosed)
{
    const auto offset_of_error = [](std::string_view text) -> size_t {
        try {
            parse_entities(text, "sample");
        } catch (const FormatError& error) {
            return error.offset();
        }
        return SIZE_MAX;
    };
    EXPECT_EQ(offset_of_error("{ \"a\" \"b }"), 6u);
    EXPECT_EQ(offset_of_error("{} { \"a\" \"b\" "), 3u);
    EXPECT_EQ(offset_of_error("{ \"a\" }"), 2u);
    EXPECT_EQ(offset_of_error("{ { "), 2u);
    EXPECT_EQ(offset_of_error("{} stray"), 3u);
    EXPECT_EQ(offset_of_error("{}"), SIZE_MAX);
    EXPECT_EQ(offset_of_error(""), SIZE_MAX);
}

} // namespace

} // namespace formats

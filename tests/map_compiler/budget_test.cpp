// SPDX-License-Identifier: GPL-2.0-or-later
// Small sources that ask for endless work are refused, with the line.
#include "tests/formats/file_budget.hpp"
#include "tests/map_compiler/map_text.hpp"
#include "tools/map_compiler/compiler.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace vkpt::tests {

namespace {

Cost expect_cheap(const std::string& text, const std::string& name)
{
    EXPECT_LT(text.size(), small_file_bytes) << name;
    return expect_within_budget(name, [&] {
        tools::CompileOptions options;
        options.light = false;
        options.threads = 1;
        options.warn = [](const std::string&) {};
        options.progress = [](const std::string&) {};
        tools::compile_map(text, name, options);
    });
}

void expect_refused(const std::string& text, const std::string& name, const std::string& reason)
{
    const Cost cost = expect_cheap(text, name);
    EXPECT_TRUE(cost.outcome.starts_with("refused: " + name + ":")) << cost.outcome;
    EXPECT_NE(cost.outcome.find(reason), std::string::npos) << cost.outcome;
}

// A solid box, the light within it, whose sides all end so: after the texture's name come shifts, rotation and scales.
std::string box_map(const std::string& placement)
{
    std::string brush = box_brush({ { -4000, -4000, -4000 }, { 4000, 4000, 4000 } }, "wall");
    const std::string plain = "wall 0 0 0 1 1";
    for (size_t at = 0; (at = brush.find(plain, at)) != std::string::npos;)
        brush.replace(at, plain.size(), "wall " + placement);
    return entity_text({ { "classname", "worldspawn" } }, brush)
        + entity_text({ { "classname", "light" }, { "origin", "0 0 0" } });
}

TEST(MapBudget, BadSourcesEnd)
{
    for (const auto& path : files_in(VKPT_BAD_FILES, ".map")) {
        const auto bytes = file_bytes(path);
        expect_cheap({ reinterpret_cast<const char*>(bytes.data()), bytes.size() }, path.filename().string());
    }
}

TEST(MapBudget, EndlessTexturePlacementsAreRefusedWithTheirLine)
{
    expect_refused(box_map("1e20 0 0 1 1"), "shift.map", "shifted");
    expect_refused(box_map("0 0 0 1e-9 1"), "scale.map", "scaled");
    expect_refused(box_map("0 0 0 1e-300 1"), "scale.map", "scaled");
    expect_refused(box_map("0 0 0 .002 .002"), "pieces.map", "lightmaps");
    expect_refused(box_map("0 0 0 .004 1"), "narrow.map", "texture");
}

TEST(MapBudget, OrdinaryPlacementsAreNot)
{
    EXPECT_EQ(expect_cheap(two_rooms::text(), "rooms.map").outcome, "read");
    EXPECT_FALSE(expect_cheap(box_map("1000 -50000 45 .5 16"), "large.map").refused());
}

TEST(MapBudget, ManySidesAndKeysAreRefused)
{
    std::vector<glm::ivec2> circle;
    for (int i = 0; i < 3000; i++)
        circle.emplace_back(i, i * i / 1000);
    expect_refused(
        entity_text({ { "classname", "worldspawn" } }, prism_brush(circle, 0, 64, "wall")), "sides.map", "sides");
    Pairs pairs { { "classname", "worldspawn" } };
    for (int i = 0; i < 60000; i++)
        pairs.emplace_back(fmt::format("{}", i), "");
    expect_refused(entity_text(pairs), "keys.map", "keys");
}

TEST(MapBudget, DeepNestingIsRefused)
{
    expect_refused(std::string(900000, '{'), "nested.map", "{");
    std::string text;
    for (int i = 0; i < 300000; i++)
        text += "{ ";
    expect_refused("{\n\"classname\" \"worldspawn\"\n" + text, "braces.map", "(");
}

} // namespace

} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/material_file.hpp"

#include <gtest/gtest.h>

namespace {

using namespace formats;

using Attributes = std::vector<std::pair<std::string, std::string>>;

TEST(MaterialFile, ReadsNamesAndAttributes)
{
    const MaterialFile file = read_materials("# metal\n"
                                             "textures/e1u1/Metal5_4.wal,\n"
                                             "e1u1/metal5_5, models\\x\\skin.pcx:\r\n"
                                             "\troughness_override 0.25 # shiny\n"
                                             "\ttexture_normals overrides/metal_n.tga\n"
                                             "\n"
                                             "e1u1/floor:\n"
                                             "    kind CHROME\n",
        "materials/test.mat");
    EXPECT_TRUE(file.messages.empty());
    ASSERT_EQ(file.entries.size(), 2u);
    EXPECT_EQ(file.entries[0].names, (std::vector<std::string> { "e1u1/metal5_4", "e1u1/metal5_5", "models/x/skin" }));
    EXPECT_EQ(file.entries[0].attributes,
        (Attributes { { "roughness_override", "0.25" }, { "texture_normals", "overrides/metal_n.tga" } }));
    EXPECT_EQ(file.entries[1].attributes, (Attributes { { "kind", "CHROME" } }));
}

// What is wrong is named with its line, and the rest counts.
TEST(MaterialFile, LeavesOutWhatMakesNoSense)
{
    const MaterialFile file = read_materials("bump_scale 1\n"
                                             "a/b:\n"
                                             "bump_scale steep\n"
                                             "bump_scale inf\n"
                                             "shininess 3\n"
                                             "bump_scale\n"
                                             "bump_scale 2\n"
                                             ":\n"
                                             "bump_scale 3\n"
                                             "c/d\n"
                                             "e/f,\n"
                                             "bump_scale 4\n",
        "m.mat");
    ASSERT_EQ(file.entries.size(), 1u);
    EXPECT_EQ(file.entries[0].attributes, (Attributes { { "bump_scale", "2" } }));
    ASSERT_EQ(file.messages.size(), 10u);
    const char* lines[] = { "line 1:", "line 3:", "line 4:", "line 5:", "line 6:", "line 8:", "line 9:", "line 10:" };
    for (size_t i = 0; i < std::size(lines); i++)
        EXPECT_NE(file.messages[i].find(std::string("m.mat, ") + lines[i]), std::string::npos) << file.messages[i];
    EXPECT_NE(file.messages.back().find("no colon"), std::string::npos);
}

TEST(MaterialFile, CountsWhatHasNoEffect)
{
    const MaterialFile file = read_materials("a/b:\n"
                                             "is_light 1\n"
                                             "kind screen\n"
                                             "bump_scale 2\n"
                                             "c/d:\n"
                                             "is_light 1\n"
                                             "kind Transparent\n"
                                             "kind stone\n"
                                             "kind wood\n",
        "m.mat");
    EXPECT_TRUE(file.messages.empty());
    EXPECT_EQ(file.without_effect,
        "m.mat: attributes without effect in this renderer (6): is_light 2, kind SCREEN 1, kind TRANSPARENT 1, "
        "kind of other names 2");
    EXPECT_EQ(file.entries[0].attributes.size(), 3u) << "they are kept";
    EXPECT_EQ(read_materials("a:\nkind glass\nkind Water\nkind REGULAR\nbase_factor 1\n", "m.mat").without_effect, "");
}

TEST(MaterialFile, WritesWhatItReads)
{
    const std::string text = "a/b,\nc/d:\n    bump_scale 0.5\n    kind CHROME\n\ne/f:\n    is_light 1\n\n";
    EXPECT_EQ(write_materials(read_materials(text, "m.mat").entries), text);
}

TEST(MaterialFile, HasLimits)
{
    EXPECT_THROW(read_materials(std::string(max_material_bytes + 1, '\n'), "m.mat"), FormatError);
    std::string names;
    for (size_t i = 0; i <= max_material_names; i++)
        names += "a,\n";
    EXPECT_THROW(read_materials(names, "m.mat"), FormatError);
    std::string nonsense;
    for (int i = 0; i < 1000; i++)
        nonsense += "what is this\n";
    EXPECT_EQ(read_materials(nonsense, "m.mat").messages.size(), MaterialFile::max_messages);
}

TEST(MaterialFile, EveryAttributeIsOnceInTheTable)
{
    for (const AttributeRow& row : material_attributes()) {
        EXPECT_EQ(find_attribute(row.name), &row);
        EXPECT_TRUE(is_attribute_value(row, "1"));
    }
    EXPECT_EQ(find_attribute("shininess"), nullptr);
}

} // namespace

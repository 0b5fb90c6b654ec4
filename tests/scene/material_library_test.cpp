// SPDX-License-Identifier: GPL-2.0-or-later
// What files of materials come to.
#include "ref_vkpt/scene/material_guess.hpp"
#include "ref_vkpt/scene/material_library.hpp"
#include "ref_vkpt/scene/world.hpp"

#include <gtest/gtest.h>

namespace vkpt::test {
namespace {

MaterialSettings settings_of(std::string_view name, const std::string& attributes)
{
    MaterialLibrary library;
    library.add(formats::read_materials(std::string(name) + ":\n" + attributes + '\n', "test.mat"));
    const MaterialSettings* found = library.find(formats::material_name(name));
    return found ? *found : MaterialSettings();
}

TEST(MaterialLibrary, PutsNamesInPlaceOfAsterisks)
{
    constexpr const char* wall = "textures/e1u2/wslt1_5";
    EXPECT_EQ(settings_of(wall, "texture_normals overrides/*_n.tga").normals_file, "overrides/wslt1_5_n.tga");
    EXPECT_EQ(settings_of(wall, "texture_base hd/**.tga").base_file, "hd/textures/e1u2/wslt1_5.tga");
    EXPECT_EQ(settings_of("e1u2/wslt1_5", "texture_mask **_m").mask_file, "textures/e1u2/wslt1_5_m");
    EXPECT_EQ(settings_of(wall, "texture_emissive */*_light").emissive_file, "wslt1_5/*_light") << "the first one only";
    EXPECT_EQ(settings_of("models/x/skin.pcx", "texture_base hd/**").base_file, "hd/models/x/skin");
    EXPECT_EQ(settings_of("players/male/grunt.pcx", "texture_base hd/*").base_file, "hd/grunt");
    EXPECT_EQ(settings_of("floor", "texture_base hd/*").base_file, "hd/floor");
}

TEST(MaterialLibrary, TakesNamesOfEach)
{
    MaterialLibrary library;
    library.add(formats::read_materials("a/x,\na/y:\n    texture_base hd/*\n", "test.mat"));
    library.edit("a/y", "texture_base", "mine/*");
    EXPECT_EQ(library.find("a/x")->base_file, "hd/x");
    EXPECT_EQ(library.find("a/y")->base_file, "mine/y");
}

TEST(MaterialLibrary, KnowsWhoSaysSo)
{
    MaterialLibrary library;
    library.add(formats::read_materials("a:\n    bump_scale 2\na:\n    bump_scale 3\n", "materials/baseq2.mat"));
    library.add(formats::read_materials("b:\n    bump_scale 2\n", "materials/mod.mat"));
    library.add(formats::read_materials("a:\n    kind chrome\n", "maps/m.mat"));
    library.edit("a", "base_factor", "2");
    EXPECT_EQ(library.find("a")->sources, (std::vector<std::string> { "materials/baseq2.mat", "maps/m.mat" }));
    EXPECT_TRUE(library.find("a")->is_edited);
    EXPECT_FALSE(library.find("b")->is_edited);
    library.edit("a", "base_factor", "");
    EXPECT_FALSE(library.find("a")->is_edited);
    library.forget_files();
    library.add(formats::read_materials("a:\n    bump_scale 2\n", "maps/n.mat"));
    EXPECT_EQ(library.find("a")->sources, (std::vector<std::string> { "maps/n.mat" }));
}

TEST(MaterialLibrary, ZeroIsNoFile)
{
    const MaterialSettings none
        = settings_of("a", "texture_base 0\n    texture_mask 0\n    texture_normals 0\n    texture_emissive 0");
    EXPECT_TRUE(none.base_file.empty());
    EXPECT_TRUE(none.mask_file.empty());
    EXPECT_EQ(none.normals_file, "");
    EXPECT_EQ(none.emissive_file, "");
    const MaterialSettings unsaid = settings_of("a", "bump_scale 1");
    EXPECT_FALSE(unsaid.normals_file);
    EXPECT_FALSE(unsaid.emissive_file);
}

TEST(MaterialLibrary, KindsAreComparedWithoutCase)
{
    for (const char* kind : { "kind CHROME", "kind chrome", "kind Chrome" }) {
        EXPECT_EQ(settings_of("a", kind).roughness, 0) << kind;
        EXPECT_EQ(settings_of("a", kind).metalness, 1) << kind;
    }
    EXPECT_TRUE(settings_of("a", "kind camera").is_screen);
}

TEST(MaterialLibrary, KindsOfLiquids)
{
    EXPECT_EQ(settings_of("a", "kind water").medium, shared::MEDIUM_WATER);
    EXPECT_EQ(settings_of("a", "kind SLIME").medium, shared::MEDIUM_SLIME);
    EXPECT_EQ(settings_of("a", "kind Lava").medium, shared::MEDIUM_LAVA);
    EXPECT_EQ(settings_of("a", "kind GLASS").medium, shared::MEDIUM_NONE);
}

// Only what the map makes a pane; the same texture may be on walls.
TEST(MaterialLibrary, GlassMakesPanesSmooth)
{
    const auto roughness = [](const std::string& attributes, uint32_t flags) {
        MaterialLibrary materials;
        materials.add(formats::read_materials("a:\n" + attributes + '\n', "test.mat"));
        const MaterialDefaults defaults { .materials = &materials };
        SurfaceGuess surface = guess_surface("a", defaults);
        apply_material(surface, defaults.find("a"));
        shared::Material material {};
        material.flags = flags;
        set_surface(material, surface, {}, defaults);
        return material.roughness;
    };
    EXPECT_EQ(roughness("kind glass", shared::MATERIAL_GLASS), 0.1f);
    EXPECT_EQ(roughness("kind glass", 0), MaterialDefaults().roughness);
    EXPECT_EQ(roughness("bump_scale 1", shared::MATERIAL_GLASS), MaterialDefaults().roughness);
    EXPECT_EQ(roughness("kind glass\n    roughness_override 0.5", shared::MATERIAL_GLASS), 0.5f);
}

} // namespace
} // namespace vkpt::test

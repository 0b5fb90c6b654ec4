// SPDX-License-Identifier: GPL-2.0-or-later
// Files of materials, and the command that edits them.
#include "common/colour.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace vkpt::tests {
namespace {

const CvarList matte_full { { "pt_bounces", "0" }, { "pt_roughness_default", "1" }, { "pt_light_sampler", "full" } };

class Materials : public testing::Test {
protected:
    // A white floor under the sky of one colour.
    Materials()
    {
        Session::end_idle(); // edits last as long as the module
        folder_.add_wall("test/floor", white_index);
        MapBuilder map;
        map.add_room({ -512, -512, -1 }, { 512, 512, 511 }, map.add_material("sky", formats::SURF_SKY));
        map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("test/floor"));
        folder_.add_map("floor", map.finish());
    }
    ~Materials() override { Session::end_idle(); }

    // Radiance of the floor.
    static double see_floor(Session& session)
    {
        session.look({ 0, 0, 40 }, { 1, 0, 0 }, 60);
        session.draw();
        return double(session.accumulate(64).mean().y);
    }
    static double find_roughness(Session& session)
    {
        session.set("pt_debug_view", "roughness");
        session.look({ 0, 0, 40 }, { 1, 0, 0 }, 60);
        session.draw();
        const double shown = double(session.capture_display().at(32, 24).r) / 255;
        session.set("pt_debug_view", "off");
        return decode_srgb(shown); // it is shown sRGB-encoded
    }

    GameFolder folder_;
};

TEST_F(Materials, ComeFromFiles)
{
    double plain = 0;
    {
        Session session(folder_, matte_full);
        session.load_map("floor");
        plain = see_floor(session);
    }
    folder_.add_text("materials/baseq2.mat",
        "textures/test/floor:\n    base_factor 0.5\n    roughness_override 0.4\n    shine 3\n    is_light 1\n");
    {
        Session session(folder_, matte_full);
        session.load_map("floor");
        EXPECT_TRUE(session.has_line("materials/baseq2.mat, line 4"));
        EXPECT_TRUE(
            session.has_line("materials/baseq2.mat: attributes without effect in this renderer (1): is_light 1"));
        EXPECT_NEAR(find_roughness(session), 0.4, 0.01);
        session.set("pt_roughness_default", 0.9); // of what no file speaks
        EXPECT_NEAR(find_roughness(session), 0.4, 0.01);
    }
    // The map's own goes before the game's.
    folder_.add_text("maps/floor.mat", "test/floor:\n    roughness_override 1\n");
    Session session(folder_, matte_full);
    session.load_map("floor");
    EXPECT_NEAR(see_floor(session) / plain, 0.5, 0.01);
}

TEST_F(Materials, AreEditedUnderTheCrosshair)
{
    Session session(folder_, matte_full);
    session.load_map("floor");
    const double plain = see_floor(session);
    session.host().run_text("mat\n");
    EXPECT_TRUE(session.has_line("test/floor: roughness 1.00"));
    session.host().run_text("mat base_factor 0.25\n");
    EXPECT_NEAR(see_floor(session) / plain, 0.25, 0.01);
    session.host().run_text("mat base_factor bright\n");
    EXPECT_TRUE(session.has_line("says nothing of a material"));
    session.host().run_text("mat reset\n");
    EXPECT_NEAR(see_floor(session) / plain, 1, 0.01);
}

// Of a black floor only the coat reflects.
TEST_F(Materials, ScaleTheCoat)
{
    Session session(folder_, matte_full);
    session.load_map("floor");
    see_floor(session);
    session.host().run_text("mat base_factor 0\nmat roughness_override 0.3\n");
    const double whole = see_floor(session);
    EXPECT_GT(whole, 0.03);
    session.host().run_text("mat specular_factor 0.5\n");
    EXPECT_NEAR(see_floor(session) / whole, 0.5, 0.02); // in steps of 1 / 31
    session.host().run_text("mat\n");
    EXPECT_TRUE(session.has_line("specular 0.48"));
    session.host().run_text("mat specular_factor 0\n");
    EXPECT_LT(see_floor(session), 1e-4);
}

// A board over the floor and a model: with kinds of walls that show the sky or are not there, and skins that are not.
TEST_F(Materials, MakeSkyAndNothing)
{
    folder_.add_wall("test/board", 0);
    MapBuilder map;
    map.add_room({ -512, -512, -1 }, { 512, 512, 511 }, map.add_material("sky", formats::SURF_SKY));
    map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("test/floor"));
    map.add(rectangle({ 0, 0, 20 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("test/board"));
    map.add(rectangle({ 0, 0, 20 }, { 0, 64, 0 }, { 64, 0, 0 }), map.add_material("test/board"));
    folder_.add_map("board", map.finish());
    const std::string cube = folder_.add_cube("cube", 8, 0);
    struct Seen {
        double board, floor; // radiance
    };
    const auto see = [&](const char* materials) {
        Session::end_idle();
        folder_.add_text("materials/baseq2.mat", materials);
        Session session(folder_, matte_full);
        session.load_map("board");
        engine::Entity entity = make_entity(session.module().register_model(cube.c_str()), { 0, 0, 60 });
        session.view.entities = &entity;
        session.view.entity_count = 1;
        const auto look = [&](glm::vec3 eye, glm::vec3 at) {
            session.look(eye, at, 20);
            session.draw();
            return double(session.accumulate(64).mean().y);
        };
        return Seen { look({ 0, 1, 100 }, { 0, 0, 0 }), look({ 0, 1, 10 }, { 0, 0, 0 }) };
    };
    const Seen covered = see("x:\n    base_factor 1\n");
    EXPECT_LT(covered.board, 0.01); // a black cube
    const Seen without_cube = see("models/cube:\n    kind invisible\n");
    EXPECT_LT(without_cube.board, 0.01); // a black board
    const Seen bare = see("models/cube,\ntest/board:\n    kind invisible\n");
    EXPECT_NEAR(bare.board, bare.floor, 0.02 * bare.floor);
    EXPECT_GT(bare.floor, 1.5 * covered.floor);
    const Seen sky = see("models/cube:\n    kind invisible\ntest/board:\n    kind sky\n");
    EXPECT_GT(sky.board, 0.5);
    EXPECT_NEAR(sky.floor, bare.floor, 0.02 * bare.floor); // the sky lights as the one behind it does
}

// A lift and a model in front of the floor, and what `mat` finds where each is.
TEST_F(Materials, AreFoundOnBrushModelsAndModels)
{
    folder_.add_wall("test/lift", 100);
    folder_.add_wall("test/glass", 100);
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 512, 0, 0 }, { 0, 512, 0 }), map.add_material("test/floor"));
    map.add(
        rectangle({ 300, 0, 20 }, { 16, 0, 0 }, { 0, 16, 0 }), map.add_material("test/glass", formats::SURF_TRANS33));
    map.begin_brush_model();
    map.add_block({ -16, -16, 0 }, { 16, 16, 16 }, map.add_material("test/lift"));
    folder_.add_map("lift", map.finish());
    const std::string cube = folder_.add_cube("cube", 8, red_index);
    Session session(folder_, matte_full);
    session.load_map("lift");
    void* const lift = session.module().register_model("*1");
    void* const model = session.module().register_model(cube.c_str());
    std::vector<engine::Entity> entities { make_entity(lift, { 100, 0, 0 }), make_entity(model, { 200, 0, 10 }),
        make_entity(model, { -100, 0, 10 }, engine::RF_WEAPONMODEL),
        make_entity(lift, { -200, 0, 0 }, engine::RF_TRANSLUCENT) };
    session.view.entities = entities.data();
    session.view.entity_count = int32_t(entities.size());
    const auto find_at = [&](float x) {
        session.look({ x, 0, 60 }, { x + 1, 0, 0 }, 60);
        session.draw();
        const size_t before = session.lines().size();
        session.host().run_text("mat\n");
        return session.lines().size() > before ? session.lines()[before].substr(0, session.lines()[before].find(':'))
                                               : "";
    };
    EXPECT_EQ(find_at(0), "test/floor");
    EXPECT_EQ(find_at(100), "test/lift");
    EXPECT_EQ(find_at(300), "test/glass");
    EXPECT_EQ(find_at(-200), "test/lift") << "made translucent";
    EXPECT_EQ(find_at(-100), "test/floor") << "behind the player's weapon";
    const std::string skin = find_at(200);
    EXPECT_NE(skin.find("cube"), std::string::npos) << skin;
    session.host().run_text("mat roughness_override 0.25\n");
    EXPECT_TRUE(session.has_line(skin + ": roughness_override 0.25"));
    find_at(200);
    EXPECT_TRUE(session.has_line(skin + ": roughness 0.25"));
    session.host().run_text("mat emissive_factor 2\n");
    EXPECT_TRUE(session.has_line(skin + ": emissive_factor 2; `mat save` keeps it")) << "of a skin, at once";
    session.host().run_text("mat reset\n");
    session.look({ 0, 0, 60 }, { 0, 0, 1000 }, 60);
    session.draw();
    session.host().run_text("mat\n");
    EXPECT_TRUE(session.has_line("no surface of the map or of a model"));
}

// The panel of pt_show_material has the same lines.
TEST_F(Materials, AreDescribed)
{
    folder_.add_wall("test/pane", 100);
    folder_.add_wall("test/lamp", white_index);
    folder_.add(
        "test/bumps.png", formats::write_png({ 16, 16, std::vector<formats::Rgba8>(256, { 128, 128, 255, 255 }) }));
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 32, 0, 0 }, { 0, 32, 0 }), map.add_material("test/floor"));
    map.add(rectangle({ 100, 0, 0 }, { 32, 0, 0 }, { 0, 32, 0 }), map.add_material("test/pane", formats::SURF_TRANS33));
    map.add(
        rectangle({ 200, 0, 0 }, { 32, 0, 0 }, { 0, 32, 0 }), map.add_material("test/lamp", formats::SURF_LIGHT, 200));
    folder_.add_map("three", map.finish());
    folder_.add_text(
        "materials/baseq2.mat", "test/pane:\n    kind glass\ntest/floor:\n    texture_normals test/bumps\n");
    folder_.add_text("maps/three.mat", "test/pane:\n    base_factor 0.5\n");
    Session session(folder_, matte_full);
    session.load_map("three");
    const auto describe_at = [&](float x) {
        session.look({ x, 0, 60 }, { x + 1, 0, 0 }, 60);
        session.draw();
        const size_t before = session.lines().size();
        session.host().run_text("mat\n");
        std::string text;
        for (size_t i = before; i < session.lines().size(); i++)
            text += session.lines()[i];
        return text;
    };
    const auto expect_parts = [](const std::string& text, std::initializer_list<const char*> parts) {
        for (const char* part : parts)
            EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
    };
    const std::string floor = describe_at(0);
    expect_parts(floor,
        { "test/floor: roughness 1.00, metalness 0.00, with a normal map", "opaque",
            "picture textures/test/floor.wal, normals test/bumps.png", "by materials/baseq2.mat" });
    EXPECT_EQ(floor.find("glows"), std::string::npos) << floor;
    expect_parts(describe_at(100),
        { "test/pane: roughness 0.10", "glass, opacity 0.33", "by materials/baseq2.mat, maps/three.mat",
            "    base_factor 0.5", "    kind glass" });
    expect_parts(describe_at(200), { "glows, ", "by its name: no file speaks of it" });
    session.host().run_text("mat base_factor 2\n");
    expect_parts(describe_at(200), { "by `mat`" });
    describe_at(100);
    session.host().run_text("mat base_factor 1\n");
    expect_parts(describe_at(100), { "maps/three.mat, changed by `mat`" });
}

TEST_F(Materials, EditsSayWhenTheyCount)
{
    Session session(folder_, matte_full);
    session.load_map("floor");
    see_floor(session);
    const auto say = [&](const std::string& change) {
        const size_t before = session.lines().size();
        session.host().run_text("mat " + change + "\n");
        return session.lines().size() > before ? session.lines()[before] : std::string();
    };
    for (const char* at_once : { "base_factor 0.5", "kind chrome" }) {
        EXPECT_NE(say(at_once).find("`mat save` keeps it"), std::string::npos);
        EXPECT_EQ(say(at_once).find("next map"), std::string::npos) << at_once;
    }
    EXPECT_EQ(say("reset").find("next map"), std::string::npos);
    for (const char* late : { "texture_normals a/b", "light_styles 0", "kind lava", "kind sky", "emissive_factor 2" })
        EXPECT_NE(say(late).find("counts with the next map"), std::string::npos) << late;
    EXPECT_NE(say("reset").find("counts with the next map"), std::string::npos);
    for (const char* vain : { "is_light 1", "kind TRANSPARENT" })
        EXPECT_NE(say(vain).find("has no effect here"), std::string::npos) << vain;
    say("reset");
}

// Averaged images and photo mode's keep a scene.
TEST_F(Materials, AreEditedInScenesThatStandStill)
{
    Session session(folder_, matte_full);
    session.load_map("floor");
    const double plain = see_floor(session);
    const auto edit_and_compare = [&] {
        const auto see = [&](const char* command) {
            session.host().run_text(command);
            session.draw(64);
            EXPECT_EQ(session.extension().accumulated_frames(), 64u) << command;
            return double(session.capture().mean().y);
        };
        EXPECT_NEAR(see("mat base_factor 0.25\n") / plain, 0.25, 0.01);
        EXPECT_NEAR(see("mat reset\n") / plain, 1, 0.01);
    };
    edit_and_compare(); // pt_accumulate is on
    session.set("pt_accumulate", 0);
    session.draw();
    session.host().run_text("pt_photo\n");
    for (int i = 0; i < 10000 && session.extension().accumulated_frames() < 2; i++)
        session.draw(); // until its camera has come to rest
    edit_and_compare();
    session.host().run_text("pt_photo off\n");
}

TEST_F(Materials, AreSavedAndReadAgain)
{
    std::string written;
    {
        Session session(folder_, matte_full);
        session.load_map("floor");
        see_floor(session);
        session.host().run_text("mat roughness_override 0.3\nmat save\n");
        for (const std::string& line : session.lines())
            if (const size_t at = line.find("wrote "); at != std::string::npos)
                written = line.substr(at + 6, line.find_last_not_of("\n") - at - 5);
    }
    ASSERT_TRUE(written.ends_with("/vkpt/materials.mat")) << written;
    std::ifstream file(written);
    std::stringstream text;
    text << file.rdbuf();
    std::filesystem::remove(written);
    EXPECT_NE(text.str().find("test/floor:\n    roughness_override 0.3\n"), std::string::npos) << text.str();
    Session::end_idle();
    folder_.add_text("vkpt/materials.mat", text.str());
    folder_.add_text("materials/baseq2.mat", "test/floor:\n    roughness_override 0.6\n");
    Session session(folder_, matte_full);
    session.load_map("floor");
    EXPECT_NEAR(find_roughness(session), 0.3, 0.01);
}

} // namespace
} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// What the engine's numbers become: entities, particles, lights and the map's flags as the triangles, materials and
// emitters that are traced. Read back from the module; no picture is looked at.
#include "formats/model.hpp"
#include "shaders/shared/scene.h"
#include "tests/formats/samples.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr float pi = 3.14159265f;

glm::vec3 to_vec3(const float (&v)[3]) { return { v[0], v[1], v[2] }; }

void expect_near(glm::vec3 seen, glm::vec3 wanted, float tolerance, const char* what)
{
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(seen[i], wanted[i], tolerance) << what << ", component " << i;
}

// One triangle in two frames, with two skins.
constexpr float quantum = 0.15f; // what MD2's bytes leave of a coordinate
const std::vector<glm::vec3> model_frames[2]
    = { { { 0, 2, 0 }, { 16, 2, 0 }, { 0, 18, 0 } }, { { 0, 2, 16 }, { 32, 2, 16 }, { 0, 10, 16 } } };

formats::Md2Model make_model()
{
    formats::Md2Model model;
    model.skin_width = model.skin_height = 16;
    model.skins = { "models/red.pcx", "models/green.pcx" };
    model.texture_coordinates = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
    model.indices = { 0, 1, 2 };
    for (const auto& positions : model_frames) {
        formats::Md2Model::Frame frame;
        frame.positions = positions;
        frame.normals.assign(3, { 0, 0, 1 });
        model.frames.push_back(frame);
    }
    return model;
}

// The same triangle, red or green, and a blue one below it.
constexpr glm::vec3 second_surface(0, 0, -32);

std::vector<formats::Md2Model> make_surfaces()
{
    std::vector<formats::Md2Model> surfaces(2, make_model());
    surfaces[1].skins = { "models/blue.pcx" };
    for (formats::Md2Model::Frame& frame : surfaces[1].frames)
        for (glm::vec3& position : frame.positions)
            position += second_surface;
    return surfaces;
}

// The surfaces' first frame on one joint, which nothing moves; a skin's name has neither folder nor ending.
formats::IqmModel as_iqm(const std::vector<formats::Md2Model>& surfaces)
{
    formats::IqmModel model;
    model.joints.push_back({ "root", -1, {} });
    model.frames.resize(2, { {} });
    for (const formats::Md2Model& surface : surfaces) {
        formats::IqmModel::Mesh mesh { "", surface.skins[0].substr(7, surface.skins[0].size() - 11), {},
            surface.indices };
        for (size_t i = 0; i < surface.vertex_count(); i++)
            mesh.vertices.push_back({ surface.frames[0].positions[i], surface.frames[0].normals[i],
                surface.texture_coordinates[i], {}, { 255, 0, 0, 0 } });
        model.meshes.push_back(mesh);
    }
    return model;
}

// What a view is made of beside the map.
struct Shown {
    std::vector<SceneTriangle> triangles;
    std::vector<SceneMaterial> materials; // all
    std::vector<SceneEmitter> emitters; // all

    const SceneMaterial& material(size_t triangle = 0) const { return materials.at(triangles.at(triangle).material); }
    std::string picture(size_t triangle = 0) const { return material(triangle).texture; }
    glm::vec3 lowest() const
    {
        return extreme([](glm::vec3 a, glm::vec3 b) { return glm::min(a, b); });
    }
    glm::vec3 highest() const
    {
        return extreme([](glm::vec3 a, glm::vec3 b) { return glm::max(a, b); });
    }

private:
    template <class Choose> glm::vec3 extreme(Choose choose) const
    {
        glm::vec3 result = to_vec3(triangles.at(0).positions[0]);
        for (const SceneTriangle& triangle : triangles)
            for (const auto& corner : triangle.positions)
                result = choose(result, to_vec3(corner));
        return result;
    }
};

class Wiring : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        for (const char* wall : { "wall", "lamp", "first", "second", "third", "pane", "rack/floor_metal",
                 "rack/mirror1", "rack/metal_tile", "rack/glasses" })
            folder_->add_wall(wall, white_index);
        const std::pair<const char*, uint8_t> skins[]
            = { { "models/red.pcx", red_index }, { "models/green.pcx", green_index }, { "models/blue.pcx", blue_index },
                  { "sprites/small.pcx", red_index }, { "sprites/large.pcx", green_index } };
        for (const auto& [path, index] : skins)
            folder_->add_skin(path, index);
        folder_->add("models/thing.md2", formats::write_md2(make_model()));
        folder_->add("models/fine.md2", formats::write_md2(make_model()));
        folder_->add("models/fine.md3", formats::write_md3(make_surfaces()));
        folder_->add("models/alone.md3", formats::write_md3(make_surfaces()));
        folder_->add("models/arm.iqm", formats::write_iqm(samples::make_iqm()));
        folder_->add("models/arm.md2", formats::write_md2(make_model()));
        folder_->add("models/same.iqm", formats::write_iqm(as_iqm(make_surfaces())));
        formats::Sp2Sprite sprite;
        sprite.frames = { { 16, 8, 8, 4, "sprites/small.pcx" }, { 32, 24, 0, 0, "sprites/large.pcx" } };
        folder_->add("sprites/flame.sp2", formats::write_sp2(sprite));
        folder_->add_map("room", make_map());
        session_ = std::make_unique<Session>(*folder_, CvarList { { "pt_bounces", "0" } }, glm::ivec2(32, 24));
        session_->load_map("room");
        const engine::Exports8& module = session_->module();
        model_ = module.register_model("models/thing.md2");
        sprite_ = module.register_model("sprites/flame.sp2");
        door_ = module.register_model("*1");
        world_triangles_ = 0;
        world_triangles_ = show({}).triangles.size();
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }
    void SetUp() override
    {
        ASSERT_TRUE(model_ && sprite_ && door_);
        for (const auto& [name, value] : CvarList { { "hand", "0" }, { "r_gunfov", "0" }, { "pt_emission_scale", "1" },
                 { "pt_sky_scale", "1" }, { "pt_dlight_scale", "1" } })
            session_->set(name, value);
        session_->look({ 0, 0, 0 }, { 1, 0, 0 });
        session_->view.time = 0;
        session_->view.flags = 0;
    }

    static formats::Bsp make_map()
    {
        MapBuilder map;
        texinfos_.wall = map.add_material("wall");
        texinfos_.lamp = map.add_material("lamp", 0, lamp_value);
        texinfos_.first = map.add_material("first");
        map.add_material("second");
        map.add_material("third");
        texinfos_.third_clear = map.add_material("pane", formats::SURF_TRANS33);
        texinfos_.two_thirds_clear = map.add_material("pane", formats::SURF_TRANS66);
        texinfos_.metal = map.add_material("rack/floor_metal");
        texinfos_.mirror = map.add_material("rack/mirror1");
        texinfos_.tile = map.add_material("rack/metal_tile");
        texinfos_.glass = map.add_material("rack/glasses");
        const uint16_t sky = map.add_material("sky", formats::SURF_SKY);
        map.add_room(glm::vec3(-256), glm::vec3(256), texinfos_.wall);
        map.add(rectangle({ 0, 0, 250 }, { 0, 16, 0 }, { 16, 0, 0 }), texinfos_.lamp);
        map.add(rectangle({ 100, 0, 240 }, { 0, 16, 0 }, { 16, 0, 0 }), sky);
        map.add(rectangle({ 0, 100, -200 }, { 16, 0, 0 }, { 0, 16, 0 }), texinfos_.third_clear);
        map.add(rectangle({ 0, 140, -200 }, { 16, 0, 0 }, { 0, 16, 0 }), texinfos_.two_thirds_clear);
        map.add_point_light(point_light_place, point_light_value, 1);
        map.begin_brush_model();
        map.add(rectangle({ 0, 0, 0 }, { 8, 0, 0 }, { 0, 4, 0 }), texinfos_.first);
        formats::Bsp bsp = map.finish();
        for (uint16_t i = 0; i < 3; i++)
            bsp.texinfos[size_t(texinfos_.first) + i].next = texinfos_.first + (i + 1) % 3;
        return bsp;
    }

    // The scene of a view with these things, drawn as the view says.
    static Shown show(const std::vector<engine::Entity>& entities)
    {
        engine::RefDef& view = session_->view;
        view.entities = entities.data();
        view.entity_count = int32_t(entities.size());
        session_->draw();
        view.entities = nullptr;
        view.entity_count = 0;
        SceneContents contents;
        if (!session_->extension().read_scene(&contents)) {
            ADD_FAILURE() << "there is no scene";
            return {};
        }
        return { { contents.triangles + world_triangles_, contents.triangles + contents.triangle_count },
            { contents.materials, contents.materials + contents.material_count },
            { contents.emitters, contents.emitters + contents.emitter_count } };
    }
    static engine::Entity thing(int32_t flags = 0) { return make_entity(model_, { 20, 0, -5 }, flags); }

    // The shown triangle's corners, in any order.
    static void expect_corners(const Shown& shown, const std::vector<glm::vec3>& corners, float tolerance = quantum)
    {
        ASSERT_EQ(shown.triangles.size(), 1u);
        for (const glm::vec3& corner : corners) {
            float nearest = INFINITY;
            for (const auto& seen : shown.triangles[0].positions)
                nearest = std::min(nearest, glm::distance(to_vec3(seen), corner));
            EXPECT_LT(nearest, tolerance) << corner.x << " " << corner.y << " " << corner.z;
        }
    }
    // Those of a frame of the model, each as `place` says.
    template <class Place> static std::vector<glm::vec3> corners_of(int frame, Place place)
    {
        std::vector<glm::vec3> corners;
        for (const glm::vec3& p : model_frames[frame])
            corners.push_back(place(p));
        return corners;
    }

    static constexpr int lamp_value = 1000;
    static constexpr float point_light_value = 200;
    static inline const glm::vec3 point_light_place { -100, 0, 0 };
    struct Texinfos {
        uint16_t wall, lamp, first, third_clear, two_thirds_clear, metal, mirror, tile, glass;
    };
    static inline Texinfos texinfos_ {};
    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
    static inline void *model_ = nullptr, *sprite_ = nullptr, *door_ = nullptr;
    static inline size_t world_triangles_ = 0;
};

// ---- models

TEST_F(Wiring, BacklerpIsTheShareOfTheOldFrameAndPlace)
{
    engine::Entity entity = make_entity(model_, { 40, 0, 8 });
    entity.previous_origin[0] = 20;
    entity.frame = 1;
    entity.previous_frame = 0;
    for (const float backlerp : { 0.0f, 0.25f, 1.0f }) {
        SCOPED_TRACE(backlerp);
        entity.backlerp = backlerp;
        std::vector<glm::vec3> corners;
        for (size_t i = 0; i < 3; i++)
            corners.push_back(
                glm::mix(model_frames[1][i] + glm::vec3(40, 0, 8), model_frames[0][i] + glm::vec3(20, 0, 8), backlerp));
        expect_corners(show({ entity }), corners);
    }
}

TEST_F(Wiring, Md3StandsForAnMd2WithItsSurfacesAndFrames)
{
    engine::Entity entity = make_entity(session_->module().register_model("models/fine.md2"), { 20, 0, 8 });
    ASSERT_TRUE(entity.model);
    entity.frame = 1;
    entity.backlerp = 0.25f;
    entity.skin_number = 1; // the second surface has one
    const Shown shown = show({ entity });
    ASSERT_EQ(shown.triangles.size(), 2u);
    EXPECT_NE(shown.picture(0).find("models/green"), std::string::npos) << shown.picture(0);
    EXPECT_NE(shown.picture(1).find("models/blue"), std::string::npos) << shown.picture(1);
    for (size_t surface = 0; surface < 2; surface++)
        for (size_t i = 0; i < 3; i++) {
            const glm::vec3 wanted = glm::mix(model_frames[1][i], model_frames[0][i], 0.25f) + glm::vec3(20, 0, 8)
                + (surface == 1 ? second_surface : glm::vec3(0));
            float nearest = INFINITY;
            for (const auto& seen : shown.triangles[surface].positions)
                nearest = std::min(nearest, glm::distance(to_vec3(seen), wanted));
            EXPECT_LT(nearest, 1.0f / 64) << "surface " << surface << ", corner " << i;
        }
    entity.skin = session_->module().register_skin("models/red.pcx"); // as players have: for all of it
    const Shown dressed = show({ entity });
    for (size_t surface = 0; surface < 2; surface++)
        EXPECT_NE(dressed.picture(surface).find("models/red"), std::string::npos) << dressed.picture(surface);
}

TEST_F(Wiring, ShellsOfAnMd3HaveOneLight)
{
    engine::Entity entity = make_entity(session_->module().register_model("models/fine.md2"), { 60, 0, 8 },
        engine::RF_SHELL_RED | engine::RF_TRANSLUCENT);
    const size_t without = show({}).emitters.size();
    const Shown shown = show({ entity });
    EXPECT_EQ(shown.triangles.size(), 2u);
    EXPECT_EQ(shown.emitters.size(), without + 8); // an octahedron
}

TEST_F(Wiring, Md3CanBeAskedForItself)
{
    EXPECT_EQ(
        show({ make_entity(session_->module().register_model("models/alone.md3"), { 20, 0, 8 }) }).triangles.size(),
        2u);
    EXPECT_FALSE(session_->module().register_model("models/none.md3"));
}

TEST_F(Wiring, IqmLooksLikeTheSameModelAsMd3)
{
    const auto show_model = [&](const char* name) {
        engine::Entity entity = make_entity(session_->module().register_model(name), { 20, 0, 8 });
        EXPECT_TRUE(entity.model) << name;
        entity.angles[1] = 30;
        return show({ entity });
    };
    const Shown iqm = show_model("models/same.iqm"), md3 = show_model("models/alone.md3");
    ASSERT_EQ(iqm.triangles.size(), 2u);
    ASSERT_EQ(md3.triangles.size(), 2u);
    for (size_t i = 0; i < 2; i++) {
        EXPECT_EQ(iqm.picture(i), md3.picture(i));
        for (size_t corner = 0; corner < 3; corner++) {
            expect_near(to_vec3(iqm.triangles[i].positions[corner]), to_vec3(md3.triangles[i].positions[corner]),
                1.0f / 64, "position");
            for (size_t k = 0; k < 2; k++)
                EXPECT_NEAR(iqm.triangles[i].uvs[corner][k], md3.triangles[i].uvs[corner][k], 1e-6f);
        }
    }
}

// The wrist of the sample: at (0, 0, 40), and (20, 0, 28) with the elbow bent.
TEST_F(Wiring, IqmStandsForAnMd2AndMovesWithItsSkeleton)
{
    engine::Entity entity = make_entity(session_->module().register_model("models/arm.md2"), { 20, 0, 8 });
    ASSERT_TRUE(entity.model);
    const auto expect_wrist = [&](glm::vec3 wrist) {
        const Shown shown = show({ entity });
        ASSERT_EQ(shown.triangles.size(), 4u);
        float nearest = INFINITY;
        for (const SceneTriangle& triangle : shown.triangles)
            for (const auto& corner : triangle.positions)
                nearest = std::min(nearest, glm::distance(to_vec3(corner), wrist + glm::vec3(20, 0, 8)));
        EXPECT_LT(nearest, 0.01f) << wrist.x << " " << wrist.z;
    };
    expect_wrist({ 0, 0, 40 });
    entity.frame = 1;
    expect_wrist({ 20, 0, 28 });
    entity.backlerp = 0.25f; // a quarter of the way back to the straight arm
    expect_wrist({ 15, 0, 31 });
    const Shown shown = show({ entity });
    EXPECT_NE(shown.picture(0).find("models/red"), std::string::npos) << shown.picture(0);
    EXPECT_NE(shown.picture(3).find("models/blue"), std::string::npos) << shown.picture(3);
    entity.skin = session_->module().register_skin("models/green.pcx");
    EXPECT_NE(show({ entity }).picture(0).find("models/green"), std::string::npos);
}

TEST_F(Wiring, ModelsTurnByTheirAngles)
{
    engine::Entity entity = make_entity(model_, { 40, 0, 8 });
    entity.angles[1] = 90; // counter-clockwise, from above
    expect_corners(show({ entity }), corners_of(0, [](glm::vec3 p) { return glm::vec3(40 - p.y, p.x, 8 + p.z); }));
    entity.angles[1] = 0;
    entity.angles[0] = 90; // looks down
    expect_corners(show({ entity }), corners_of(0, [](glm::vec3 p) { return glm::vec3(40 + p.z, p.y, 8 - p.x); }));
}

TEST_F(Wiring, AlphaCountsForTranslucentThingsAlone)
{
    engine::Entity entity = thing(engine::RF_TRANSLUCENT);
    entity.alpha = 0.3f;
    const Shown clear = show({ entity });
    EXPECT_FLOAT_EQ(clear.material().opacity, 0.3f);
    EXPECT_TRUE(clear.material().flags & shared::MATERIAL_TRANSLUCENT);
    EXPECT_EQ(clear.triangles[0].ray_mask, shared::MASK_TRANSLUCENT);
    entity.flags = 0;
    const Shown solid = show({ entity });
    EXPECT_EQ(solid.material().opacity, 1);
    EXPECT_FALSE(solid.material().flags & shared::MATERIAL_TRANSLUCENT);
    EXPECT_EQ(solid.triangles[0].ray_mask, shared::MASK_OPAQUE);
}

TEST_F(Wiring, GlowingItemsPulseAndOthersDoNot)
{
    const glm::vec3 skin = linear_colour(red_index);
    for (const float time : { 0.0f, 0.1f, 0.224f, 0.6f }) {
        session_->view.time = time;
        expect_near(to_vec3(show({ thing(engine::RF_GLOW) }).material().emission),
            skin * (0.1f + 0.1f * std::sin(7 * time)), 1e-3f, "glow");
        expect_near(to_vec3(show({ thing() }).material().emission), glm::vec3(0), 0, "none");
        expect_near(to_vec3(show({ thing(engine::RF_MINLIGHT) }).material().emission), skin * 0.05f, 1e-3f, "minlight");
    }
}

TEST_F(Wiring, FullbrightAndInfraredThingsAreUnlit)
{
    EXPECT_TRUE(show({ thing(engine::RF_FULLBRIGHT) }).material().flags & shared::MATERIAL_FULLBRIGHT);
    EXPECT_FALSE(show({ thing(engine::RF_IR_VISIBLE) }).material().flags & shared::MATERIAL_FULLBRIGHT);
    session_->view.flags = engine::RDF_IRGOGGLES;
    const Shown warm = show({ thing(engine::RF_IR_VISIBLE) });
    EXPECT_TRUE(warm.material().flags & shared::MATERIAL_FULLBRIGHT);
    const glm::vec3 red(linear_colour(red_index).x, 0, 0);
    expect_near(to_vec3(warm.material().base_colour), red, 2e-3f, "infrared");
    EXPECT_FALSE(show({ thing() }).material().flags & shared::MATERIAL_FULLBRIGHT);
}

TEST_F(Wiring, SkinsAreChosenByNumberOrGiven)
{
    engine::Entity entity = thing();
    const auto shows = [&](const char* picture) {
        EXPECT_NE(show({ entity }).picture().find(picture), std::string::npos) << picture;
    };
    shows("models/red");
    entity.skin_number = 1;
    shows("models/green");
    entity.skin_number = 7; // there are two
    shows("models/red");
    entity.skin = session_->module().register_skin("models/blue.pcx");
    ASSERT_TRUE(entity.skin);
    shows("models/blue");
}

TEST_F(Wiring, RayMasksTellTheWeaponAndTheOwnBody)
{
    EXPECT_EQ(show({ thing(engine::RF_WEAPONMODEL) }).triangles.at(0).ray_mask, shared::MASK_VIEW_WEAPON);
    EXPECT_EQ(show({ thing(engine::RF_VIEWERMODEL) }).triangles.at(0).ray_mask, shared::MASK_OWN_BODY);
}

// ---- the view weapon

TEST_F(Wiring, LeftHandMirrorsTheWeaponAlone)
{
    const auto as_is = [](glm::vec3 p) { return p + glm::vec3(20, 0, -5); };
    expect_corners(show({ thing(engine::RF_WEAPONMODEL) }), corners_of(0, as_is));
    session_->set("hand", 1);
    expect_corners(show({ thing(engine::RF_WEAPONMODEL) }),
        corners_of(0, [](glm::vec3 p) { return glm::vec3(p.x + 20, -p.y, p.z - 5); }));
    expect_corners(show({ thing() }), corners_of(0, as_is));
    session_->set("hand", 2);
    EXPECT_TRUE(show({ thing(engine::RF_WEAPONMODEL) }).triangles.empty());
    EXPECT_EQ(show({ thing() }).triangles.size(), 1u);
}

// Where it would be on the screen with a vertical field of view of r_gunfov, as with the engine's own renderers.
TEST_F(Wiring, GunHasAVerticalFieldOfViewOfItsOwn)
{
    for (const float gun : { 60.0f, 75.0f, 110.0f }) {
        session_->set("r_gunfov", double(gun));
        const float factor = std::tan(glm::radians(session_->view.fov_y) / 2) / std::tan(glm::radians(gun) / 2);
        if (gun == 75) { // 90 degrees across at 4:3
            EXPECT_NEAR(factor, 0.977f, 1e-3f);
        }
        const auto squeezed = [&](glm::vec3 p) { return glm::vec3(p.x + 20, p.y * factor, (p.z - 5) * factor); };
        expect_corners(show({ thing(engine::RF_WEAPONMODEL) }), corners_of(0, squeezed), quantum * 2);
        expect_corners(show({ thing() }), corners_of(0, [](glm::vec3 p) { return p + glm::vec3(20, 0, -5); }));
    }
}

TEST_F(Wiring, WeaponsBeforeWallsAreSmallAndNear)
{
    session_->look({ 0, 8, 4 }, { 1, 8, 4 });
    const auto placed = [](glm::vec3 p) { return p + glm::vec3(20, 0, -5); };
    const glm::vec3 eye(0, 8, 4);
    expect_corners(show({ thing(engine::RF_WEAPONMODEL | engine::RF_DEPTHHACK) }),
        corners_of(0, [&](glm::vec3 p) { return eye + (placed(p) - eye) * 0.25f; }));
    expect_corners(show({ thing(engine::RF_DEPTHHACK) }), corners_of(0, placed));
    session_->set("r_gunfov", 60);
    const float across = 0.25f * std::tan(glm::radians(session_->view.fov_y) / 2) / std::tan(glm::radians(30.0f));
    expect_corners(show({ thing(engine::RF_WEAPONMODEL | engine::RF_DEPTHHACK) }),
        corners_of(0, [&](glm::vec3 p) { return eye + (placed(p) - eye) * glm::vec3(0.25f, across, across); }));
}

// ---- sprites, beams, particles

TEST_F(Wiring, SpritesShowTheirFrame)
{
    engine::Entity entity = make_entity(sprite_, { 50, 10, 20 });
    for (const int frame : { 0, 1, 2, 3 }) {
        SCOPED_TRACE(frame);
        entity.frame = frame;
        const Shown shown = show({ entity });
        ASSERT_EQ(shown.triangles.size(), 2u);
        const bool large = frame % 2 == 1;
        EXPECT_NE(shown.picture().find(large ? "large" : "small"), std::string::npos) << shown.picture();
        // The camera looks along +x: right is -y.
        expect_near(shown.lowest(), large ? glm::vec3(50, -22, 20) : glm::vec3(50, 2, 16), 1e-3f, "lowest");
        expect_near(shown.highest(), large ? glm::vec3(50, 10, 44) : glm::vec3(50, 18, 24), 1e-3f, "highest");
        EXPECT_EQ(shown.material().opacity, 1);
        EXPECT_EQ(shown.material().flags, shared::MATERIAL_FULLBRIGHT | shared::MATERIAL_ALPHA_TEST);
    }
    entity.flags = engine::RF_TRANSLUCENT;
    entity.alpha = 0.4f;
    EXPECT_FLOAT_EQ(show({ entity }).material().opacity, 0.4f);
}

TEST_F(Wiring, BeamsHaveTheirColourWidthAndAlpha)
{
    engine::Entity beam = make_entity(nullptr, { 10, 0, 0 }, engine::RF_BEAM | engine::RF_TRANSLUCENT);
    beam.previous_origin[0] = 90;
    beam.frame = 6;
    beam.skin_number = green_index;
    beam.alpha = 0.5f;
    const Shown shown = show({ beam });
    ASSERT_FALSE(shown.triangles.empty());
    expect_near(shown.lowest(), { 10, -3, -3 }, 0.5f, "lowest");
    expect_near(shown.highest(), { 90, 3, 3 }, 0.5f, "highest");
    expect_near(to_vec3(shown.material().base_colour), linear_colour(green_index), 1e-3f, "colour");
    const glm::vec3 emission = to_vec3(shown.material().emission);
    expect_near(emission / emission.y, linear_colour(green_index) / linear_colour(green_index).y, 1e-3f, "emission");
    EXPECT_FLOAT_EQ(shown.material().opacity, 0.5f);
}

TEST_F(Wiring, ParticlesHaveTheirPlaceColourAndAlpha)
{
    const engine::Particle particle { { 60, 5, -7 }, blue_index, 0.6f };
    session_->view.particles = &particle;
    session_->view.particle_count = 1;
    const Shown shown = show({});
    session_->view.particles = nullptr;
    session_->view.particle_count = 0;
    ASSERT_EQ(shown.triangles.size(), 2u);
    expect_near((shown.lowest() + shown.highest()) * 0.5f, { 60, 5, -7 }, 1e-3f, "place");
    expect_near(to_vec3(shown.material().base_colour), linear_colour(blue_index), 1e-3f, "colour");
    EXPECT_FLOAT_EQ(shown.material().opacity, 0.6f);
}

// ---- brush models

TEST_F(Wiring, BrushModelsShowTheirFrameAlphaAndPlace)
{
    engine::Entity door = make_entity(door_, { 30, 20, 10 });
    const char* const pictures[] = { "first", "second", "third", "first" };
    for (int frame = 0; frame < 4; frame++) {
        door.frame = frame;
        const Shown shown = show({ door });
        ASSERT_EQ(shown.triangles.size(), 2u);
        EXPECT_NE(shown.picture().find(pictures[frame]), std::string::npos) << shown.picture();
        EXPECT_EQ(shown.material().opacity, 1);
    }
    door.frame = 0;
    door.angles[1] = 90;
    const Shown turned = show({ door });
    expect_near(turned.lowest(), { 26, 12, 10 }, 1e-3f, "lowest");
    expect_near(turned.highest(), { 34, 28, 10 }, 1e-3f, "highest");
    door.flags = engine::RF_TRANSLUCENT;
    door.alpha = 0.7f;
    const Shown clear = show({ door });
    EXPECT_FLOAT_EQ(clear.material().opacity, 0.7f);
    EXPECT_EQ(clear.triangles[0].ray_mask, shared::MASK_TRANSLUCENT);
}

// ---- lights

TEST_F(Wiring, DynamicLightsHaveTheirColourPlaceAndReach)
{
    const glm::vec3 colour(1, 0.5f, 0.25f), place(10, -20, 30);
    const engine::DynamicLight light { { place.x, place.y, place.z }, { colour.x, colour.y, colour.z }, 150 };
    session_->view.dlights = &light;
    session_->view.dlight_count = 1;
    float red[2] {};
    for (const int scale : { 1, 2 }) {
        session_->set("pt_dlight_scale", scale);
        int found = 0;
        for (const SceneEmitter& emitter : show({}).emitters) {
            if (emitter.type != shared::EMITTER_SPHERE || glm::distance(to_vec3(emitter.centre), place) > 1)
                continue;
            found++;
            expect_near(to_vec3(emitter.radiance) / emitter.radiance[0], colour, 1e-4f, "colour");
            EXPECT_EQ(emitter.reach, 150);
            red[scale - 1] = emitter.radiance[0];
        }
        EXPECT_EQ(found, 1);
    }
    EXPECT_GT(red[0], 0);
    EXPECT_FLOAT_EQ(red[1], 2 * red[0]);
    session_->view.dlights = nullptr;
    session_->view.dlight_count = 0;
}

// The classic light compiler's sums in our unit: a white wall under a lightmap value of 128 has radiance 1.
TEST_F(Wiring, LightsAreAsBrightAsTheMapsNumbersSay)
{
    constexpr float face = 0.4f * pi / 128; // times the value: radiance
    constexpr float point = 0.00115f; // times the value cubed: intensity
    for (const float scale : { 1.0f, 3.0f }) {
        session_->set("pt_emission_scale", double(scale));
        const Shown shown = show({});
        int faces = 0, points = 0;
        for (const SceneEmitter& emitter : shown.emitters) {
            if (emitter.type == shared::EMITTER_TRIANGLE) {
                faces++;
                EXPECT_NEAR(emitter.radiance[1], scale * face * lamp_value, 0.05f * scale * face * lamp_value);
            } else if (emitter.type == shared::EMITTER_SPHERE && emitter.radiance[1] > 0) {
                points++;
                const float intensity = pi * emitter.radius * emitter.radius * emitter.radiance[1],
                            wanted = scale * point * point_light_value * point_light_value * point_light_value;
                EXPECT_NEAR(intensity, wanted, 0.06f * wanted);
                expect_near(to_vec3(emitter.centre), point_light_place, 1e-3f, "place");
            }
        }
        EXPECT_EQ(faces, 2);
        EXPECT_EQ(points, 1);
        EXPECT_NEAR(shown.materials.at(texinfos_.lamp).emission[1], scale * face * lamp_value,
            0.05f * scale * face * lamp_value);
    }
}

TEST_F(Wiring, LightstylesAndTheSkysScaleCount)
{
    const auto radiance = [&](uint32_t type) {
        float sum = 0;
        for (const SceneEmitter& emitter : show({}).emitters)
            sum += emitter.type == type ? emitter.radiance[1] : 0;
        return sum;
    };
    const float point = radiance(shared::EMITTER_SPHERE), sky = radiance(shared::EMITTER_SKY);
    EXPECT_GT(point, 0);
    EXPECT_GT(sky, 0);
    session_->light_style(1, 0.25f);
    EXPECT_FLOAT_EQ(radiance(shared::EMITTER_SPHERE), 0.25f * point);
    session_->light_style(1, 1);
    session_->set("pt_sky_scale", 4);
    EXPECT_FLOAT_EQ(radiance(shared::EMITTER_SKY), 4 * sky);
}

// ---- the map's surfaces

TEST_F(Wiring, PicturesOfTheMapChangeTwiceASecond)
{
    const char* const pictures[] = { "first", "second", "third" };
    for (int tick = 0; tick < 7; tick++)
        for (const float part : { 0.02f, 0.47f }) {
            session_->view.time = 0.5f * float(tick) + part;
            const Shown shown = show({});
            for (int i = 0; i < 3; i++) {
                const std::string picture = shown.materials.at(size_t(texinfos_.first + i)).texture;
                EXPECT_NE(picture.find(pictures[(i + tick) % 3]), std::string::npos)
                    << picture << " at " << session_->view.time;
            }
        }
}

TEST_F(Wiring, PanesAreAThirdAndTwoThirdsOpaque)
{
    const Shown shown = show({});
    const SceneMaterial &third = shown.materials.at(texinfos_.third_clear),
                        &two_thirds = shown.materials.at(texinfos_.two_thirds_clear);
    EXPECT_NEAR(third.opacity, 1 / 3.0f, 0.005f);
    EXPECT_NEAR(two_thirds.opacity, 2 / 3.0f, 0.01f);
    EXPECT_TRUE(third.flags & shared::MATERIAL_TRANSLUCENT);
    EXPECT_TRUE(two_thirds.flags & shared::MATERIAL_TRANSLUCENT);
    EXPECT_EQ(shown.materials.at(texinfos_.wall).opacity, 1);
    EXPECT_FALSE(shown.materials.at(texinfos_.wall).flags & shared::MATERIAL_TRANSLUCENT);
}

// Nothing in the game's data says so: the pictures' names do.
TEST_F(Wiring, SurfacesAreWhatTheirNamesSay)
{
    session_->set("pt_roughness_default", 0.77);
    session_->set("pt_metallic_default", 0.125);
    const Shown shown = show({});
    session_->set("pt_roughness_default", 0.7);
    session_->set("pt_metallic_default", 0);
    const auto expect_surface = [&](uint16_t texinfo, float roughness, float metallic) {
        EXPECT_FLOAT_EQ(shown.materials.at(texinfo).roughness, roughness) << shown.materials.at(texinfo).texture;
        EXPECT_FLOAT_EQ(shown.materials.at(texinfo).metallic, metallic) << shown.materials.at(texinfo).texture;
    };
    expect_surface(texinfos_.wall, 0.77f, 0.125f);
    expect_surface(texinfos_.metal, 0.42f, 0.8f);
    expect_surface(texinfos_.mirror, 0, 1);
    expect_surface(texinfos_.tile, 0.4f, 0); // the first of both
    expect_surface(texinfos_.glass, 0.1f, 0);
}

} // namespace
} // namespace vkpt::tests

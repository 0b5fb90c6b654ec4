// SPDX-License-Identifier: GPL-2.0-or-later
// The player's own body, which the engine does not send: where it stands, in which frame, and when there is one. Read
// back from the module; a model with a triangle as high as the number of its frame tells the frame.
#include "formats/model.hpp"
#include "shaders/shared/scene.h"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include <optional>

namespace vkpt::tests {
namespace {

constexpr int frame_count = 198;
constexpr float eye_height = 46, crouched_eye_height = 22; // above the floor

// A triangle of `size`, from whose edges the model is known again.
formats::Md2Model make_figure(float size)
{
    formats::Md2Model model;
    model.skin_width = model.skin_height = 16;
    model.texture_coordinates = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
    model.indices = { 0, 1, 2 };
    for (int i = 0; i < frame_count; i++) {
        formats::Md2Model::Frame frame;
        frame.positions = { { 0, 0, float(i) }, { size, 0, float(i) }, { 0, size, float(i) } };
        frame.normals.assign(3, { 0, 0, 1 });
        model.frames.push_back(frame);
    }
    return model;
}
constexpr float body_size = 8, blaster_size = 16, other_size = 24;

// Solid below z = 0.
formats::Bsp make_map()
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 256, 0, 0 }, { 0, 256, 0 }), map.add_material("wall"));
    formats::Bsp bsp = map.finish();
    formats::BspLeaf solid {};
    solid.contents = formats::CONTENTS_SOLID;
    solid.cluster = -1;
    bsp.leaves.push_back(solid);
    bsp.planes.push_back({ { 0, 0, 1 }, 0, 2 });
    formats::BspNode node {};
    node.plane = int32_t(bsp.planes.size() - 1);
    node.children[0] = -1;
    node.children[1] = -2;
    bsp.nodes.push_back(node);
    bsp.models[0].head_node = int32_t(bsp.nodes.size() - 1);
    return bsp;
}

struct Part {
    float frame; // the height in the model
    glm::vec3 origin; // on the floor of the model: without that height
    uint32_t mask;
    std::string picture;
};

class PlayerBody : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        folder_->add_wall("wall", white_index);
        folder_->add_skin("players/male/grunt.pcx", red_index);
        folder_->add_skin("players/female/athena.pcx", blue_index);
        const auto add
            = [](const std::string& path, float size) { folder_->add(path, formats::write_md2(make_figure(size))); };
        for (const char* who : { "male", "female" }) {
            add(std::string("players/") + who + "/tris.md2", body_size);
            add(std::string("players/") + who + "/w_blaster.md2", blaster_size);
            add(std::string("players/") + who + "/weapon.md2", other_size);
        }
        add("models/weapons/v_blast/tris.md2", 1);
        add("models/weapons/v_club/tris.md2", 1);
        folder_->add_map("room", make_map());
        session_ = std::make_unique<Session>(*folder_, CvarList { { "pt_bounces", "0" } }, glm::ivec2(32, 24));
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }
    void SetUp() override
    {
        session_->set("pt_player_body", "1");
        session_->set("skin", "male/grunt");
        session_->load_map("room");
        for (const char* path : { "players/male/tris.md2", "players/male/w_blaster.md2", "players/male/weapon.md2" })
            session_->module().register_model(path);
        gun_ = make_entity(
            session_->module().register_model("models/weapons/v_blast/tris.md2"), { 0, 0, 0 }, engine::RF_WEAPONMODEL);
        ASSERT_TRUE(gun_.model);
        tick_ += 20; // no test goes on where another one ended
        show_at({ 0, 0, eye_height });
    }

    // `share` of a tenth of a second has gone by.
    static void show_at(glm::vec3 eye, double share = 1e-3)
    {
        session_->look(eye, eye + glm::vec3(1, 0, 0));
        session_->view.time = float((tick_ + share) / 10);
        session_->view.entities = &gun_;
        session_->view.entity_count = gun_.model ? 1 : 0;
        session_->draw();
        session_->view.entity_count = 0;
    }
    // At the end of a tenth of a second, when the new frame is shown alone.
    static void walk(glm::vec3 eye)
    {
        tick_++;
        show_at(eye);
        show_at(eye, 0.9995);
    }
    // The part whose triangle has edges of `size`.
    static std::optional<Part> find(float size)
    {
        SceneContents contents;
        if (!session_->extension().read_scene(&contents)) {
            ADD_FAILURE() << "there is no scene";
            return std::nullopt;
        }
        for (size_t i = 0; i < contents.triangle_count; i++) {
            const SceneTriangle& triangle = contents.triangles[i];
            const auto corner = [&](int c) {
                return glm::vec3(triangle.positions[c][0], triangle.positions[c][1], triangle.positions[c][2]);
            };
            float longest = 0;
            for (int c = 0; c < 3; c++)
                longest = std::max(longest, glm::distance(corner(c), corner((c + 1) % 3)));
            if (std::abs(longest - size * std::sqrt(2.0f)) > 0.5f)
                continue;
            const glm::vec3 lowest = glm::min(glm::min(corner(0), corner(1)), corner(2));
            const std::string picture = contents.materials[triangle.material].texture;
            return Part { lowest.z, lowest, triangle.ray_mask, picture };
        }
        return std::nullopt;
    }
    // That of the body in a model whose origin is `height` above the floor.
    static float shown_frame(float height)
    {
        const auto body = find(body_size);
        return body ? body->frame - height : -1;
    }
    static void expect_frame_in(float height, int first, int last)
    {
        const float frame = shown_frame(height);
        EXPECT_GE(frame, float(first) - 0.1f);
        EXPECT_LE(frame, float(last) + 0.1f);
    }

    static constexpr float standing_origin = eye_height - 22, crouched_origin = crouched_eye_height + 2;
    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
    static inline engine::Entity gun_;
    static inline int tick_ = 0;
};

TEST_F(PlayerBody, StandsBehindTheEyeAndHoldsItsWeapon)
{
    const auto body = find(body_size), weapon = find(blaster_size);
    ASSERT_TRUE(body && weapon);
    for (const auto& part : { body, weapon }) {
        EXPECT_EQ(part->mask, shared::MASK_OWN_BODY);
        EXPECT_NEAR(part->origin.x, -15, 0.1f);
        EXPECT_NEAR(part->origin.y, 0, 0.1f);
    }
    EXPECT_NE(body->picture.find("players/male/grunt"), std::string::npos) << body->picture;
    EXPECT_FALSE(find(other_size));
    gun_.model = session_->module().register_model("models/weapons/v_club/tris.md2");
    show_at({ 0, 0, eye_height });
    EXPECT_TRUE(find(other_size)) << "of a weapon without a model of its own";
    EXPECT_FALSE(find(blaster_size));
}

TEST_F(PlayerBody, IsThereWithAWeaponInViewAlone)
{
    ASSERT_TRUE(find(body_size));
    session_->set("pt_player_body", "0");
    show_at({ 0, 0, eye_height });
    EXPECT_FALSE(find(body_size));
    session_->set("pt_player_body", "1");
    void* model = std::exchange(gun_.model, nullptr); // a spectator, or the end of a level
    show_at({ 0, 0, eye_height });
    EXPECT_FALSE(find(body_size));
    gun_.model = model;
    show_at({ 0, 0, eye_height });
    EXPECT_TRUE(find(body_size));
}

TEST_F(PlayerBody, LooksAsItsSkinSays)
{
    session_->set("skin", "female/athena"); // not registered
    show_at({ 0, 0, eye_height });
    ASSERT_TRUE(find(body_size));
    EXPECT_NE(find(body_size)->picture.find("players/male/grunt"), std::string::npos);
    session_->module().register_model("players/female/tris.md2");
    for (const char* odd : { "female/../athena", "../female/athena", "female", "/", "", "female/athena/x" }) {
        session_->set("skin", odd);
        show_at({ 0, 0, eye_height });
        ASSERT_TRUE(find(body_size)) << odd;
        EXPECT_NE(find(body_size)->picture.find("players/male/grunt"), std::string::npos) << odd;
    }
    session_->set("skin", "female/athena");
    show_at({ 0, 0, eye_height });
    ASSERT_TRUE(find(body_size));
    EXPECT_NE(find(body_size)->picture.find("players/female/athena"), std::string::npos);
}

TEST_F(PlayerBody, MovesAsTheEyeDoes)
{
    walk({ 0, 0, eye_height });
    expect_frame_in(standing_origin, 0, 39);
    const float first = shown_frame(standing_origin);
    walk({ 0.5f, 0, eye_height });
    EXPECT_NEAR(shown_frame(standing_origin), first + 1, 0.1f) << "ten frames a second";
    walk({ 30, 0, eye_height });
    expect_frame_in(standing_origin, 40, 45);
    walk({ 60, 0, eye_height + 100 });
    expect_frame_in(standing_origin + 100, 67, 67); // in the air
    walk({ 60, 0, crouched_eye_height });
    expect_frame_in(crouched_origin, 135, 153);
    walk({ 70, 0, crouched_eye_height });
    expect_frame_in(crouched_origin, 154, 159);
    walk({ 70, 0, eye_height - 18 }); // up a step, which the client smoothes
    expect_frame_in(standing_origin - 18, 0, 39);
}

TEST_F(PlayerBody, ShootsAsItsWeaponDoes)
{
    for (const auto& [frame, shown] : { std::pair { 5, 46 }, { 8, 49 } }) {
        gun_.frame = frame;
        walk({ 0, 0, eye_height });
        EXPECT_NEAR(shown_frame(standing_origin), float(shown), 0.1f) << "frame " << frame;
    }
    gun_.frame = 5;
    walk({ 0, 0, crouched_eye_height });
    EXPECT_NEAR(shown_frame(crouched_origin), 160, 0.1f);
    gun_.frame = 9; // at rest
    walk({ 0, 0, eye_height });
    expect_frame_in(standing_origin, 0, 39);
}

TEST_F(PlayerBody, FramesFollowOneAnotherSmoothly)
{
    walk({ 0, 0, eye_height });
    const float before = shown_frame(standing_origin);
    tick_++;
    for (const float part : { 0.25f, 0.5f, 0.75f }) {
        show_at({ 0, 0, eye_height }, double(part));
        EXPECT_NEAR(shown_frame(standing_origin), before + part, 0.05f);
    }
}

} // namespace
} // namespace vkpt::tests

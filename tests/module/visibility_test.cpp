// SPDX-License-Identifier: GPL-2.0-or-later
// Who sees what: translucent surfaces, the view weapon, the player's own body, things that come and go.
// Single frames with one seed: where nothing changed, pictures are the same bit for bit.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr float cube_half = 8;

// A floor, a lamp high above, and a mirror at y = 100.
constexpr uint8_t glass_index = 100;

class Visibility : public testing::Test {
protected:
    Visibility()
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("mirror", white_index);
        folder_.add_wall("lamp", white_index);
        folder_.add_wall("lava", white_index);
        folder_.add_wall("glass", glass_index);
        cube_path_ = folder_.add_cube("cube", cube_half, red_index);
    }

    void start(MapBuilder& map, const CvarList& cvars = {})
    {
        folder_.add_map("room", map.finish());
        CvarList all { { "r_gunfov", "0" }, { "vid_gamma", "1" }, { "gl3_intensity_2D", "1" } };
        all.insert(all.end(), cvars.begin(), cvars.end());
        session_ = std::make_unique<Session>(folder_, all);
        session_->load_map("room");
        cube_ = session_->module().register_model(cube_path_.c_str());
        ASSERT_TRUE(cube_);
    }

    void add_floor(MapBuilder& map)
    {
        map.add(rectangle({ 0, 0, 0 }, { 256, 0, 0 }, { 0, 256, 0 }), map.add_material("wall"));
    }

    void add_lamp(MapBuilder& map)
    {
        map.add(rectangle({ 0, 0, 200 }, { 0, 16, 0 }, { 16, 0, 0 }), map.add_material("lamp", 0, 4000));
    }

    Radiance picture_with(const std::vector<engine::Entity>& entities)
    {
        session_->view.entities = entities.data();
        session_->view.entity_count = int32_t(entities.size());
        session_->draw();
        session_->view.entities = nullptr;
        session_->view.entity_count = 0;
        return session_->capture();
    }

    // Whether the ray through the middle of pixel x, y meets a cube at `origin`, made larger by `margin`.
    bool covers(glm::vec3 origin, int x, int y, float margin)
    {
        const float half = cube_half + margin;
        return meets_box(
            camera_ray(session_->view, { float(x) + 0.5f, float(y) + 0.5f }), origin - half, origin + half);
    }

    struct Changes {
        int inside = 0, outside = 0; // pixels that differ, within and outside of the cube's outline
        int covered = 0;
    };
    Changes compare(const Radiance& a, const Radiance& b, glm::vec3 cube)
    {
        Changes changes;
        for (int y = 0; y < a.height; y++)
            for (int x = 0; x < a.width; x++) {
                const bool differs = a.at(x, y) != b.at(x, y);
                changes.inside += differs && covers(cube, x, y, 0.1f);
                changes.outside += differs && !covers(cube, x, y, 0.1f);
                changes.covered += covers(cube, x, y, -0.1f);
            }
        return changes;
    }

    GameFolder folder_;
    std::string cube_path_;
    std::unique_ptr<Session> session_;
    void* cube_ = nullptr;
};

TEST_F(Visibility, ViewWeaponIsSeenAndCastsNoShadow)
{
    MapBuilder map;
    add_floor(map);
    add_lamp(map);
    start(map);
    session_->look({ -60, 0, 60 }, { 0, 0, 20 });
    const glm::vec3 place(-20, 0, 30);
    const Radiance without = picture_with({});
    const Changes weapon = compare(without, picture_with({ make_entity(cube_, place, engine::RF_WEAPONMODEL) }), place);
    EXPECT_GT(weapon.covered, 50);
    EXPECT_GE(weapon.inside, weapon.covered * 9 / 10);
    EXPECT_EQ(weapon.outside, 0);
    // The same thing as a part of the world does cast one.
    EXPECT_GT(compare(without, picture_with({ make_entity(cube_, place) }), place).outside, 20);
}

// A wall 12 units before the eye, as near as a player comes to one, and a weapon that reaches farther.
TEST_F(Visibility, WallsDoNotHideTheWeaponBeforeThem)
{
    MapBuilder map;
    add_floor(map);
    add_lamp(map);
    map.begin_brush_model();
    map.add(rectangle({ 0, 0, 0 }, { 0, 0, 100 }, { 0, 100, 0 }), map.add_material("wall"));
    start(map);
    void* wall_model = session_->module().register_model("*1");
    ASSERT_TRUE(wall_model);
    session_->look({ -60, 0, 60 }, { 0, 0, 50 });
    const engine::Entity wall = make_entity(wall_model, { -48, 0, 60 });
    const auto count_weapon = [](const Radiance& picture) {
        return std::ranges::count_if(picture.pixels, [](glm::vec3 p) { return p.x > 4 * p.y && p.x > 4 * p.z; });
    };
    const int32_t weapon = engine::RF_WEAPONMODEL | engine::RF_FULLBRIGHT;
    const engine::Entity near = make_entity(cube_, { -34, -4, 50 }, weapon | engine::RF_DEPTHHACK);
    const Radiance open = picture_with({ near }), closed = picture_with({ near, wall });
    const auto pixels = count_weapon(open);
    EXPECT_GT(pixels, 150);
    EXPECT_EQ(count_weapon(closed), pixels);
    for (size_t i = 0; i < open.pixels.size(); i++)
        if (count_weapon({ 1, 1, { open.pixels[i] } })) {
            EXPECT_EQ(closed.pixels[i], open.pixels[i]) << i;
        }
    // It looks as at its true place, which the wall hides.
    const engine::Entity true_place = make_entity(cube_, { -34, -4, 50 }, weapon);
    EXPECT_NEAR(double(count_weapon(picture_with({ true_place }))), double(pixels), 2);
    EXPECT_EQ(count_weapon(picture_with({ true_place, wall })), 0);
}

TEST_F(Visibility, OwnBodyIsSeenInTheMirrorOnly)
{
    constexpr float mirror_y = 100;
    MapBuilder map;
    add_floor(map);
    add_lamp(map);
    map.add(rectangle({ 0, mirror_y, 100 }, { 100, 0, 0 }, { 0, 0, 100 }), map.add_material("mirror"));
    start(map);
    session_->look({ 0, -60, 60 }, { 0, 0, 60 }, 60);
    const glm::vec3 place(0, -20, 60), mirrored(0, 2 * mirror_y + 20, 60);
    const Radiance picture
        = picture_with({ make_entity(cube_, place, engine::RF_VIEWERMODEL | engine::RF_FULLBRIGHT) });
    const glm::vec3 red = linear_colour(red_index);
    const auto is_red = [&](int x, int y) {
        const glm::vec3 d = picture.at(x, y) - red;
        return std::abs(d.x) + std::abs(d.y) + std::abs(d.z) < 0.02f;
    };
    int direct = 0, in_mirror = 0;
    for (int y = 0; y < picture.height; y++)
        for (int x = 0; x < picture.width; x++) {
            if (covers(mirrored, x, y, -0.3f)) {
                in_mirror++;
                EXPECT_TRUE(is_red(x, y)) << "mirror image at " << x << ", " << y;
            } else if (covers(place, x, y, 0) && !covers(mirrored, x, y, 0.3f)) {
                direct++;
                EXPECT_FALSE(is_red(x, y)) << "the body itself at " << x << ", " << y;
            }
        }
    EXPECT_GT(in_mirror, 8);
    EXPECT_GT(direct, 100);
}

TEST_F(Visibility, WhatMovesAwayLeavesNoTrace)
{
    MapBuilder map;
    add_floor(map);
    add_lamp(map);
    start(map);
    session_->look({ -60, 0, 60 }, { 0, 0, 0 });
    const Radiance before = picture_with({});
    const Radiance there = picture_with({ make_entity(cube_, { 0, 0, 20 }) });
    EXPECT_FALSE(there == before);
    EXPECT_FALSE(picture_with({ make_entity(cube_, { 10, 20, 20 }) }) == there);
    EXPECT_TRUE(picture_with({ make_entity(cube_, { 0, 0, 20 }) }) == there);
    // Behind the camera, far off, and its shadow with it.
    EXPECT_TRUE(picture_with({ make_entity(cube_, { -2000, 0, 20 }) }) == before);
    EXPECT_TRUE(picture_with({}) == before);
}

TEST_F(Visibility, GlowingBrushModelTakesItsLightAlong)
{
    MapBuilder map;
    add_floor(map);
    map.begin_brush_model();
    map.add(rectangle({ 0, 0, 60 }, { 0, 16, 0 }, { 16, 0, 0 }), map.add_material("lamp", 0, 4000));
    start(map, { { "pt_bounces", "0" } });
    void* lamp = session_->module().register_model("*1");
    ASSERT_TRUE(lamp);
    session_->look({ -60, 0, 40 }, { 0, 0, 0 });
    const Radiance dark = picture_with({});
    const Radiance lit = picture_with({ make_entity(lamp, { 0, 0, 0 }) });
    EXPECT_GT(luminance(lit.mean()), luminance(dark.mean()) + 0.1f);
    EXPECT_FALSE(picture_with({ make_entity(lamp, { 0, 60, 0 }) }) == lit);
    EXPECT_TRUE(picture_with({ make_entity(lamp, { 0, 0, 0 }) }) == lit);
    EXPECT_TRUE(picture_with({}) == dark);
}

// Closed, so that nothing but the light is seen.
TEST_F(Visibility, DynamicLightGoesOutAtOnce)
{
    MapBuilder map;
    map.add_room({ -128, -128, 0 }, { 128, 128, 128 }, map.add_material("wall"));
    start(map, { { "pt_bounces", "2" } });
    session_->look({ -60, 0, 60 }, { 0, 0, 0 });
    EXPECT_TRUE(is_black(picture_with({})));
    const engine::DynamicLight light { { 20, 0, 40 }, { 1, 1, 1 }, 200 };
    session_->view.dlights = &light;
    session_->view.dlight_count = 1;
    const Radiance lit = picture_with({});
    EXPECT_GT(luminance(lit.mean()), 0.01f);
    session_->set("pt_dlight_scale", 2);
    const Radiance brighter = picture_with({});
    EXPECT_NEAR(luminance(brighter.mean()), 2 * luminance(lit.mean()), 1e-3f * luminance(lit.mean()));
    session_->view.dlight_count = 0;
    EXPECT_TRUE(is_black(picture_with({})));
}

// What a lamp throws on the floor through a sheet of this material.
class Sheet : public Visibility {
protected:
    float light_through(uint32_t flags, bool present)
    {
        constexpr size_t copies = 512;
        MapBuilder map;
        add_floor(map);
        add_lamp(map);
        const uint16_t glass = map.add_material("glass", flags);
        if (present)
            map.add(rectangle({ 0, 0, 100 }, { 100, 0, 0 }, { 0, 100, 0 }), glass);
        start(map, { { "pt_bounces", "0" } });
        const std::vector<IrradianceProbe> probes(copies, { { 10, 5, 0 }, { 0, 0, 1 } });
        glm::vec3 sum(0);
        for (const glm::vec3& value : session_->probe(probes, 16))
            sum += value;
        session_ = nullptr;
        return sum.y / copies;
    }
};

TEST_F(Sheet, TranslucentOnesLetLightPass)
{
    const float open = light_through(0, false);
    EXPECT_GT(open, 0);
    EXPECT_EQ(light_through(0, true), 0);
    // Rays to the lamp meet the back of the pane, which colours by its front alone (Media.Glass*).
    for (const uint32_t flags : { uint32_t(formats::SURF_TRANS33), uint32_t(formats::SURF_TRANS66) })
        EXPECT_NEAR(light_through(flags, true), open, 1e-5f * open) << "flags " << flags;
    // A liquid takes more the longer the way is; nothing stops all of it.
    const float under_water = light_through(formats::SURF_TRANS66 | formats::SURF_WARP, true);
    EXPECT_LT(under_water, 0.9f * open);
    EXPECT_GT(under_water, 0.1f * open);
}

// The lamp behind the pane lights the pane's back alone: what the camera sees of it is what passes.
TEST_F(Visibility, TranslucentSurfacesAreSeenByTheirShare)
{
    MapBuilder map;
    map.add(rectangle({ 100, 0, 0 }, { 0, -300, 0 }, { 0, 0, 100 }), map.add_material("lamp", 0, 500));
    const std::pair<uint32_t, float> panes[]
        = { { formats::SURF_TRANS33, 1 / 3.0f }, { formats::SURF_TRANS66, 2 / 3.0f } };
    float place = -100;
    for (const auto& [flags, opacity] : panes) {
        map.add(rectangle({ 0, place, 0 }, { 0, -40, 0 }, { 0, 0, 40 }), map.add_material("glass", flags));
        place += 200;
    }
    // Without a sky, which the glass would mirror.
    start(map, { { "pt_bounces", "0" }, { "pt_roughness_default", "1" }, { "pt_sky_scale", "0" } });
    const auto seen_at = [&](float y) {
        session_->look({ -60, y, 0 }, { 0, y, 0 }, 20);
        return session_->accumulate(128).mean().y;
    };
    const float lamp = seen_at(0);
    EXPECT_GT(lamp, 0);
    place = -100;
    for (const auto& [flags, opacity] : panes) {
        // Smooth glass mirrors 2 r / (1 + r), r = 0.04 being Fresnel's reflectance, and colours the rest.
        const float passes = 1 - 0.08f / 1.04f, tint = 1 - opacity + opacity * linear_colour(glass_index).y;
        EXPECT_NEAR(seen_at(place) / lamp, passes * (1 - opacity) * tint, 0.012f) << "flags " << flags;
        place += 200;
    }
}

// A liquid's surface as map compilers make it: two faces in one plane that look away from each other, cut differently.
class Pool : public Visibility {
protected:
    static constexpr float height = 37.3f;

    void start_pool(uint32_t flags, const CvarList& cvars)
    {
        MapBuilder map;
        const uint16_t lava = map.add_material("lava", flags | formats::SURF_WARP | formats::SURF_LIGHT, 500);
        const glm::vec3 a(-90, -70, height), b(110, -80, height), c(100, 90, height), d(-85, 75, height);
        map.add({ a, b, c, d }, lava);
        map.add({ c, b, a, d }, lava);
        const uint16_t wall = map.add_material("wall");
        map.add(rectangle({ 110, 0, height }, { 0, 80, 0 }, { 0, 0, -30 }), wall);
        start(map, cvars);
    }

    bool sees_pool(glm::vec2 place) const
    {
        const CameraRay ray = camera_ray(session_->view, place);
        const float distance = (height - ray.origin.z) / ray.direction.z;
        const glm::vec3 met = ray.origin + ray.direction * distance;
        return distance > 0 && met.x > -80 && met.x < 90 && std::abs(met.y) < 60;
    }

    // Luminance of the pixels that show nothing but the liquid.
    std::vector<float> look_at_pool(float from_height, int frames)
    {
        session_->look({ -61.7f, 13.9f, height + from_height }, { 40, -10, height }, 50);
        std::vector<float> result;
        const Radiance picture = session_->accumulate(frames);
        for (int y = 0; y < picture.height; y++)
            for (int x = 0; x < picture.width; x++)
                if (sees_pool({ x, y }) && sees_pool({ x + 1, y }) && sees_pool({ x, y + 1 })
                    && sees_pool({ x + 1, y + 1 }))
                    result.push_back(luminance(picture.at(x, y)));
        return result;
    }
};

TEST_F(Pool, ShowsItsFrontFromBothSides)
{
    start_pool(0, { { "pt_bounces", "0" }, { "pt_roughness_default", "1" } });
    for (const float from : { 60.0f, 9.0f, -9.0f, -60.0f }) {
        const std::vector<float> seen = look_at_pool(from, 1);
        ASSERT_GT(seen.size(), 300) << from;
        const auto [least, greatest] = std::ranges::minmax(seen);
        EXPECT_GT(least, 0.9f * greatest) << "from " << from;
    }
}

// A third of the rays passes it, and meets nothing behind it: not its other face either.
TEST_F(Pool, IsPassedAsOneSurface)
{
    start_pool(formats::SURF_TRANS66, { { "pt_bounces", "0" }, { "pt_roughness_default", "1" } });
    for (const float from : { 60.0f, -60.0f }) {
        const std::vector<float> seen = look_at_pool(from, 64);
        ASSERT_GT(seen.size(), 300) << from;
        const auto [least, greatest] = std::ranges::minmax(seen);
        EXPECT_GT(least, 0.3f * greatest) << "from " << from;
    }
}

// What light sampling finds of it, rays find as well: otherwise MIS would lose light.
TEST_F(Pool, LightsAlikeByLightSamplingAndByRays)
{
    glm::vec3 light[2];
    const char* const samplers[2] = { "subset", "subset_mis" };
    for (int i = 0; i < 2; i++) {
        start_pool(0, { { "pt_bounces", "0" }, { "pt_light_sampler", samplers[i] } });
        session_->look({ 20, 3, height + 20 }, { 110, 0, height + 12 }, 40);
        light[i] = session_->accumulate(512).mean();
        session_ = nullptr;
    }
    EXPECT_GT(luminance(light[0]), 0);
    EXPECT_NEAR(luminance(light[1]), luminance(light[0]), 0.02f * luminance(light[0]));
}

TEST_F(Visibility, PreviewLeavesTheBackground)
{
    MapBuilder map;
    add_floor(map);
    start(map);
    session_->draw();
    session_->look({ 0, 0, 0 }, { 1, 0, 0 }, 60);
    const glm::vec3 place(50, 0, 0);
    const engine::Entity cube = make_entity(cube_, place);
    engine::RefDef preview = session_->view;
    preview.flags = engine::RDF_NOWORLDMODEL;
    preview.lightstyles = nullptr;
    preview.entities = &cube;
    preview.entity_count = 1;
    const engine::Exports8& module = session_->module();
    module.begin_frame(0);
    module.draw_fill(0, 0, preview.width, preview.height, green_index);
    module.render_frame(&preview);
    module.end_frame();
    const formats::Image picture = session_->capture_display();
    int shown = 0, background = 0;
    for (int y = 0; y < picture.height; y++)
        for (int x = 0; x < picture.width; x++) {
            const bool is_background = picture.at(x, y) == test_palette()[green_index];
            if (covers(place, x, y, -0.3f)) {
                shown++;
                EXPECT_FALSE(is_background) << "the model at " << x << ", " << y;
            } else if (!covers(place, x, y, 0.3f)) {
                background++;
                EXPECT_TRUE(is_background) << "the background at " << x << ", " << y;
            }
        }
    EXPECT_GT(shown, 50);
    EXPECT_GT(background, 500);
    // Lit, too: some of it is bright.
    EXPECT_GT(picture.at(picture.width / 2, picture.height / 2).r, 40);
}

TEST_F(Visibility, BeamsShine)
{
    MapBuilder map;
    add_floor(map);
    start(map, { { "pt_bounces", "0" } });
    constexpr float half_length = 60, height = 25, diameter = 4;
    engine::Entity beam = make_entity(nullptr, { -half_length, 0, height }, engine::RF_BEAM);
    beam.previous_origin[0] = half_length;
    beam.previous_origin[1] = 0;
    beam.previous_origin[2] = height;
    beam.frame = int32_t(diameter);
    beam.skin_number = white_index;
    session_->view.entities = &beam;
    session_->view.entity_count = 1;
    const std::vector<IrradianceProbe> probes(64, { { 0, 0, 0 }, { 0, 0, 1 } });
    glm::vec3 sum(0);
    for (const glm::vec3& value : session_->probe(probes, 64))
        sum += value / float(probes.size());
    // A cylinder of radiance 8 has the intensity 8 * diameter per length; half of it is seen under the angle phi.
    const float phi = std::atan(half_length / height);
    const float irradiance
        = 8 * diameter / height * (phi + std::sin(phi) * std::cos(phi)) * linear_colour(white_index).y;
    EXPECT_NEAR(sum.y, irradiance / 3.14159265f, 0.1f * sum.y); // a prism of six sides
    // And the camera sees it.
    session_->look({ -60, 0, 60 }, { 0, 0, 20 });
    EXPECT_GT(luminance(session_->capture().mean()), 0);
}

TEST_F(Visibility, ShellsOfPowerUpsShine)
{
    MapBuilder map;
    add_floor(map);
    start(map, { { "pt_bounces", "0" } });
    session_->look({ -60, 0, 60 }, { 0, 0, 0 });
    const auto floor_with = [&](const std::vector<engine::Entity>& entities) {
        return picture_with(entities).mean({ 0, 36 }, { 64, 48 });
    };
    EXPECT_EQ(luminance(floor_with({})), 0);
    const glm::vec3 red
        = floor_with({ make_entity(cube_, { 0, 0, 40 }, engine::RF_TRANSLUCENT | engine::RF_SHELL_RED) });
    EXPECT_GT(red.x, 1e-3f);
    EXPECT_EQ(red.z, 0);
}

// The player's model in a menu, over the game that goes on behind it.
TEST_F(Visibility, PreviewLeavesTheWorldOfItsFrame)
{
    MapBuilder map;
    add_floor(map);
    add_lamp(map);
    start(map);
    session_->look({ -60, 0, 60 }, { 0, 0, 10 });
    engine::RefDef world = session_->view;
    const std::array things { make_entity(cube_, { 0, 10, 10 }), make_entity(cube_, { 10, -20, 10 }) };
    const engine::DynamicLight light { { 20, 0, 40 }, { 1, 1, 1 }, 200 };
    world.entities = things.data();
    world.entity_count = int32_t(things.size());
    world.dlights = &light;
    world.dlight_count = 1;
    session_->look({ 0, 0, 0 }, { 1, 0, 0 }, 60);
    const engine::Entity cube = make_entity(cube_, { 50, 0, 0 });
    engine::RefDef preview = session_->view;
    preview.flags = engine::RDF_NOWORLDMODEL;
    preview.lightstyles = nullptr;
    preview.entities = &cube;
    preview.entity_count = 1;
    preview.x = preview.y = 0;
    preview.width = 16;
    preview.height = 12;
    const engine::Exports8& module = session_->module();
    formats::Image pictures[2];
    for (int i = 0; i < 2; i++) {
        module.begin_frame(0);
        module.render_frame(&world);
        if (i == 1)
            module.render_frame(&preview);
        module.end_frame();
        pictures[i] = session_->capture_display();
    }
    int different = 0;
    for (int y = 0; y < pictures[0].height; y++)
        for (int x = 0; x < pictures[0].width; x++)
            if (x >= preview.width || y >= preview.height)
                different += pictures[0].at(x, y) != pictures[1].at(x, y);
    EXPECT_EQ(different, 0);
}

} // namespace
} // namespace vkpt::tests

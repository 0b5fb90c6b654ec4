// SPDX-License-Identifier: GPL-2.0-or-later
// Normal maps in the picture: where they tilt surfaces, what their alpha says, and which files are read.
#include "common/colour.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr int side = 32; // texels of a map

class NormalMaps : public testing::Test {
protected:
    // A white floor. Its texture's u runs along x, its v against y.
    NormalMaps()
    {
        folder_.add_wall("floor", white_index);
        MapBuilder map;
        map.add(rectangle({ 0, 0, 0 }, { 256, 0, 0 }, { 0, 256, 0 }), map.add_material("floor"));
        map.add_point_light({ 4000, 0, 3000 }, 30000);
        folder_.add_map("floor", map.finish());
        folder_.add_map("next", map.finish());
        folder_.add_map("third", map.finish());
    }

    using Direction = std::function<glm::vec3(int x, int y)>;
    void add_normals(const std::string& file, const Direction& direction, uint8_t alpha = 255) const
    {
        formats::Image image { side, side, {} };
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                const glm::vec3 n = glm::round(glm::normalize(direction(x, y)) * 127.0f + 128.0f);
                image.pixels.push_back({ uint8_t(n.x), uint8_t(n.y), uint8_t(n.z), alpha });
            }
        folder_.add(file, file.ends_with(".png") ? formats::write_png(image) : formats::write_tga(image));
    }
    void add_tilt(glm::vec3 normal, uint8_t alpha = 255) const
    {
        add_normals(
            "textures/floor_n.tga", [&](int, int) { return normal; }, alpha);
    }
    Session open() const
    {
        return Session(
            folder_, { { "pt_bounces", "0" }, { "pt_roughness_default", "1" }, { "pt_light_sampler", "full" } });
    }
    static void look(Session& session, glm::vec3 eye = { 0, 1, 60 }) { session.look(eye, { 0, 0, 0 }, 20); }
    static double see(Session& session)
    {
        look(session);
        session.draw();
        return double(session.accumulate(8).mean().y);
    }
    // What a debug view shows in the middle, linear.
    static glm::vec3 show(Session& session, const std::string& view)
    {
        session.set("pt_debug_view", view);
        session.draw();
        const formats::Rgba8 shown = session.capture_display().at(32, 24);
        session.set("pt_debug_view", "off");
        const auto linear = [](uint8_t value) { return float(decode_srgb(double(value) / 255)); };
        return { linear(shown.r), linear(shown.g), linear(shown.b) };
    }
    static glm::vec3 find_normal(Session& session) { return show(session, "normal") * 2.0f - 1.0f; }
    static void expect_near(glm::vec3 found, glm::vec3 expected, float tolerance = 0.02f)
    {
        EXPECT_LT(glm::distance(found, expected), tolerance) << found.x << ' ' << found.y << ' ' << found.z;
    }

    GameFolder folder_;
};

TEST_F(NormalMaps, FlatOnesChangeNothing)
{
    Radiance plain;
    for (const bool mapped : { false, true }) {
        if (mapped)
            add_normals("textures/floor_n.tga", [](int, int) { return glm::vec3(0, 0, 1); });
        Session session = open();
        session.load_map("floor");
        look(session);
        session.draw();
        const Radiance seen = session.accumulate(2);
        if (mapped)
            EXPECT_NEAR(seen.mean().y / plain.mean().y, 1, 1e-4);
        else
            plain = seen;
    }
}

TEST_F(NormalMaps, TiltAlongTheTexturesAxes)
{
    const struct {
        glm::vec3 in_texture, in_world;
        double cosine; // to the light
    } cases[] = { { { 0.6f, 0, 0.8f }, { 0.6f, 0, 0.8f }, 0.96 }, { { -0.6f, 0, 0.8f }, { -0.6f, 0, 0.8f }, 0 },
        { { 0, 0.6f, 0.8f }, { 0, -0.6f, 0.8f }, 0.48 } };
    double flat = 0;
    {
        Session session = open();
        session.load_map("floor");
        flat = see(session);
    }
    for (const auto& one : cases) {
        add_tilt(one.in_texture);
        Session session = open();
        session.load_map("floor");
        look(session);
        expect_near(find_normal(session), one.in_world);
        EXPECT_NEAR(see(session) / flat, one.cosine / 0.6, 0.03) << one.in_texture.x << ' ' << one.in_texture.y;
    }
}

TEST_F(NormalMaps, AreScaledByMaterialAndCvar)
{
    add_tilt({ 0.6f, 0, 0.8f });
    folder_.add_text("maps/floor.mat", "floor:\n    bump_scale 0.5\n");
    Session session = open();
    session.load_map("floor");
    look(session);
    expect_near(find_normal(session), glm::normalize(glm::vec3(0.3f, 0, 0.9f)));
    session.set("pt_bump_scale", 2);
    expect_near(find_normal(session), { 0.6f, 0, 0.8f });
    session.set("pt_bump_scale", 0);
    expect_near(find_normal(session), { 0, 0, 1 });
}

// A tilt away from the viewer would show the surface from behind.
TEST_F(NormalMaps, AreBentToTheViewer)
{
    add_tilt({ 0.95f, 0, 0.31f });
    Session session = open();
    session.load_map("floor");
    for (const float height : { 4.0f, 20.0f }) {
        const glm::vec3 eye(-60, 0, height);
        look(session, eye);
        const glm::vec3 normal = find_normal(session);
        EXPECT_GT(glm::dot(normal, glm::normalize(eye)), -0.01) << normal.x << ' ' << normal.z;
        EXPECT_NEAR(glm::length(normal), 1, 0.02);
        EXPECT_GT(normal.x, 0.02) << "it still leans away";
    }
}

// Bumps of up to 60 degrees on white ground under a sky of one colour, seen from above and from the side: whatever the
// surface, no more light than falls on it comes back.
TEST_F(NormalMaps, NeverAddLight)
{
    add_normals("textures/floor_n.tga", [](int x, int y) {
        const int number = (x * 37 + y * 101) % 256;
        const float turn = float(number) * 0.0245f, lean = 0.87f * float((number * 29) % 256) / 255;
        return glm::vec3(lean * std::cos(turn), lean * std::sin(turn), std::sqrt(1 - lean * lean));
    });
    MapBuilder map;
    map.add_room({ -512, -512, -1 }, { 512, 512, 511 }, map.add_material("sky", formats::SURF_SKY));
    map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("floor"));
    folder_.add_map("open", map.finish());
    Session session = open();
    session.load_map("open");
    session.look({ 0, 0, 40 }, { 0, 1, 400 }, 20);
    session.draw();
    const double sky = double(session.capture().mean().y);
    for (const auto& [roughness, metallic] :
        { std::pair(1.0, 0.0), std::pair(0.3, 0.0), std::pair(0.6, 1.0), std::pair(0.15, 1.0) })
        for (const glm::vec3 eye : { glm::vec3(0, 1, 20), glm::vec3(-40, 0, 6) }) {
            session.set("pt_roughness_default", roughness);
            session.set("pt_metallic_default", metallic);
            session.look(eye, { 0, 0, 0 }, 10);
            session.draw();
            const double share = double(session.accumulate(128).mean().y) / sky;
            EXPECT_LT(share, 1.005) << roughness << ' ' << metallic << ' ' << eye.z;
            EXPECT_GT(share, 0.6) << roughness << ' ' << metallic << ' ' << eye.z;
        }
}

TEST_F(NormalMaps, TellMetalnessAndTheTextureRoughness)
{
    const struct EndOfModule {
        ~EndOfModule() { Session::end_idle(); }
    } edits_last_as_long_as_the_module;
    add_tilt({ 0, 0, 1 }, 128);
    formats::Image picture { side, side, std::vector<formats::Rgba8>(side * side, { 255, 255, 255, 102 }) };
    folder_.add("textures/floor.tga", formats::write_tga(picture));
    Session session = open();
    session.load_map("floor");
    look(session);
    expect_near(show(session, "roughness"), { 0.4f, 0.5f, 0 });
    session.host().run_text("mat metalness_factor 0.5\nmat roughness_override 0.6\n"); // the least that counts
    expect_near(show(session, "roughness"), { 0.6f, 0.25f, 0 });
    session.host().run_text("mat metalness_override 1\n");
    expect_near(show(session, "roughness"), { 0.6f, 1, 0 });
}

// Bumps that are too far away to be seen make the surface rougher.
TEST_F(NormalMaps, BecomeRoughnessInTheDistance)
{
    add_normals("textures/floor_n.tga", [](int x, int) { return glm::vec3(x % 2 ? 0.3f : -0.3f, 0, 1); });
    Session session = open();
    session.set("pt_roughness_default", 0.2);
    session.load_map("floor");
    look(session, { 0, 1, 8 });
    expect_near(show(session, "roughness"), { 0.2f, 0, 0 });
    look(session, { 0, 30, 1500 });
    // 1 / sqrt(1.09) long: alpha^2 = 0.2^4 + 2 (1 - l) / l.
    const double variance = std::sqrt(1.09) - 1;
    expect_near(show(session, "roughness"), { std::pow(std::pow(0.2, 4) + 2 * variance, 0.25), 0, 0 }, 0.03f);
}

TEST_F(NormalMaps, AreNamedByMaterials)
{
    add_normals("bumps/steep.png", [](int, int) { return glm::vec3(0.6f, 0, 0.8f); });
    add_normals("textures/floor_n.tga", [](int, int) { return glm::vec3(0, 0.6f, 0.8f); });
    formats::Image picture { 64, 64, std::vector<formats::Rgba8>(64 * 64, { 0, 255, 0, 255 }) };
    folder_.add("bumps/green.png", formats::write_png(picture));
    std::ranges::fill(picture.pixels, formats::Rgba8 { 255, 0, 0, 255 });
    folder_.add("bumps/red.png", formats::write_png(picture));
    folder_.add_text(
        "materials/baseq2.mat", "textures/floor:\n    texture_normals bumps/steep.tga\n    texture_base bumps/green\n");
    folder_.add_text("maps/next.mat", "floor:\n    texture_normals bumps/none\n    texture_base bumps/red\n");
    folder_.add_text("maps/third.mat", "floor:\n    texture_normals 0\n");
    Session session = open();
    session.load_map("floor");
    look(session);
    expect_near(find_normal(session), { 0.6f, 0, 0.8f });
    expect_near(show(session, "albedo"), { 0, 1, 0 });
    // What the next map's materials say counts for textures that are there already.
    session.load_map("next");
    EXPECT_TRUE(session.has_line("texture_normals bumps/none of floor is missing or unusable"));
    look(session);
    expect_near(find_normal(session), { 0, 0, 1 });
    expect_near(show(session, "albedo"), { 1, 0, 0 });
    // 0: none, whatever lies beside the texture and whatever files before say.
    session.load_map("third");
    look(session);
    expect_near(find_normal(session), { 0, 0, 1 });
    EXPECT_FALSE(session.has_line("texture_normals 0 of floor"));
}

TEST_F(NormalMaps, AreNamedAfterTheirMaterial)
{
    add_normals("overrides/floor_n.png", [](int, int) { return glm::vec3(0.6f, 0, 0.8f); });
    folder_.add_text("materials/baseq2.mat", "textures/floor:\n    texture_normals overrides/*_n.tga\n");
    Session session = open();
    session.load_map("floor");
    look(session);
    expect_near(find_normal(session), { 0.6f, 0, 0.8f });
}

TEST_F(NormalMaps, DamagedOnesAreNamedAndLeftOut)
{
    folder_.add_text("textures/floor_n.png", "\x89PNG no more");
    Session session = open();
    session.load_map("floor");
    EXPECT_TRUE(session.has_line("textures/floor_n.png is damaged at byte"));
    look(session);
    expect_near(find_normal(session), { 0, 0, 1 });
}

// A skin's lies along its triangles' uv: on the cube's top as on the floor.
TEST_F(NormalMaps, TiltModels)
{
    const std::string cube = folder_.add_cube("cube", 8, white_index);
    add_normals("models/cube_n.tga", [](int, int) { return glm::vec3(0.6f, 0, 0.8f); });
    Session session = open();
    session.load_map("floor");
    engine::Entity entity = make_entity(session.module().register_model(cube.c_str()), { 0, 0, 30 });
    session.view.entities = &entity;
    session.view.entity_count = 1;
    look(session);
    session.set("pt_bump_scale", 0);
    const glm::vec3 smooth = find_normal(session); // between those of the corners, which MD2 has few of
    const glm::vec3 along = glm::normalize(glm::vec3(1, 0, 0) - smooth * smooth.x);
    session.set("pt_bump_scale", 1);
    expect_near(find_normal(session), along * 0.6f + smooth * 0.8f, 0.03f);
}

} // namespace
} // namespace vkpt::tests

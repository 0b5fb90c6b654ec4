// SPDX-License-Identifier: GPL-2.0-or-later
// Lamps that are switched, that flicker, and whose pictures change: what they light and what is seen of them go
// together.
#include "ref_vkpt/lights/emitters.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <numbers>
#include <utility>

namespace vkpt::tests {
namespace {

// Of a square of 32 at a distance of 100: four times that of a corner's, 1 / pi * x / sqrt(1 + x^2) * atan(x / sqrt(1 +
// x^2)), x = .16.
constexpr double form_factor = 0.031522;

class Lamps : public testing::Test {
protected:
    // A lamp of 32 x 32 that faces down, 100 over the floor.
    Lamps()
    {
        folder_.add_wall("floor", white_index);
        folder_.add_wall("lamp", white_index);
        folder_.add_wall("dark", white_index);
        lamp_ = map_.add_material("lamp", formats::SURF_LIGHT, 500);
        dark_ = map_.add_material("dark");
        map_.add(rectangle({ 0, 0, 0 }, { 200, 0, 0 }, { 0, 200, 0 }), map_.add_material("floor"));
    }
    void add_lamp(uint16_t material) { map_.add(rectangle({ 0, 0, 100 }, { 0, 16, 0 }, { 16, 0, 0 }), material); }
    // A lamp that goes with this lightstyle.
    static constexpr int switched = 40;
    void add_switched_map()
    {
        add_lamp(lamp_);
        formats::Bsp bsp = map_.finish();
        for (formats::BspFace& face : bsp.faces)
            if (face.texinfo == lamp_)
                face.styles[1] = switched;
        folder_.add_map("lamps", bsp);
    }
    // The dark picture and the lamp's take turns.
    void add_animated_map()
    {
        formats::Bsp bsp = map_.finish();
        bsp.texinfos[dark_].next = lamp_;
        bsp.texinfos[lamp_].next = dark_;
        folder_.add_map("lamps", bsp);
    }

    struct Light {
        double on_floor; // irradiance / pi below the lamp
        double seen; // radiance
    };
    static Light measure(Session& session)
    {
        session.look({ 0, 0, 60 }, { 0, 0, 100 }, 20);
        session.draw();
        Light light { 0, double(session.capture().mean().y) };
        const std::vector<IrradianceProbe> probes(64, { { 0, 0, 0 }, { 0, 0, 1 } });
        for (const glm::vec3& measured : session.probe(probes, 64))
            light.on_floor += double(measured.y) / double(probes.size());
        return light;
    }

    MapBuilder map_;
    GameFolder folder_;
    uint16_t lamp_ = 0, dark_ = 0;
};

TEST_F(Lamps, GoWithTheirSwitch)
{
    add_switched_map();
    Session session(folder_, matte);
    session.load_map("lamps");
    const Light on = measure(session);
    EXPECT_NEAR(on.seen, 500 * 0.0095, 0.05);
    EXPECT_NEAR(on.on_floor / on.seen, form_factor, 0.0003);
    session.light_style(switched, 0.25f);
    const Light dim = measure(session);
    EXPECT_NEAR(dim.on_floor / on.on_floor, 0.25, 0.005);
    EXPECT_NEAR(dim.seen / on.seen, 0.25, 0.005);
    session.light_style(switched, 0);
    const Light off = measure(session);
    EXPECT_EQ(off.on_floor, 0);
    EXPECT_EQ(off.seen, 0);
    session.light_style(switched, 1);
    session.light_style(0, 0); // another one's
    EXPECT_NEAR(measure(session).on_floor / on.on_floor, 1, 0.005);
}

// The shell of what is not solid has two faces in each plane, one to be seen from inside.
TEST_F(Lamps, ShellsShineAllOver)
{
    const glm::vec3 across(3, 16, 5), along(16, -2, -3);
    map_.add(rectangle({ 0, 0, 100 }, across, along), lamp_);
    map_.add(
        rectangle(glm::vec3(0, 0, 100) + 0.125f * across, along * 1.25f, across * 1.25f), lamp_); // of a larger piece
    folder_.add_map("lamps", map_.finish());
    Session session(folder_, matte);
    session.load_map("lamps");
    session.look({ 7, 3, 60 }, { 0, 0, 100 }, 20);
    session.draw();
    const Radiance picture = session.capture();
    const auto is_dark = [](glm::vec3 pixel) { return pixel.y < 500 * 0.0095f - 0.05f; };
    EXPECT_EQ(std::ranges::count_if(picture.pixels, is_dark), 0);
}

TEST_F(Lamps, ShineAsTheShownPictureSays)
{
    add_lamp(dark_);
    add_animated_map();
    Session session(folder_, matte);
    session.load_map("lamps");
    session.view.time = 0.1f;
    const Light dark = measure(session);
    EXPECT_EQ(dark.on_floor, 0);
    EXPECT_EQ(dark.seen, 0);
    session.view.time = 0.6f;
    const Light lit = measure(session);
    EXPECT_NEAR(lit.on_floor / lit.seen, form_factor, 0.0003);
    session.view.time = 1.1f;
    EXPECT_EQ(measure(session).on_floor, 0);
}

// One bright square of 8 x 8 texels in a dark picture of 32 x 32 on a face without a light value: it shines where a
// cvar or a material says so, and nothing else does.
TEST_F(Lamps, GlowWhereTheirPictureIsBright)
{
    formats::IndexedImage picture { 32, 32, std::vector<uint8_t>(32 * 32, 0), {} };
    for (size_t y = 8; y < 16; y++)
        std::fill_n(picture.pixels.begin() + long(y * 32 + 8), 8, white_index);
    folder_.add("textures/spot.wal", formats::write_wal(picture, {}));
    add_lamp(map_.add_material("spot"));
    folder_.add_map("lamps", map_.finish());
    const double average = double(EmissionScales().glow) / 16;
    double on_floor = 0;
    {
        Session session(folder_, matte);
        session.load_map("lamps");
        EXPECT_EQ(measure(session).on_floor, 0);
        session.set("pt_glow_threshold", 215);
        session.load_map("lamps");
        on_floor = measure(session).on_floor;
        EXPECT_NEAR(on_floor / (average * form_factor), 1, 0.05);
        session.look({ 0, 0, 60 }, { 0, 0, 100 }, 43); // the lamp and nothing else
        session.draw();
        EXPECT_GT(session.capture().mean().y, 0.3 * average);
    }
    folder_.add_text("maps/lamps.mat", "spot:\n    synth_emissive 1\n");
    Session session(folder_, matte);
    session.load_map("lamps");
    EXPECT_NEAR(measure(session).on_floor / on_floor, 1, 0.02);
}

class Emission : public Lamps {
protected:
    // A square of this colour of `from` to `to` texels in a black picture of 32 x 32.
    void add_light(const std::string& file, formats::Rgba8 colour, int from = 0, int to = 32) const
    {
        formats::Image picture { 32, 32, std::vector<formats::Rgba8>(32 * 32, { 0, 0, 0, 255 }) };
        for (int y = from; y < to; y++)
            for (int x = from; x < to; x++)
                picture.pixels[size_t(y) * 32 + size_t(x)] = colour;
        folder_.add(file, formats::write_tga(picture));
    }
    // Of a wall "board", which is grey, over the floor.
    Light measure_board(uint32_t flags = 0, int value = 0)
    {
        folder_.add_wall("board", 128);
        MapBuilder map;
        map.add(rectangle({ 0, 0, 0 }, { 200, 0, 0 }, { 0, 200, 0 }), map.add_material("floor"));
        map.add(rectangle({ 0, 0, 100 }, { 0, 16, 0 }, { 16, 0, 0 }), map.add_material("board", flags, value));
        folder_.add_map("board", map.finish());
        Session session(folder_, matte);
        session.load_map("board");
        return measure(session);
    }
};

// A picture of what glows makes a wall shine that the map gives no light value: as a whole where it is bright all over.
TEST_F(Emission, OfAWallIsWhatItsPictureShows)
{
    EXPECT_EQ(measure_board().seen, 0);
    add_light("textures/board_light.tga", { 255, 255, 255, 255 });
    const Light light = measure_board();
    EXPECT_NEAR(light.seen, double(EmissionScales().glow), 0.02);
    EXPECT_NEAR(light.on_floor / light.seen, form_factor, 0.0003);
    folder_.add_text("maps/board.mat", "board:\n    emissive_factor 0.5\n");
    const Light half = measure_board();
    EXPECT_NEAR(half.seen / light.seen, 0.5, 0.01);
    EXPECT_NEAR(half.on_floor / light.on_floor, 0.5, 0.01);
}

// Its bright parts are lamps of their own.
TEST_F(Emission, ComesFromThePicturesBrightParts)
{
    folder_.add_text("maps/board.mat", "board:\n    texture_emissive glow/spot\n");
    add_light("glow/spot.tga", { 255, 255, 255, 255 }, 8, 16);
    const Light light = measure_board();
    EXPECT_NEAR(light.on_floor / (double(EmissionScales().glow) / 16 * form_factor), 1, 0.05);
}

// The light value says how much a lamp sends, its picture from where.
TEST_F(Emission, OfALampIsItsLightValue)
{
    const Light plain = measure_board(formats::SURF_LIGHT, 500);
    add_light("textures/board_light.tga", { 128, 128, 128, 255 });
    const Light mapped = measure_board(formats::SURF_LIGHT, 500);
    EXPECT_NEAR(mapped.seen / plain.seen, 1, 0.02);
    EXPECT_NEAR(mapped.on_floor / plain.on_floor, 1, 0.02);
    add_light("textures/board_light.tga", { 0, 0, 0, 255 }); // shows nothing: as if it were not there
    EXPECT_NEAR(measure_board(formats::SURF_LIGHT, 500).on_floor / plain.on_floor, 1, 0.02);
}

// A material may say that a lamp shines by its picture alone, how bright that is, and that it is steady.
TEST_F(Emission, GoesWithTheMaterial)
{
    const double plain = measure_board(formats::SURF_LIGHT, 500).seen;
    folder_.add_text("maps/board.mat", "board:\n    default_radiance 3\n");
    EXPECT_NEAR(measure_board(formats::SURF_LIGHT, 500).seen / plain, 1, 0.01);
    EXPECT_EQ(measure_board().seen, 0);
    folder_.add_text("maps/board.mat", "board:\n    bsp_radiance 0\n    default_radiance 3\n");
    add_light("textures/board_light.tga", { 255, 255, 255, 255 });
    for (const Light light : { measure_board(formats::SURF_LIGHT, 500), measure_board() }) {
        EXPECT_NEAR(light.seen, 3 * double(EmissionScales().glow), 0.06);
        EXPECT_NEAR(light.on_floor / light.seen, form_factor, 0.0003);
    }
    folder_.add_text("maps/lamps.mat", "lamp:\n    light_styles 0\n");
    add_switched_map();
    Session session(folder_, matte);
    session.load_map("lamps");
    session.light_style(switched, 0);
    const Light steady = measure(session);
    EXPECT_NEAR(steady.seen, 500 * 0.0095, 0.05);
    EXPECT_NEAR(steady.on_floor / steady.seen, form_factor, 0.0003);
}

// A model's skin glows, and bounce rays find it.
TEST_F(Emission, OfSkinsIsSeenAndBounces)
{
    const std::string cube = folder_.add_cube("cube", 8, 0);
    folder_.add_map("lamps", map_.finish());
    double on_floor[2] {};
    for (const bool mapped : { false, true }) {
        if (mapped) {
            Session::end_idle();
            add_light("models/cube_light.tga", { 0, 255, 0, 255 });
            folder_.add_text("materials/baseq2.mat", "models/cube:\n    emissive_factor 4\n");
        }
        Session session(folder_, { { "pt_bounces", "1" }, { "pt_roughness_default", "1" } });
        session.load_map("lamps");
        engine::Entity entity = make_entity(session.module().register_model(cube.c_str()), { 0, 0, 12 });
        session.view.entities = &entity;
        session.view.entity_count = 1;
        session.look({ 0, 1, 60 }, { 0, 0, 0 }, 10); // on the cube
        session.draw();
        const glm::vec3 seen = session.capture().mean();
        EXPECT_NEAR(seen.y, mapped ? 4 * EmissionScales().glow : 0, 0.1f);
        EXPECT_NEAR(seen.x, 0, 1e-3f);
        session.look({ 30, 1, 60 }, { 30, 0, 0 }, 10); // beside it
        session.draw();
        on_floor[mapped] = double(session.accumulate(64).mean().y);
    }
    EXPECT_EQ(on_floor[0], 0);
    EXPECT_GT(on_floor[1], 0.02);
}

// Irradiance / pi on a floor, in shares of the radiance of a cube's sides: over 64 x 64 parts of each.
double form_factor_of_cube(glm::vec3 centre, float half, glm::vec3 floor)
{
    constexpr int parts = 64;
    double sum = 0;
    for (int side = 0; side < 6; side++) {
        glm::vec3 normal(0), across(0), down(0);
        normal[side / 2] = side % 2 ? 1.0f : -1.0f;
        across[(side / 2 + 1) % 3] = down[(side / 2 + 2) % 3] = half;
        for (int i = 0; i < parts * parts; i++) {
            const float u = (float(i % parts) + 0.5f) / parts * 2 - 1, v = (float(i / parts) + 0.5f) / parts * 2 - 1;
            const glm::vec3 way = centre + normal * half + across * u + down * v - floor;
            const double distance2 = double(glm::dot(way, way)),
                         cosines = double(way.z) * double(-glm::dot(way, normal));
            if (way.z > 0 && glm::dot(way, normal) < 0)
                sum += cosines / (distance2 * distance2) * 4 * half * half / (parts * parts);
        }
    }
    return sum / std::numbers::pi;
}

// What glows of a skin is sampled as a light, wherever the model goes; the weapon before the eye is none.
TEST_F(Emission, OfSkinsIsALamp)
{
    const std::string cube = folder_.add_cube("cube", 8, 0);
    folder_.add_map("lamps", map_.finish());
    Session::end_idle();
    add_light("models/cube_light.tga", { 0, 255, 0, 255 });
    folder_.add_text("materials/baseq2.mat", "models/cube:\n    emissive_factor 4\n");
    Session session(folder_, matte);
    session.load_map("lamps");
    engine::Entity entity = make_entity(session.module().register_model(cube.c_str()), { 0, 0, 12 });
    session.view.entities = &entity;
    session.view.entity_count = 1;
    const glm::vec3 floor(30, 0, 0);
    const std::vector<IrradianceProbe> probes(256, { floor, { 0, 0, 1 } });
    const auto light_floor = [&] {
        session.look({ 0, 1, 60 }, { 0, 0, 0 }, 10);
        session.draw();
        double sum = 0;
        for (const glm::vec3& measured : session.probe(probes, 64))
            sum += double(measured.y) / double(probes.size());
        return sum;
    };
    const double radiance = 4 * double(EmissionScales().glow);
    for (const char* sampler : { "full", "subset", "subset_mis" })
        for (const float x : { 0.0f, 14.0f, -20.0f }) {
            session.set("pt_light_sampler", sampler);
            entity.origin[0] = entity.previous_origin[0] = x;
            const double expected = radiance * form_factor_of_cube({ x, 0, 12 }, 8, floor);
            EXPECT_NEAR(light_floor() / expected, 1, 0.02) << sampler << ' ' << x;
        }
    entity.flags |= engine::RF_WEAPONMODEL;
    EXPECT_EQ(light_floor(), 0);
}

// Where no picture says what of a skin glows, a material may choose its bright texels.
TEST_F(Emission, OfSkinsIsTheirBrightTexels)
{
    const std::string white = folder_.add_cube("white", 8, white_index), grey = folder_.add_cube("grey", 8, 128);
    folder_.add_map("lamps", map_.finish());
    Session::end_idle();
    folder_.add_text(
        "materials/baseq2.mat", "models/white,\nmodels/grey:\n    synth_emissive 1\n    emissive_factor 3\n");
    Session session(folder_, matte);
    session.load_map("lamps");
    for (const auto& [cube, glow] : { std::pair(white, 3 * EmissionScales().glow), std::pair(grey, 0.0f) }) {
        engine::Entity entity = make_entity(session.module().register_model(cube.c_str()), { 0, 0, 12 });
        session.view.entities = &entity;
        session.view.entity_count = 1;
        session.look({ 0, 1, 60 }, { 0, 0, 0 }, 10);
        session.draw();
        EXPECT_NEAR(session.capture().mean().y, glow, 0.1f) << cube;
    }
}

// A button's picture is chosen by its entity's frame.
TEST_F(Lamps, OnButtonsShineByFrame)
{
    map_.begin_brush_model();
    add_lamp(dark_);
    add_animated_map();
    Session session(folder_, matte);
    session.load_map("lamps");
    engine::Entity button = make_entity(session.module().register_model("*1"), {});
    session.view.entities = &button;
    session.view.entity_count = 1;
    for (const int frame : { 0, 1, 2 }) {
        button.frame = frame;
        const Light light = measure(session);
        EXPECT_EQ(light.on_floor > 0, frame == 1) << frame;
        EXPECT_EQ(light.seen > 0, frame == 1) << frame;
    }
}

} // namespace
} // namespace vkpt::tests

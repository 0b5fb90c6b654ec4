// SPDX-License-Identifier: GPL-2.0-or-later
// The sky as the camera sees it, and what it lights.
#include "ref_vkpt/lights/emitters.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

struct Side {
    const char* ending;
    glm::vec3 direction;
    uint8_t index; // palette entry of its picture
};
// As the engine's own renderers place them.
constexpr Side sides[]
    = { { "rt", { 1, 0, 0 }, red_index }, { "bk", { 0, 1, 0 }, green_index }, { "lf", { -1, 0, 0 }, blue_index },
          { "ft", { 0, -1, 0 }, 128 }, { "up", { 0, 0, 1 }, 200 }, { "dn", { 0, 0, -1 }, 60 } };

class Sky : public testing::Test {
protected:
    Sky()
    {
        for (const Side& side : sides) {
            const formats::Rgba8 colour = test_palette()[side.index];
            const formats::Image image { 8, 8, std::vector<formats::Rgba8>(64, colour) };
            folder_.add(std::string("env/test") + side.ending + ".tga", formats::write_tga(image));
        }
        folder_.add_wall("wall", white_index);
    }

    GameFolder folder_;
};

// The colour of a palette entry times `scale`, as exactly as drivers decode pictures.
void expect_colour(glm::vec3 seen, uint8_t index, float scale, const char* what)
{
    const glm::vec3 low = linear_colour(index, -0.5f) * scale, high = linear_colour(index, 0.5f) * scale;
    for (int i = 0; i < 3; i++) {
        EXPECT_GE(seen[i], low[i]) << what << ", channel " << i;
        EXPECT_LE(seen[i], high[i]) << what << ", channel " << i;
    }
}

TEST_F(Sky, EachSideIsWhereItBelongs)
{
    MapBuilder map;
    map.add_room(glm::vec3(-256), glm::vec3(256), map.add_material("sky", formats::SURF_SKY));
    folder_.add_map("sky", map.finish());
    Session session(folder_);
    session.load_map("sky", "test");
    for (const double scale : { 1.0, 2.5 }) {
        session.set("pt_sky_scale", scale);
        for (const Side& side : sides) {
            session.look({ 0, 0, 0 }, side.direction, 60);
            session.draw();
            expect_colour(session.capture().mean(), side.index, EmissionScales().sky * float(scale), side.ending);
        }
    }
}

// Counter-clockwise around the axis that the map gives, by so many degrees a second.
TEST_F(Sky, TurnsAsTheMapSays)
{
    MapBuilder map;
    map.add_room(glm::vec3(-256), glm::vec3(256), map.add_material("sky", formats::SURF_SKY));
    folder_.add_map("sky", map.finish());
    Session session(folder_);
    session.load_map("sky", "test");
    struct Turn {
        float degrees_per_second, axis[3], time;
        glm::vec3 looked_along;
        size_t side; // what is seen there
    };
    const Turn turns[] = { { 30, { 0, 0, 1 }, 0, { 0, 1, 0 }, 1 }, { 30, { 0, 0, 1 }, 3, { 0, 1, 0 }, 0 },
        { 30, { 0, 0, 1 }, 3, { 1, 0, 0 }, 3 }, { 45, { 0, 0, 1 }, 6, { 0, -1, 0 }, 0 },
        { -30, { 0, 0, 1 }, 3, { 0, -1, 0 }, 0 }, { 30, { 0, 0, 5 }, 3, { 0, 1, 0 }, 0 },
        { 90, { 1, 0, 0 }, 1, { 0, 0, 1 }, 1 }, { 90, { 1, 0, 0 }, 1, { 1, 0, 0 }, 0 },
        { 90, { 0, 1, 0 }, 1, { 0, 0, -1 }, 0 } };
    for (const Turn& turn : turns) {
        session.module().set_sky("test", turn.degrees_per_second, turn.axis);
        session.module().end_registration();
        session.view.time = turn.time;
        session.look({ 0, 0, 0 }, turn.looked_along, 60);
        session.draw();
        const Side& side = sides[turn.side];
        expect_colour(session.capture().mean(), side.index, EmissionScales().sky, side.ending);
    }
}

// A floor under an open sky of one colour all around: the sky fills the hemisphere, so white reflects what is above.
TEST_F(Sky, LightsWhatItSees)
{
    MapBuilder map;
    map.add_room({ -512, -512, -1 }, { 512, 512, 511 }, map.add_material("sky", formats::SURF_SKY));
    map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("wall"));
    folder_.add_map("sky", map.finish());
    Session session(folder_, { { "pt_bounces", "0" }, { "pt_roughness_default", "1" } });
    session.load_map("sky", "plain"); // no such pictures: one plain colour
    EXPECT_TRUE(session.has_line("a plain one is shown"));
    session.look({ 0, 0, 0.5f }, { 0, 0, 400 });
    session.draw();
    const glm::vec3 sky = session.capture().mean();
    EXPECT_GT(sky.x, 0);
    session.look({ 0, 0, 30 }, { 1, 0, 0 }, 60);
    const glm::vec3 floor = session.accumulate(256).mean();
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(floor[i] / sky[i], 1, 0.005f) << "channel " << i;
}

TEST_F(Sky, IsBehindEverything)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 64, 0, 0 }, { 0, 64, 0 }), map.add_material("wall"));
    folder_.add_map("open", map.finish());
    Session session(folder_);
    session.load_map("open", "test");
    session.look({ 0, 0, 32 }, { 100, 0, 32 }, 60);
    session.draw();
    expect_colour(session.capture().mean({ 0, 0 }, { 64, 20 }), red_index, EmissionScales().sky, "beside the map");
}

} // namespace
} // namespace vkpt::tests

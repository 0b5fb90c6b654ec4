// SPDX-License-Identifier: GPL-2.0-or-later
// pt_projection: where each projection shows a direction, and that it shows there what a perspective picture does.
#include "ref_vkpt/scene/projection.hpp"
#include "shaders/shared/functions.h"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <numbers>

namespace vkpt::shaders {

using namespace vkpt::shared;
using namespace glm;
#include "shaders/lib/projection.glsl"

} // namespace vkpt::shaders

namespace vkpt::tests {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr int kinds = shared::PROJECTION_EQUIRECTANGULAR + 1;
constexpr const char* names[kinds]
    = { "perspective", "panini", "stereographic", "fisheye", "cylindrical", "mercator", "equirectangular" };

// From the definitions: where the plane shows a direction to the right, up and forward. Its unit is a radian.
glm::dvec2 project(int kind, glm::dvec3 d)
{
    const double aside = std::hypot(d.x, d.y), angle = std::atan2(aside, d.z);
    const double longitude = std::atan2(d.x, d.z), latitude = std::atan2(d.y, std::hypot(d.x, d.z));
    const glm::dvec2 around = aside > 0 ? glm::dvec2(d.x, d.y) / aside : glm::dvec2(0);
    switch (kind) {
    case shared::PROJECTION_PANINI:
        return glm::dvec2(std::sin(longitude), std::tan(latitude)) * (2 / (1 + std::cos(longitude)));
    case shared::PROJECTION_STEREOGRAPHIC:
        return around * (2 * std::tan(angle / 2));
    case shared::PROJECTION_FISHEYE:
        return around * angle;
    case shared::PROJECTION_CYLINDRICAL:
        return { longitude, std::tan(latitude) };
    case shared::PROJECTION_MERCATOR:
        return { longitude, std::asinh(std::tan(latitude)) };
    case shared::PROJECTION_EQUIRECTANGULAR:
        return { longitude, latitude };
    default:
        return { d.x / d.z, d.y / d.z };
    }
}

TEST(ProjectionFormulas, LeadThereAndBack)
{
    constexpr float pixels = 2048, widest[kinds] = { 150, 300, 300, 340, 350, 350, 360 };
    for (int kind = 0; kind < kinds; kind++) {
        const float width = plane_half_width(kind, widest[kind]);
        EXPECT_NEAR(fov_of_half_width(kind, width), widest[kind], 1e-2f) << names[kind];
        for (float x = -0.98f; x < 1; x += 0.07f)
            for (float y = -0.48f; y < 0.5f; y += 0.06f) {
                const glm::vec2 place(x * width, y * width);
                if (kind == shared::PROJECTION_FISHEYE && glm::length(place) > 3)
                    continue; // farther than all around
                const glm::vec3 seen = shaders::unproject(kind, place);
                EXPECT_NEAR(kind == shared::PROJECTION_PERSPECTIVE ? seen.z : glm::length(seen), 1, 1e-5f);
                const glm::dvec2 apart = (project(kind, seen) - glm::dvec2(place)) * double(pixels / 2 / width);
                EXPECT_LT(glm::length(apart), 1e-3) << names[kind] << " at " << x << ", " << y;
            }
        EXPECT_LT(glm::distance(shaders::unproject(kind, {}), glm::vec3(0, 0, 1)), 1e-6f) << names[kind];
    }
}

TEST(ProjectionFormulas, UprightsStayStraight)
{
    for (const int kind : { shared::PROJECTION_PANINI, shared::PROJECTION_CYLINDRICAL, shared::PROJECTION_MERCATOR })
        for (const float y : { -1.0f, 0.3f, 1.5f }) {
            const glm::vec3 seen = shaders::unproject(kind, { 1.2f, y }), level = shaders::unproject(kind, { 1.2f, 0 });
            EXPECT_NEAR(std::atan2(seen.x, seen.z), std::atan2(level.x, level.z), 1e-5f) << names[kind];
        }
}

class Projections : public testing::Test {
protected:
    void start(glm::ivec2 size)
    {
        session_ = std::make_unique<Session>(
            folder_, CvarList { { "pt_bounces", "0" }, { "pt_sky_scale", "0" }, { "pt_player_body", "0" } }, size);
    }

    void turn(float pitch, float yaw)
    {
        session_->view.view_angles[0] = pitch;
        session_->view.view_angles[1] = yaw;
    }

    Radiance photograph(int kind, float fov, int frames)
    {
        session_->set("pt_projection", names[kind]);
        session_->set("pt_projection_fov", fov);
        return session_->accumulate(frames);
    }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
};

glm::vec2 centre_of_light(const Radiance& picture)
{
    double sum = 0;
    glm::dvec2 place(0);
    for (int y = 0; y < picture.height; y++)
        for (int x = 0; x < picture.width; x++) {
            const double light = picture.at(x, y).y;
            sum += light;
            place += light * glm::dvec2(x + 0.5, y + 0.5);
        }
    EXPECT_GT(sum, 0);
    return place / sum;
}

// A small lamp straight ahead of a player who looks elsewhere.
TEST_F(Projections, ShowEachDirectionWhereTheyShould)
{
    constexpr int width = 128, height = 64;
    folder_.add_wall("lamp", white_index);
    MapBuilder map;
    map.add(rectangle({ 100, 0, 0 }, { 0, 0, 4 }, { 0, 4, 0 }), map.add_material("lamp", 0, 1000));
    folder_.add_map("dark", map.finish());
    start({ width, height });
    session_->load_map("dark");
    session_->look({ 0, 0, 0 }, { 1, 0, 0 });
    constexpr float widest[kinds] = { 120, 240, 240, 340, 350, 350, 360 };
    for (int kind = 0; kind < kinds; kind++)
        for (const glm::vec2 turned : { glm::vec2(0, 0), glm::vec2(12, 35), glm::vec2(-14, -75), glm::vec2(20, 140) }) {
            if (std::abs(turned.y) > widest[kind] / 2 - 10)
                continue;
            turn(turned.x, turned.y);
            const glm::vec2 found = centre_of_light(photograph(kind, widest[kind], 24));
            const glm::vec2 a = glm::radians(turned);
            const glm::vec3 ahead(std::sin(a.y), std::sin(a.x) * std::cos(a.y), std::cos(a.x) * std::cos(a.y));
            const float half = kind == shared::PROJECTION_EQUIRECTANGULAR ? pi : plane_half_width(kind, widest[kind]);
            const glm::vec2 place = project(kind, ahead) * double(width / 2 / half);
            EXPECT_NEAR(found.x, width / 2 + place.x, 0.2f) << names[kind] << ", turned by " << turned.y;
            EXPECT_NEAR(found.y, height / 2 - place.y, 0.2f) << names[kind] << ", turned by " << turned.y;
        }
}

TEST_F(Projections, ShowWhatAPerspectivePictureOfThePlaceDoes)
{
    constexpr int width = 96, height = 48, frames = 160;
    folder_.add_wall("wall", 180);
    folder_.add_wall("lamp", white_index);
    MapBuilder map;
    map.add_lit_room("wall");
    folder_.add_map("room", map.finish());
    start({ width, height });
    session_->load_map("room");
    session_->look({ -30, 20, 50 }, { 100, 20, 50 });
    const Radiance around = photograph(shared::PROJECTION_EQUIRECTANGULAR, 0, frames);
    for (const glm::ivec2 angles :
        { glm::ivec2(0, 0), glm::ivec2(0, 90), glm::ivec2(0, 180), glm::ivec2(30, -90), glm::ivec2(-15, 160) }) {
        turn(float(angles.x), float(angles.y));
        // 15 by 7.5 degrees, which four by two pixels of the other picture show, at the middle's height.
        const Radiance there = photograph(shared::PROJECTION_PERSPECTIVE, 15, frames / 4);
        const glm::ivec2 middle(
            (540 - angles.y) % 360 * width / 360, (90 + angles.x) * height / 180); // yaw goes to the left
        glm::vec3 seen(0);
        int count = 0;
        for (int y = middle.y - 1; y < middle.y + 1; y++)
            for (int x = middle.x - 2; x < middle.x + 2; x++, count++)
                seen += around.at((x + width) % width, y);
        seen /= float(count);
        const float expected = there.mean().y;
        EXPECT_NEAR(seen.y, expected, 0.05f * expected) << "pitch " << angles.x << ", yaw " << angles.y;
    }
}

// Filters and reprojection of the game's own pictures know perspective alone.
TEST_F(Projections, LivePicturesAreInPerspective)
{
    folder_.add_wall("wall", 180);
    folder_.add_wall("lamp", white_index);
    MapBuilder map;
    map.add_lit_room("wall");
    folder_.add_map("room", map.finish());
    start({ 64, 48 });
    session_->load_map("room");
    session_->look({ -30, 20, 50 }, { 100, 20, 50 });
    session_->draw();
    const Radiance before = session_->capture();
    session_->set("pt_projection", "panini");
    session_->set("pt_projection_fov", 200);
    session_->draw();
    EXPECT_TRUE(session_->capture() == before);
}

// Particles are discs that face the eye, wherever it looks; seen from the camera's plane they would vanish at its
// sides.
TEST_F(Projections, ParticlesFaceTheEyeAllAround)
{
    folder_.add_wall("wall", 0);
    MapBuilder map;
    map.add_room(glm::vec3(-1000), glm::vec3(1000), map.add_material("wall"));
    folder_.add_map("dark", map.finish());
    start({ 128, 64 });
    session_->load_map("dark");
    session_->look({ 0, 0, 0 }, { 1, 0, 0 });
    session_->set("gl3_particle_size", 400);
    const engine::Particle particle { { 60, 0, 0 }, white_index, 1.0f };
    session_->view.particles = &particle;
    session_->view.particle_count = 1;
    const auto light = [&](float yaw) {
        turn(0, yaw);
        session_->set("pt_accumulate", 0); // another view is taken
        session_->draw();
        return photograph(shared::PROJECTION_EQUIRECTANGULAR, 0, 32).mean().y;
    };
    const float ahead = light(0);
    EXPECT_GT(ahead, 0);
    for (const float yaw : { 90.0f, 170.0f, -45.0f })
        EXPECT_NEAR(light(yaw), ahead, 0.1f * ahead) << yaw;
}

// A sphere is in focus, in all directions.
TEST_F(Projections, TheLensFacesEveryDirection)
{
    folder_.add_wall("lamp", white_index);
    MapBuilder map;
    map.add(rectangle({ 100, 0, 0 }, { 0, 0, 12 }, { 0, 12, 0 }), map.add_material("lamp", 0, 1000));
    folder_.add_map("dark", map.finish());
    start({ 128, 64 });
    session_->load_map("dark");
    session_->look({ 0, 0, 0 }, { 1, 0, 0 });
    for (const float yaw : { 0.0f, 90.0f, 150.0f }) {
        turn(0, yaw);
        const auto brightest = [&](float aperture, float focus) {
            session_->set("pt_aperture", aperture);
            session_->set("pt_focus", focus);
            const Radiance picture = photograph(shared::PROJECTION_EQUIRECTANGULAR, 0, 48);
            float most = 0;
            for (const glm::vec3& pixel : picture.pixels)
                most = std::max(most, pixel.y);
            return most;
        };
        const float sharp = brightest(0, 100);
        EXPECT_NEAR(brightest(24, 100), sharp, 0.02f * sharp) << yaw;
        EXPECT_LT(brightest(24, 40), 0.7f * sharp) << yaw; // 36 units wide at the lamp
    }
}

} // namespace
} // namespace vkpt::tests

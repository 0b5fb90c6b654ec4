// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/entity_geometry.hpp"
#include "ref_vkpt/scene/moving_geometry.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <random>

namespace vkpt {

namespace {

using glm::vec2;
using glm::vec3;
using shared::Triangle;
using Triangles = std::vector<Triangle>;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

void expect_near(vec3 a, vec3 b, float tolerance = 1e-4f)
{
    for (int axis = 0; axis < 3; axis++)
        EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

vec3 area_of(const Triangle& t)
{
    return glm::cross(t.positions[1] - t.positions[0], t.positions[2] - t.positions[0]) * 0.5f;
}

float find_volume(const Triangles& triangles)
{
    float volume = 0;
    for (const Triangle& t : triangles)
        volume += glm::dot(t.positions[0], glm::cross(t.positions[1], t.positions[2])) / 6;
    return volume;
}

// Every edge is met once in each direction, by the corners' exact positions.
bool is_closed(const Triangles& triangles)
{
    using Point = std::array<float, 3>;
    std::map<std::pair<Point, Point>, int> edges;
    const auto key = [](vec3 p) { return Point { p.x, p.y, p.z }; };
    for (const Triangle& t : triangles)
        for (int i = 0; i < 3; i++)
            edges[{ key(t.positions[i]), key(t.positions[(i + 1) % 3]) }]++;
    for (const auto& [edge, count] : edges) {
        const auto back = edges.find({ edge.second, edge.first });
        if (count != 1 || back == edges.end() || back->second != 1)
            return false;
    }
    return !triangles.empty();
}

void expect_plain(const Triangles& triangles, uint32_t material)
{
    for (const Triangle& t : triangles) {
        EXPECT_EQ(t.material, material);
        EXPECT_EQ(t.emitter, -1);
        EXPECT_EQ(t.cluster, -1);
    }
}

// What the list makes of it.
void append(const MovingGeometry& geometry, Triangles& out)
{
    static Workers workers(1);
    const size_t before = out.size();
    out.resize(before + geometry.triangle_count());
    MovingWriter(workers).write(geometry, { out.data() + before });
}

void append_md2(const formats::Md2Model& model, const Md2Pose& pose, uint32_t material, Triangles& out)
{
    MovingGeometry geometry;
    geometry.add(std::make_shared<Md2Mesh>(model), pose, material, shared::MASK_OPAQUE);
    append(geometry, out);
}

void append_brush_model(std::span<const Triangle> triangles, BrushPose pose, uint32_t added_to_material, Triangles& out)
{
    const std::vector<uint32_t> masks(triangles.size(), shared::MASK_OPAQUE);
    const BrushMesh mesh = make_brush_mesh(triangles, masks);
    std::vector<uint32_t> materials;
    for (const uint32_t texinfo : mesh.texinfos)
        materials.push_back(texinfo + added_to_material);
    pose.materials = materials;
    MovingGeometry geometry;
    geometry.add(mesh, pose);
    append(geometry, out);
}

formats::Md2Model make_model()
{
    formats::Md2Model model;
    model.texture_coordinates = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
    model.indices = { 0, 1, 2 };
    formats::Md2Model::Frame frame;
    frame.positions = { { 0, 0, 0 }, { 8, 0, 0 }, { 0, 8, 0 } };
    frame.normals = { { 0, 0, 1 }, { 0, 0, 1 }, { 0, 0, 1 } };
    model.frames.push_back(frame);
    frame.positions = { { 0, 0, 4 }, { 8, 0, 4 }, { 0, 8, 12 } };
    frame.normals = { { 0, 0, 1 }, { 1, 0, 0 }, { 0, 0, -1 } };
    model.frames.push_back(frame);
    return model;
}

Triangle pose_model(const Md2Pose& pose)
{
    Triangles out;
    append_md2(make_model(), pose, 5, out);
    EXPECT_EQ(out.size(), 1u);
    expect_plain(out, 5);
    return out.empty() ? Triangle {} : out[0];
}

TEST(Octahedral, KeepsDirections)
{
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 10000; i++) {
        const vec3 d = glm::normalize(vec3(normal(random), normal(random), normal(random)));
        const uint32_t bits = encode_octahedral(d);
        EXPECT_LT(glm::distance(decode_octahedral(bits), d), 1e-4f);
        EXPECT_EQ(encode_octahedral(decode_octahedral(bits)), bits) << i;
    }
}

TEST(Octahedral, AxesAreExact)
{
    EXPECT_EQ(encode_octahedral({ 0, 0, 1 }), 0u);
    EXPECT_EQ(encode_octahedral({ 1, 0, 0 }), 0x00007fffu);
    EXPECT_EQ(encode_octahedral({ 0, -1, 0 }), 0x80010000u); // -32767 in the high half
    for (int axis = 0; axis < 3; axis++)
        for (const float sign : { -1.f, 1.f }) {
            vec3 d(0);
            d[axis] = sign;
            expect_near(decode_octahedral(encode_octahedral(d)), d, 1e-6f);
        }
}

TEST(Octahedral, SurvivesGarbage)
{
    for (const vec3 d : { vec3(0), vec3(nan_value), vec3(infinity, 0, 0), vec3(3e38f) })
        EXPECT_NEAR(glm::length(decode_octahedral(encode_octahedral(d))), 1, 1e-5);
    for (const uint32_t bits : { 0x80008000u, 0xffffffffu, 0x7fff7fffu, 0x80000000u })
        EXPECT_NEAR(glm::length(decode_octahedral(bits)), 1, 1e-5);
}

TEST(Angles, FollowQuake)
{
    const Axes rest = angle_vectors(vec3(0));
    expect_near(rest.forward, { 1, 0, 0 });
    expect_near(rest.right, { 0, -1, 0 });
    expect_near(rest.up, { 0, 0, 1 });
    expect_near(angle_vectors({ 0, 90, 0 }).forward, { 0, 1, 0 });
    expect_near(angle_vectors({ 0, 90, 0 }).right, { 1, 0, 0 });
    expect_near(angle_vectors({ 90, 0, 0 }).forward, { 0, 0, -1 }); // looks down
    expect_near(angle_vectors({ 90, 0, 0 }).up, { 1, 0, 0 });
    expect_near(angle_vectors({ 0, 0, 90 }).right, { 0, 0, -1 }); // the right side goes down
    expect_near(angle_vectors({ 0, 0, 90 }).up, { 0, -1, 0 });
    // All three at once, by hand: pitch 30, yaw 90, roll 90.
    expect_near(angle_vectors({ 30, 90, 90 }).forward, { 0, 0.866025f, -0.5f });
    expect_near(angle_vectors({ 30, 90, 90 }).right, { 0, -0.5f, -0.866025f });
    expect_near(angle_vectors({ 30, 90, 90 }).up, { 1, 0, 0 });
}

TEST(Angles, FramesAreRightHanded)
{
    for (float angle = -720; angle < 720; angle += 37) {
        const Axes a = angle_vectors({ angle, angle * 0.7f, angle * 1.3f });
        expect_near(glm::cross(a.right, a.forward), a.up);
        EXPECT_NEAR(glm::length(a.forward), 1, 1e-5);
    }
}

TEST(Md2, PitchLooksDownAndRollIsOpposite)
{
    const vec3 angles { 20, 50, 0 };
    expect_near(md2_transform(vec3(0), angles).direction({ 1, 0, 0 }), angle_vectors(angles).forward);
    expect_near(brush_model_transform(vec3(0), { 0, 0, 30 }).direction({ 0, 1, 0 }), { 0, 0.866025f, 0.5f });
    expect_near(md2_transform(vec3(0), { 0, 0, 30 }).direction({ 0, 1, 0 }), { 0, 0.866025f, -0.5f });
    expect_near(md2_transform({ 1, 2, 3 }, { 0, 90, 0 }).point({ 8, 0, 0 }), { 1, 10, 3 });
}

TEST(Md2, PlacesPositionsNormalsAndPictureCoordinates)
{
    const Triangle t = pose_model({ .transform = md2_transform({ 100, 0, 0 }, { 0, 90, 0 }) });
    expect_near(t.positions[0], { 100, 0, 0 });
    expect_near(t.positions[1], { 100, 8, 0 });
    expect_near(t.positions[2], { 92, 0, 0 });
    EXPECT_EQ(t.uvs[1], vec2(1, 0));
    EXPECT_EQ(t.uvs[2], vec2(0, 1));
    expect_near(decode_octahedral(t.normals[0]), { 0, 0, 1 });
    EXPECT_GT(area_of(t).z, 0);
}

TEST(Md2, BlendsFrames)
{
    const Triangle middle = pose_model({ .frame = 0, .old_frame = 1, .backlerp = 0.5f });
    expect_near(middle.positions[2], { 0, 8, 6 });
    expect_near(decode_octahedral(middle.normals[1]), glm::normalize(vec3(1, 0, 1)));
    expect_near(decode_octahedral(middle.normals[2]), { 0, 0, 1 }); // opposite normals cancel: the new frame's
    expect_near(pose_model({ .frame = 0, .old_frame = 1, .backlerp = 0 }).positions[2], { 0, 8, 0 });
    expect_near(pose_model({ .frame = 0, .old_frame = 1, .backlerp = 1 }).positions[2], { 0, 8, 12 });
    expect_near(pose_model({ .frame = 0, .old_frame = 1, .backlerp = 0.25f }).positions[0], { 0, 0, 1 });
}

TEST(Md2, ClampsFramesAndBlending)
{
    for (const int frame : { 2, 1000, std::numeric_limits<int>::max() })
        expect_near(pose_model({ .frame = frame, .old_frame = frame }).positions[2], { 0, 8, 12 });
    for (const int frame : { -1, std::numeric_limits<int>::min() })
        expect_near(pose_model({ .frame = frame, .old_frame = frame }).positions[2], { 0, 8, 0 });
    for (const float backlerp : { nan_value, -3.f, -infinity })
        expect_near(pose_model({ .frame = 0, .old_frame = 1, .backlerp = backlerp }).positions[2], { 0, 8, 0 });
    expect_near(pose_model({ .frame = 0, .old_frame = 1, .backlerp = infinity }).positions[2], { 0, 8, 12 });
}

TEST(Md2, ShellsStandOff)
{
    const Triangle t = pose_model({ .shell_distance = powerup_shell_distance });
    for (const vec3 p : t.positions)
        EXPECT_NEAR(p.z, 4, 1e-5);
    EXPECT_NEAR(pose_model({ .shell_distance = nan_value }).positions[0].z, 0, 1e-5);
}

TEST(Md2, MirroredKeepsItsFront)
{
    const Md2Pose pose { .transform = md2_transform({ 10, -5, 0 }, vec3(0)),
        .mirror = Mirror { vec3(0), { 0, -1, 0 } } };
    const Triangle t = pose_model(pose);
    expect_near(t.positions[0], { 10, 5, 0 });
    expect_near(t.positions[1], { 10, -3, 0 }); // was the third corner
    expect_near(t.positions[2], { 18, 5, 0 });
    EXPECT_EQ(t.uvs[1], vec2(0, 1));
    EXPECT_GT(glm::dot(area_of(t), decode_octahedral(t.normals[0])), 0);
}

TEST(Md2, BlendsOrigins)
{
    expect_near(blend_origins({ 8, 0, 0 }, { 0, 0, 0 }, 0.25f), { 6, 0, 0 });
    expect_near(blend_origins({ 8, 0, 0 }, { 0, 0, 0 }, 0), { 8, 0, 0 });
    expect_near(blend_origins({ 8, 0, 0 }, vec3(nan_value), 0.5f), { 8, 0, 0 });
}

Triangle make_wall()
{
    Triangle t {};
    t.positions[0] = { 0, 0, 0 };
    t.positions[1] = { 16, 0, 0 };
    t.positions[2] = { 0, 0, 16 };
    t.uvs[1] = { 1, 0 };
    for (uint32_t& normal : t.normals)
        normal = encode_octahedral({ 0, -1, 0 });
    t.material = 7;
    t.emitter = 2;
    t.cluster = 9;
    return t;
}

TEST(BrushModel, MovesTurnsAndRemaps)
{
    const Triangle wall = make_wall();
    Triangles out;
    append_brush_model(
        std::span(&wall, 1), { .transform = brush_model_transform({ 0, 0, 100 }, { 0, 90, 0 }) }, 30, out);
    ASSERT_EQ(out.size(), 1u);
    expect_plain(out, 37);
    expect_near(out[0].positions[1], { 0, 16, 100 });
    expect_near(out[0].positions[2], { 0, 0, 116 });
    expect_near(decode_octahedral(out[0].normals[0]), { 1, 0, 0 });
    expect_near(glm::normalize(area_of(out[0])), { 1, 0, 0 });
    EXPECT_EQ(out[0].uvs[1], vec2(1, 0));
}

TEST(BrushModel, AllThreeAnglesAsTheyStand)
{
    const Triangle wall = make_wall();
    Triangles out;
    append_brush_model(std::span(&wall, 1), { .transform = brush_model_transform(vec3(0), { 90, 0, 0 }) }, 0, out);
    expect_near(out[0].positions[1], { 0, 0, -16 }); // forward looks down
    expect_near(out[0].positions[2], { 16, 0, 0 });
}

TEST(BrushModel, AtRestNothingChangesAndEmittersAreCounted)
{
    const Triangle wall = make_wall();
    Triangles out;
    append_brush_model(std::span(&wall, 1), { .first_emitter = 40 }, 0, out);
    EXPECT_EQ(std::memcmp(out[0].positions, wall.positions, sizeof(wall.positions)), 0);
    EXPECT_EQ(std::memcmp(out[0].normals, wall.normals, sizeof(wall.normals)), 0);
    EXPECT_EQ(out[0].material, 7u);
    EXPECT_EQ(out[0].emitter, 42);
}

// The corners of the last view, as they are written beside the triangles.
std::vector<std::array<vec3, 3>> previous_corners(const MovingGeometry& geometry, Triangles& triangles)
{
    Workers workers(2);
    triangles.resize(geometry.triangle_count());
    std::vector<std::array<vec3, 3>> previous(
        geometry.triangle_count(), { vec3(nan_value), vec3(nan_value), vec3(nan_value) });
    MovingTarget target;
    target.triangles = triangles.data();
    target.previous_positions = previous.data();
    MovingWriter(workers).write(geometry, target);
    return previous;
}

void expect_corners(const std::array<vec3, 3>& corners, const Triangle& triangle)
{
    for (size_t i = 0; i < 3; i++)
        EXPECT_EQ(corners[i], triangle.positions[i]) << "corner " << i;
}

// A view with a model, a brush model and two loose triangles, all of them `moved` from where they rest.
MovingGeometry make_view(const std::shared_ptr<Md2Mesh>& model, const BrushMesh& brush, float moved)
{
    static constexpr uint32_t material = 0;
    MovingGeometry geometry;
    geometry.add(model,
        { .transform = md2_transform({ moved, 0, 0 }, { 0, moved, 0 }),
            .frame = 0,
            .old_frame = 1,
            .backlerp = moved / 64,
            .mirror = Mirror { vec3(moved), { 0, -1, 0 } } },
        0, shared::MASK_OPAQUE);
    geometry.add(
        brush, { .transform = brush_model_transform({ 0, 0, moved }, { 0, moved, 0 }), .materials = { &material, 1 } });
    for (int i = 0; i < 2; i++) {
        Triangle loose = make_wall();
        for (vec3& p : loose.positions)
            p += vec3(0, moved, 100 * float(i));
        geometry.loose().push_back(loose);
        geometry.mask_loose(shared::MASK_OPAQUE);
    }
    return geometry;
}

TEST(PreviousPositions, AreThoseOfTheLastView)
{
    const auto model = std::make_shared<Md2Mesh>(make_model());
    const Triangle wall = make_wall();
    const uint32_t mask = shared::MASK_OPAQUE;
    const BrushMesh brush = make_brush_mesh(std::span(&wall, 1), std::span(&mask, 1));
    const MovingGeometry before = make_view(model, brush, 10);
    MovingGeometry now = make_view(model, brush, 30);
    Triangles old, triangles;
    previous_corners(before, old);
    // Nothing is known yet: nothing has moved.
    const auto unknown = previous_corners(now, triangles);
    ASSERT_EQ(unknown.size(), 4u);
    for (size_t i = 0; i < 4; i++)
        expect_corners(unknown[i], triangles[i]);

    now.keep_previous(0, 2, before, 0);
    now.keep_previous_loose(1, 1, before, 1);
    const auto known = previous_corners(now, triangles);
    expect_corners(known[0], old[0]);
    expect_corners(known[1], old[1]);
    expect_corners(known[2], triangles[2]);
    expect_corners(known[3], old[3]);
    EXPECT_NE(known[0][0], triangles[0].positions[0]);
    EXPECT_NE(known[1][0], triangles[1].positions[0]);
}

TEST(PreviousPositions, OtherMeshesAndMissingOnesHaveNotMoved)
{
    const auto model = std::make_shared<Md2Mesh>(make_model()), other = std::make_shared<Md2Mesh>(make_model());
    const Triangle wall = make_wall();
    const uint32_t mask = shared::MASK_OPAQUE;
    const BrushMesh brush = make_brush_mesh(std::span(&wall, 1), std::span(&mask, 1));
    MovingGeometry now = make_view(model, brush, 30);
    now.keep_previous(0, 1, make_view(other, brush, 10), 0);
    now.keep_previous(1, 1, make_view(model, brush, 10), 2);
    now.keep_previous_loose(0, 2, make_view(model, brush, 10), 5);
    Triangles triangles;
    const auto corners = previous_corners(now, triangles);
    for (size_t i = 0; i < 4; i++)
        expect_corners(corners[i], triangles[i]);
}

TEST(Sprite, StandsUprightFacingTheCamera)
{
    const Axes camera = angle_vectors({ 0, 180, 0 }); // looks along -x: right is +y
    Triangles out;
    append_sprite({ 32, 48, 10, 8, "" }, { 100, 0, 50 }, camera, 3, out);
    ASSERT_EQ(out.size(), 2u);
    expect_plain(out, 3);
    float area = 0;
    for (const Triangle& t : out) {
        area += glm::length(area_of(t));
        expect_near(glm::normalize(area_of(t)), { 1, 0, 0 });
        expect_near(decode_octahedral(t.normals[0]), { 1, 0, 0 });
        for (int i = 0; i < 3; i++) {
            expect_near(t.positions[i], { 100, t.uvs[i].x > 0.5f ? 22 : -10, t.uvs[i].y > 0.5f ? 42 : 90 });
        }
    }
    EXPECT_NEAR(area, 32 * 48, 0.1);
}

TEST(Beam, IsAClosedPrism)
{
    constexpr std::pair<vec3, vec3> beams[] { { { 0, 0, 0 }, { 100, 0, 0 } }, { { 5, 6, 7 }, { 5, 6, 90 } },
        { { 5, 6, 7 }, { 5, 6, -90 } }, { { -300, 200, 10 }, { 400, -150, 77 } } };
    for (const auto& [start, end] : beams) {
        Triangles out;
        append_beam(start, end, 8, 2, out);
        EXPECT_EQ(out.size(), 20u);
        expect_plain(out, 2);
        EXPECT_TRUE(is_closed(out));
        const float hexagon = 1.5f * std::sqrt(3.f) * 16, length = glm::length(end - start);
        EXPECT_NEAR(find_volume(out) / (hexagon * length), 1, 1e-2); // positive: fronts point outwards
        for (const Triangle& t : out) {
            EXPECT_GT(glm::dot(area_of(t), decode_octahedral(t.normals[0])), 0);
            for (const vec3 p : t.positions)
                EXPECT_NEAR(glm::length(glm::cross(p - start, glm::normalize(end - start))), 4, 1e-3);
        }
    }
}

TEST(Particle, IsASquareThatStaysVisible)
{
    const Axes camera = angle_vectors({ 30, 40, 0 });
    const vec3 eye { 10, 20, 30 };
    for (const float distance : { 5.f, 500.f }) {
        const vec3 origin = eye + camera.forward * distance;
        Triangles out;
        append_particle(origin, eye, camera, 4, out);
        ASSERT_EQ(out.size(), 2u);
        expect_plain(out, 4);
        float area = 0;
        vec3 middle(0);
        for (const Triangle& t : out) {
            area += glm::length(area_of(t));
            middle += (t.positions[0] + t.positions[1] + t.positions[2]) / 6.f;
            EXPECT_GT(glm::dot(area_of(t), eye - origin), 0);
        }
        expect_near(middle, origin, 1e-3f);
        EXPECT_NEAR(std::sqrt(area), particle_width(distance), 1e-3);
    }
    EXPECT_FLOAT_EQ(particle_width(5), 1.25f);
    EXPECT_FLOAT_EQ(particle_width(500), 3.75f);
}

TEST(NullModel, IsAClosedOctahedron)
{
    Triangles out;
    append_null_model(md2_transform({ 0, 0, 0 }, { 10, 20, 30 }), 6, out);
    EXPECT_EQ(out.size(), 8u);
    expect_plain(out, 6);
    EXPECT_NEAR(find_volume(out), 4.f / 3 * 16 * 16 * 16, 1);
    for (const Triangle& t : out)
        EXPECT_GT(glm::dot(area_of(t), decode_octahedral(t.normals[0])), 0);
    Triangles upright;
    append_null_model({}, 6, upright);
    EXPECT_TRUE(is_closed(upright));
}

TEST(Garbage, AppendsNothing)
{
    const Triangle wall = make_wall();
    const Axes camera = angle_vectors(vec3(0)), broken_camera = angle_vectors(vec3(nan_value));
    Triangles out;
    for (const float bad : { nan_value, infinity, -infinity, 3e38f, 1e7f }) {
        const vec3 place { 0, bad, 0 };
        append_md2(make_model(), { .transform = md2_transform(place, vec3(0)) }, 0, out);
        append_md2(make_model(), { .mirror = Mirror { place, { 0, 1, 0 } } }, 0, out);
        append_brush_model(std::span(&wall, 1), { .transform = brush_model_transform(place, vec3(0)) }, 0, out);
        append_sprite({ 8, 8, 4, 4, "" }, place, camera, 0, out);
        append_beam(place, vec3(0), 4, 0, out);
        append_beam(vec3(0), place, 4, 0, out);
        append_particle(place, vec3(0), camera, 0, out);
        append_particle(vec3(0), place, camera, 0, out);
        append_null_model({ .origin = place }, 0, out);
    }
    for (const float bad : { nan_value, infinity }) {
        append_md2(make_model(), { .transform = md2_transform(vec3(0), { bad, 0, 0 }) }, 0, out);
        append_brush_model(std::span(&wall, 1), { .transform = brush_model_transform(vec3(0), { 0, 0, bad }) }, 0, out);
        append_beam(vec3(0), vec3(9), bad, 0, out);
    }
    append_sprite({ 8, 8, 4, 4, "" }, vec3(0), broken_camera, 0, out);
    append_particle(vec3(0), vec3(0), broken_camera, 0, out);
    append_sprite({ 0, 8, 0, 0, "" }, vec3(0), camera, 0, out);
    append_sprite({ 8, -1, 0, 0, "" }, vec3(0), camera, 0, out);
    append_beam(vec3(1), vec3(1), 4, 0, out);
    append_beam(vec3(0), vec3(9), 0, 0, out);
    append_beam(vec3(0), vec3(9), -4, 0, out);
    append_md2({}, {}, 0, out);
    EXPECT_TRUE(out.empty());
}

TEST(Garbage, WhatIsAppendedIsFinite)
{
    std::mt19937 random(7);
    const auto any_float = [&] {
        const uint32_t bits = uint32_t(random());
        float value;
        std::memcpy(&value, &bits, sizeof(value));
        return value;
    };
    const auto any_vec3 = [&] { return vec3(any_float(), any_float(), any_float()); };
    const Triangle wall = make_wall();
    Triangles out;
    for (int i = 0; i < 20000; i++) {
        const Axes camera = i % 2 ? angle_vectors(any_vec3()) : Axes { any_vec3(), any_vec3(), any_vec3() };
        const Md2Pose pose { .transform = md2_transform(any_vec3(), any_vec3()),
            .frame = int(random()),
            .old_frame = int(random()),
            .backlerp = any_float(),
            .shell_distance = any_float(),
            .mirror = Mirror { any_vec3(), any_vec3() } };
        append_md2(make_model(), pose, 0, out);
        append_brush_model(std::span(&wall, 1), { .transform = brush_model_transform(any_vec3(), any_vec3()) }, 0, out);
        append_sprite({ int(random()), int(random()), int(random() % 65536), 0, "" }, any_vec3(), camera, 0, out);
        append_beam(any_vec3(), any_vec3(), any_float(), 0, out);
        append_particle(any_vec3(), any_vec3(), camera, 0, out);
        append_null_model(pose.transform, 0, out);
    }
    EXPECT_GT(out.size(), 1000u);
    for (const Triangle& t : out)
        for (const vec3 p : t.positions)
            ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
}

} // namespace

} // namespace vkpt

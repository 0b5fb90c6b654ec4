// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/md2_disk.hpp"
#include "formats/model.hpp"
#include "tests/formats/samples.hpp"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace formats {

namespace {

using vkpt::samples::make_md2;
using vkpt::samples::make_sp2;

void expect_near(glm::vec3 a, glm::vec3 b, float tolerance)
{
    for (int axis = 0; axis < 3; axis++)
        EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

TEST(Md2Normals, AreTheFormatsDirections)
{
    const auto directions = md2_disk::normal_directions();
    for (size_t i = 0; i < directions.size(); i++) {
        EXPECT_NEAR(glm::length(directions[i]), 1, 1e-6);
        EXPECT_EQ(md2_disk::nearest_direction(directions[i]), i);
        const glm::vec3 opposite = directions[md2_disk::nearest_direction(-directions[i])];
        expect_near(opposite, -directions[i], 1e-6f);
    }
    // Where the six axes and a few others stand in the format.
    const std::pair<size_t, glm::vec3> known[] { { 0, { -0.525731f, 0, 0.850651f } }, { 5, { 0, 0, 1 } },
        { 32, { 0, 1, 0 } }, { 52, { 1, 0, 0 } }, { 77, { -0.147621f, 0.716567f, -0.681718f } }, { 84, { 0, 0, -1 } },
        { 100, { 0.716567f, -0.681718f, -0.147621f } }, { 104, { 0, -1, 0 } }, { 143, { -1, 0, 0 } },
        { 161, { -0.688191f, -0.587785f, -0.425325f } } };
    for (const auto& [index, direction] : known)
        expect_near(directions[index], direction, 2e-6f);
}

TEST(Md2, RoundTrip)
{
    const Md2Model model = make_md2();
    const Md2Model again = read_md2(write_md2(model), "sample.md2");
    EXPECT_EQ(again.skin_width, model.skin_width);
    EXPECT_EQ(again.skin_height, model.skin_height);
    EXPECT_EQ(again.skins, model.skins);
    ASSERT_EQ(again.triangle_count(), model.triangle_count());
    ASSERT_EQ(again.frames.size(), model.frames.size());
    EXPECT_EQ(again.vertex_count(), model.vertex_count()); // the seam stays split
    for (size_t f = 0; f < model.frames.size(); f++) {
        EXPECT_EQ(again.frames[f].name, model.frames[f].name);
        for (size_t i = 0; i < model.indices.size(); i++) {
            const size_t a = model.indices[i], b = again.indices[i];
            expect_near(again.frames[f].positions[b], model.frames[f].positions[a], 0.5f * 30 / 255 + 1e-4f);
            EXPECT_GT(glm::dot(again.frames[f].normals[b], model.frames[f].normals[a]), 0.96f);
            EXPECT_NEAR(again.texture_coordinates[b].x, model.texture_coordinates[a].x, 1e-6);
            EXPECT_NEAR(again.texture_coordinates[b].y, model.texture_coordinates[a].y, 1e-6);
        }
    }
}

TEST(Md2, WritingWhatWasReadChangesNothing)
{
    const auto once = write_md2(make_md2());
    EXPECT_EQ(write_md2(read_md2(once, "sample.md2")), once);
}

TEST(Md2, PositionsAreStoredOnceAndTrianglesClockwise)
{
    const auto file = write_md2(make_md2());
    md2_disk::Header header;
    std::memcpy(&header, file.data() + 8, sizeof(header));
    EXPECT_EQ(header.vertex_count, 4u);
    EXPECT_EQ(header.coordinate_count, 5u);
    EXPECT_EQ(header.end, file.size());
    EXPECT_EQ(header.command_count, 4u * 10 + 1);
    const Md2Model model = read_md2(file, "sample.md2");
    const auto& frame = model.frames[0];
    for (size_t i = 0; i < model.indices.size(); i += 3) {
        const glm::vec3 a = frame.positions[model.indices[i]], b = frame.positions[model.indices[i + 1]],
                        c = frame.positions[model.indices[i + 2]];
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), (a + b + c) / 3.f - glm::vec3(0, 0, 5)), 0)
            << "triangle " << i / 3;
    }
}

TEST(Md2, BoundsHoldAllPositions)
{
    for (const auto& frame : read_md2(write_md2(make_md2()), "sample.md2").frames)
        for (const glm::vec3& p : frame.positions)
            for (int axis = 0; axis < 3; axis++) {
                EXPECT_GE(p[axis], frame.mins[axis]);
                EXPECT_LE(p[axis], frame.maxs[axis] + 1e-4f);
            }
}

TEST(Md2, RefusesBrokenFiles)
{
    const auto file = write_md2(make_md2());
    const auto broken = [&](size_t offset, uint32_t value) {
        auto copy = file;
        std::memcpy(copy.data() + offset, &value, sizeof(value));
        return copy;
    };
    constexpr size_t header = 8;
    using md2_disk::Header;
    const size_t last_triangle = [&] {
        Header h;
        std::memcpy(&h, file.data() + header, sizeof(h));
        return h.triangles + 12 * (h.triangle_count - 1);
    }();
    const std::pair<size_t, uint32_t> faults[] { { 0, 0 }, { 4, 6 }, { header + offsetof(Header, skin_width), 0 },
        { header + offsetof(Header, frame_size), 55 }, { header + offsetof(Header, vertex_count), 3 },
        { header + offsetof(Header, vertex_count), 0xffffffff }, { header + offsetof(Header, coordinate_count), 4 },
        { header + offsetof(Header, triangle_count), 0 }, { header + offsetof(Header, triangle_count), 0x7fffffff },
        { header + offsetof(Header, frame_count), 0 }, { header + offsetof(Header, frame_count), 0x10000 },
        { header + offsetof(Header, skin_count), 0x1000000 }, { header + offsetof(Header, frames), 0xfffffff0 },
        { last_triangle, 0x00040004 } };
    for (const auto& [offset, value] : faults)
        EXPECT_THROW(read_md2(broken(offset, value), "broken.md2"), FormatError)
            << "offset " << offset << " value " << value;
}

TEST(Md2, RefusesToWriteWhatTheFormatCannotHold)
{
    Md2Model model = make_md2();
    model.indices[0] = 5;
    EXPECT_THROW(write_md2(model), std::invalid_argument);
    model = make_md2();
    model.frames[1].normals.pop_back();
    EXPECT_THROW(write_md2(model), std::invalid_argument);
    model = make_md2();
    model.frames[0].positions[0].x = NAN;
    EXPECT_THROW(write_md2(model), std::invalid_argument);
    model = make_md2();
    model.frames.clear();
    EXPECT_THROW(write_md2(model), std::invalid_argument);
}

TEST(Sp2, RoundTrip)
{
    const Sp2Sprite sprite = make_sp2(), again = read_sp2(write_sp2(sprite), "sample.sp2");
    ASSERT_EQ(again.frames.size(), sprite.frames.size());
    for (size_t i = 0; i < sprite.frames.size(); i++) {
        EXPECT_EQ(again.frames[i].width, sprite.frames[i].width);
        EXPECT_EQ(again.frames[i].height, sprite.frames[i].height);
        EXPECT_EQ(again.frames[i].origin_x, sprite.frames[i].origin_x);
        EXPECT_EQ(again.frames[i].origin_y, sprite.frames[i].origin_y);
        EXPECT_EQ(again.frames[i].picture, sprite.frames[i].picture);
    }
    EXPECT_EQ(write_sp2(again), write_sp2(sprite));
}

TEST(Sp2, RefusesBrokenFiles)
{
    auto file = write_sp2(make_sp2());
    EXPECT_THROW(read_sp2(Bytes(file).first(file.size() - 1), "cut.sp2"), FormatError);
    EXPECT_THROW(read_sp2({}, "empty.sp2"), FormatError);
    file[8] = std::byte { 0 };
    EXPECT_THROW(read_sp2(file, "no frames.sp2"), FormatError);
}

// Each frame and each skin is a picture to load.
TEST(Sp2, RefusesMoreFramesThanTheEngine)
{
    Sp2Sprite sprite;
    sprite.frames.resize(32);
    EXPECT_EQ(read_sp2(write_sp2(sprite), "many.sp2").frames.size(), 32u);
    sprite.frames.resize(33);
    EXPECT_THROW(read_sp2(write_sp2(sprite), "more.sp2"), FormatError);
}

TEST(Md2, SkinsThatNothingCanChooseAreNotRead)
{
    auto file = write_md2(make_md2());
    const size_t skins = file.size();
    const uint32_t count = 12000, offset = uint32_t(skins);
    file.resize(skins + count * size_t(64), std::byte { 'a' });
    std::memcpy(file.data() + 8 + offsetof(md2_disk::Header, skin_count), &count, sizeof(count));
    std::memcpy(file.data() + 8 + offsetof(md2_disk::Header, skins), &offset, sizeof(offset));
    EXPECT_EQ(read_md2(file, "skins.md2").skins.size(), 32u);
}

} // namespace

} // namespace formats

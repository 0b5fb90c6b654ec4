// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/byte_writer.hpp"
#include "formats/iqm_disk.hpp"
#include "formats/model.hpp"
#include "formats/model_iqm.hpp"
#include "tests/formats/file_budget.hpp"
#include "tests/formats/samples.hpp"

#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

namespace formats {

namespace {

using vkpt::samples::make_iqm;
using namespace iqm_disk;
using File = std::vector<std::byte>;

template <class T> T get(const File& file, size_t offset)
{
    T value;
    std::memcpy(&value, file.data() + offset, sizeof(value));
    return value;
}

template <class T> File with(File file, size_t offset, T value)
{
    std::memcpy(file.data() + offset, &value, sizeof(value));
    return file;
}

Header header_of(const File& file) { return get<Header>(file, header_at); }

File with_field(File file, size_t field, uint32_t value) { return with(std::move(file), header_at + field, value); }

VertexArray array_of(const File& file, ArrayType type)
{
    const Header header = header_of(file);
    for (uint32_t i = 0; i < header.array_count; i++)
        if (const auto array = get<VertexArray>(file, header.arrays + i * sizeof(VertexArray)); array.type == type)
            return array;
    return {};
}

std::string refusal(const File& file)
{
    try {
        read_iqm(file, "models/broken.iqm");
    } catch (const FormatError& error) {
        EXPECT_EQ(error.file(), "models/broken.iqm");
        return error.reason();
    }
    return "it is read";
}

void expect_near(glm::vec3 seen, glm::vec3 wanted, float tolerance, const char* what)
{
    EXPECT_LT(glm::distance(seen, wanted), tolerance) << what << ": " << seen.x << " " << seen.y << " " << seen.z
                                                      << ", not " << wanted.x << " " << wanted.y << " " << wanted.z;
}

constexpr float exact = 1e-4f; // what 16 bits leave of a frame's numbers

TEST(Iqm, MeshesAreThoseOfTheFile)
{
    const IqmModel model = make_iqm();
    const auto meshes = read_iqm(write_iqm(model), "models/arms/arm.iqm");
    ASSERT_EQ(meshes.size(), 2u);
    EXPECT_EQ(meshes[0].skins, (std::vector<std::string> { "models/arms/red.pcx" }));
    EXPECT_EQ(meshes[1].skins, (std::vector<std::string> { "models/arms/blue.pcx" }));
    for (size_t m = 0; m < 2; m++) {
        EXPECT_EQ(meshes[m].indices, model.meshes[m].indices);
        ASSERT_EQ(meshes[m].frames.size(), 2u);
        for (size_t i = 0; i < model.meshes[m].vertices.size(); i++) {
            const IqmModel::Vertex& vertex = model.meshes[m].vertices[i];
            EXPECT_EQ(meshes[m].texture_coordinates[i], vertex.texture_coordinate);
            // The first frame is the pose that they are bound in.
            expect_near(meshes[m].frames[0].positions[i], vertex.position, exact, "position");
            expect_near(meshes[m].frames[0].normals[i], vertex.normal, exact, "normal");
        }
        for (const Md2Model::Frame& frame : meshes[m].frames)
            for (const glm::vec3& p : frame.positions)
                for (int axis = 0; axis < 3; axis++) {
                    EXPECT_GE(p[axis], frame.mins[axis]);
                    EXPECT_LE(p[axis], frame.maxs[axis]);
                }
    }
    EXPECT_EQ(read_iqm(write_iqm(model), "arm.iqm")[0].skins[0], "red.pcx");
}

// By hand: the shoulder goes up by 8, the elbow (at 20) turns z to x and x to -z.
TEST(Iqm, BentElbowMovesWhatHangsOnIt)
{
    const auto meshes = read_iqm(write_iqm(make_iqm()), "arm.iqm");
    const Md2Model::Frame &arm = meshes[0].frames[1], &hand = meshes[1].frames[1];
    expect_near(arm.positions[0], { 0, -4, 8 }, exact, "upper arm");
    expect_near(arm.positions[4], { 20, 0, 28 }, exact, "wrist");
    expect_near(arm.normals[0], { 0, -1, 0 }, exact, "normal of the upper arm");
    expect_near(arm.normals[4], { 1, 0, 0 }, exact, "normal of the wrist");
    // A fifth of (4, 0, 28) and four of (0, 0, 24): 204 of 255.
    expect_near(arm.positions[2], { 0.8f, 0, 24.8f }, exact, "elbow");
    expect_near(arm.normals[2], glm::normalize(glm::vec3(0.2f, 0, -0.8f)), exact, "normal of the elbow");
    expect_near(hand.positions[1], { 30, 6, 28 }, exact, "finger");
    expect_near(hand.normals[1], { 0, 0, -1 }, exact, "normal of the finger");
    expect_near(arm.mins, { 0, -4, 8 }, exact, "mins");
    expect_near(arm.maxs, { 20, 0, 28 }, exact, "maxs");
}

// As iqm.txt has it: output = (input * scale) * rotation + translation, in the parent's space.
TEST(Iqm, JointsScaleThenTurnThenMove)
{
    IqmModel model = make_iqm();
    IqmModel::Placing placing;
    placing.scale = { 2, 1, 1 };
    placing.rotation = glm::angleAxis(glm::half_pi<float>(), glm::vec3(0, 0, 1)); // x turns to y
    placing.translation = { 100, 0, 0 };
    model.frames[1] = { placing, model.joints[1].bind };
    const auto meshes = read_iqm(write_iqm(model), "arm.iqm");
    expect_near(meshes[0].frames[1].positions[1], { 100, 8, 0 }, 1e-2f, "x is doubled, then turned");
    expect_near(meshes[0].frames[1].positions[4], { 100, 0, 40 }, 1e-2f, "the child follows");
    // A slope of 45 degrees, stretched along x: the normal leans away from x, not towards it.
    model.meshes[0].vertices[1].normal = glm::normalize(glm::vec3(1, 0, 1));
    const auto sloped = read_iqm(write_iqm(model), "arm.iqm");
    expect_near(sloped[0].frames[1].normals[1], glm::normalize(glm::vec3(0, 0.5f, 1)), 1e-3f, "normal");
    // Mirrored, it still looks out.
    model.frames[1][0] = {};
    model.frames[1][0].scale = { -1, 1, 1 };
    const auto mirrored = read_iqm(write_iqm(model), "arm.iqm");
    expect_near(mirrored[0].frames[1].normals[1], glm::normalize(glm::vec3(-1, 0, 1)), 1e-3f, "mirrored normal");
}

TEST(Iqm, WithoutFramesOrJointsItStandsStill)
{
    IqmModel model = make_iqm();
    model.frames.clear();
    const auto bound = read_iqm(write_iqm(model), "arm.iqm");
    model.joints.clear();
    const auto plain = read_iqm(write_iqm(model), "arm.iqm");
    for (const auto* meshes : { &bound, &plain }) {
        ASSERT_EQ((*meshes)[0].frames.size(), 1u);
        EXPECT_EQ((*meshes)[0].frames[0].positions[4], model.meshes[0].vertices[4].position);
    }
}

TEST(Iqm, VerticesWithoutWeightStayAndOthersCountInFull)
{
    IqmModel model = make_iqm();
    model.meshes[0].vertices[4].weights = { 0, 0, 0, 0 };
    model.meshes[1].vertices[1].weights = { 0, 100, 0, 0 }; // of 255: exporters round
    const auto meshes = read_iqm(write_iqm(model), "arm.iqm");
    expect_near(meshes[0].frames[1].positions[4], { 0, 0, 40 }, exact, "free");
    expect_near(meshes[1].frames[1].positions[1], { 30, 6, 28 }, exact, "rounded");
}

// Other formats that the document names: floats and integers for the blending.
TEST(Iqm, ReadsWeightsAsFloatsAndJointsAsIntegers)
{
    const File file = write_iqm(make_iqm());
    const Header header = header_of(file);
    ByteWriter writer;
    writer.write_bytes(file);
    const auto add = [&](ArrayType type, ArrayFormat format, const auto& convert) {
        const VertexArray source = array_of(file, type);
        const uint32_t place = uint32_t(writer.position());
        for (uint32_t i = 0; i < 4 * header.vertex_count; i++)
            writer.write(convert(get<uint8_t>(file, source.offset + i)));
        return VertexArray { type, 0, format, 4, place };
    };
    const VertexArray joints = add(BlendIndices, UnsignedInt, [](uint8_t n) { return uint32_t(n); });
    const VertexArray weights = add(BlendWeights, Float, [](uint8_t n) { return float(n) / 255; });
    File changed = writer.take();
    for (uint32_t i = 0; i < header.array_count; i++) {
        const size_t at = header.arrays + i * sizeof(VertexArray);
        const uint32_t type = get<uint32_t>(changed, at);
        if (type == BlendIndices || type == BlendWeights)
            changed = with(std::move(changed), at, type == BlendIndices ? joints : weights);
    }
    const auto meshes = read_iqm(changed, "arm.iqm"), wanted = read_iqm(file, "arm.iqm");
    for (size_t i = 0; i < 5; i++)
        expect_near(meshes[0].frames[1].positions[i], wanted[0].frames[1].positions[i], 1e-5f, "position");
    EXPECT_NE(
        refusal(with(changed, weights.offset + 16, NAN)).find("weight is not a sensible number"), std::string::npos);
    EXPECT_NE(refusal(with(changed, weights.offset, -1.0f)).find("weight is not a sensible number"), std::string::npos);
    EXPECT_NE(refusal(with(changed, joints.offset, 7u)).find("vertex 0 hangs on joint 7 of 2"), std::string::npos);
    EXPECT_NE(refusal(with(changed, joints.offset, 256u)).find("vertex 0 hangs on joint 255 of 2"), std::string::npos);
}

// The elbow's mask has the channels that its two frames differ in, in the order of the document; a number counts from
// the channel's offset in steps of its scale.
TEST(Iqm, ChannelsAreThoseOfTheMask)
{
    const File file = write_iqm(make_iqm());
    const Header header = header_of(file);
    const auto shoulder = get<Pose>(file, header.poses), elbow = get<Pose>(file, header.poses + sizeof(Pose));
    EXPECT_EQ(shoulder.mask, 1u << 2); // z
    EXPECT_EQ(elbow.mask, 1u << 4 | 1u << 6); // y and w of the rotation
    EXPECT_EQ(header.channel_count, 3u);
    const size_t second_frame = header.frames + 3 * sizeof(uint16_t);
    EXPECT_EQ(get<uint16_t>(file, second_frame), 65535);
    const auto meshes = read_iqm(with<uint16_t>(file, second_frame, 16384), "arm.iqm");
    expect_near(meshes[0].frames[1].positions[0], { 0, -4, 8 * 16384 / 65535.0f }, exact, "a quarter of the way");
    // Bits beyond the ten channels stand for nothing.
    EXPECT_EQ(refusal(with(file, header.poses + offsetof(Pose, mask), 0xfffffc04u)), "it is read");
    EXPECT_NE(refusal(with(file, header.poses + offsetof(Pose, mask), 5u)).find("3 numbers for each frame, while"),
        std::string::npos);
}

TEST(Iqm, TrianglesAreClockwiseInTheFile)
{
    const File file = write_iqm(make_iqm());
    EXPECT_EQ(get<Triangle>(file, header_of(file).triangles), (Triangle { 0, 2, 1 }));
    const auto meshes = read_iqm(with(file, header_of(file).triangles, Triangle { 4, 2, 3 }), "arm.iqm");
    EXPECT_EQ(meshes[0].indices[0], 4u);
    EXPECT_EQ(meshes[0].indices[1], 3u);
    EXPECT_EQ(meshes[0].indices[2], 2u);
}

TEST(Iqm, RefusesBrokenFilesAndSaysWhy)
{
    const File file = write_iqm(make_iqm());
    const Header header = header_of(file);
    const auto expect = [&](const File& broken, const char* reason) {
        EXPECT_NE(refusal(broken).find(reason), std::string::npos) << refusal(broken) << ", not " << reason;
    };
    const auto field = [&](size_t at, uint32_t value) { return with_field(file, at, value); };
    expect(with(file, 0, 0), "INTERQUAKEMODEL");
    expect(with(file, 16, 1u), "version 1; export the model as version 2");
    expect(File(file.begin(), file.begin() + 80), "the file ends here");
    expect(File(file.begin(), file.end() - 8), "the file ends before its");
    expect(field(offsetof(Header, mesh_count), 0), "0 meshes");
    expect(field(offsetof(Header, mesh_count), 33), "33 meshes; a model has 1 to 32: join some");
    expect(field(offsetof(Header, joint_count), 257), "257 joints");
    expect(field(offsetof(Header, pose_count), 1), "1 poses for 2 joints");
    expect(field(offsetof(Header, frame_count), 4097), "4097 frames");
    expect(field(offsetof(Header, frame_count), 4000), "frames: ");
    expect(field(offsetof(Header, vertex_count), UINT32_MAX), "positions: ");
    expect(field(offsetof(Header, triangle_count), 3), "triangles 3 + 1 of 3");
    for (const size_t offset : { offsetof(Header, meshes), offsetof(Header, arrays), offsetof(Header, triangles),
             offsetof(Header, joints), offsetof(Header, poses), offsetof(Header, frames), offsetof(Header, text) })
        EXPECT_NE(refusal(field(offset, 0xfffffff0)), "it is read") << offset;
    const size_t hand = header.meshes + sizeof(Mesh);
    expect(with(file, hand + offsetof(Mesh, first_vertex), 6u), "vertices 6 + 3 of 8");
    expect(with(file, hand + offsetof(Mesh, first_vertex), 0u), "vertex that its mesh does not have");
    expect(with(file, hand + offsetof(Mesh, first_triangle), 0xfffffffeu), "triangles ");
    expect(with(file, hand + offsetof(Mesh, vertex_count), 0u), "vertices 5 + 0 of 8");
    expect(with(with(file, hand + offsetof(Mesh, first_triangle), 0u), hand + offsetof(Mesh, triangle_count), 2u),
        "its triangles belong to another mesh already");
    expect(with(file, header.triangles, 5u), "vertex that its mesh does not have");
    const size_t elbow = header.joints + sizeof(Joint);
    for (const int32_t parent : { 1, 2, INT32_MAX })
        expect(with(file, elbow + offsetof(Joint, parent), parent), "does not come before it");
    for (const float bad : { 0.0f, NAN, INFINITY })
        expect(with(file, elbow + offsetof(Joint, scale), bad), "joint 1: its place or scale is not a sensible number");
    expect(with(file, header.poses + offsetof(Pose, offset), 1e9f), "frame 0 throws a vertex out of any map");
    expect(with(file, header.poses + offsetof(Pose, scale) + 8, NAN), "frame 0 throws a vertex");
    for (const float bad : { NAN, INFINITY, -1e9f }) {
        expect(with(file, array_of(file, Position).offset + 12, bad), "a position is not a sensible number");
        expect(with(file, array_of(file, TextureCoordinate).offset + 8, bad), "texture coordinate");
    }
    expect(with(file, array_of(file, Normal).offset, NAN), "a normal is not a sensible number");
    expect(with(file, array_of(file, BlendIndices).offset, uint8_t(2)), "vertex 0 hangs on joint 2 of 2");
    expect(with(file, header.arrays, 99u), "no positions");
    expect(with(file, header.arrays + offsetof(VertexArray, format), 6u), "positions in a format that is not known");
    expect(with(file, header.arrays + offsetof(VertexArray, size), 4u), "positions in a format that is not known");
    expect(with(file, header.arrays + 3 * sizeof(VertexArray), 99u), "no blend indices");
    expect(with(file, header.arrays + 4 * sizeof(VertexArray) + offsetof(VertexArray, size), 3u),
        "blend weights in a format");
}

TEST(Iqm, LongNamesAreRefused)
{
    const File file = write_iqm(make_iqm());
    const Header header = header_of(file);
    ByteWriter writer;
    writer.write_bytes(file);
    for (int i = 0; i < 200; i++)
        writer.write('a');
    File longer = with_field(writer.take(), offsetof(Header, text), uint32_t(file.size()));
    longer = with_field(std::move(longer), offsetof(Header, text_size), 200);
    EXPECT_NE(refusal(longer).find("longer than 63 bytes"), std::string::npos) << refusal(longer);
    // No name, no skin.
    const size_t at = header.meshes + offsetof(Mesh, material);
    EXPECT_TRUE(read_iqm(with(file, at, 0u), "arm.iqm")[0].skins.empty());
    EXPECT_TRUE(read_iqm(with(file, at, UINT32_MAX), "arm.iqm")[0].skins.empty());
}

TEST(Iqm, RefusesToWriteWhatTheFormatCannotHold)
{
    const auto expect_refused = [](const std::function<void(IqmModel&)>& spoil) {
        IqmModel model = make_iqm();
        spoil(model);
        EXPECT_THROW(write_iqm(model), std::invalid_argument);
    };
    expect_refused([](IqmModel& m) { m.meshes.clear(); });
    expect_refused([](IqmModel& m) { m.meshes[0].indices[0] = 5; });
    expect_refused([](IqmModel& m) { m.joints[0].parent = 1; });
    expect_refused([](IqmModel& m) { m.frames[1].pop_back(); });
    expect_refused([](IqmModel& m) { m.joints.clear(); });
    expect_refused([](IqmModel& m) { m.meshes[0].material = std::string(64, 'a'); });
}

// An IQM is one whatever it is called, as in Q2RTX.
TEST(Iqm, IsKnownByItsContent)
{
    const File file = write_iqm(make_iqm());
    for (const char* name : { "models/a.md2", "models/a.md3", "models/a.iqm" })
        EXPECT_EQ(read_mesh(file, name).size(), 2u) << name;
    try {
        read_mesh(write_md2(vkpt::samples::make_md2()), "models/a.iqm");
        ADD_FAILURE();
    } catch (const FormatError& error) {
        EXPECT_NE(error.reason().find("not an IQM model"), std::string::npos);
    }
}

// A mesh of `vertices` that lie over each other, whose frames take no room in the file.
File make_frames_of_nothing(uint32_t vertices, uint32_t frames, size_t joints)
{
    IqmModel model = make_iqm();
    model.meshes.resize(1);
    model.meshes[0].vertices.resize(vertices, model.meshes[0].vertices[4]);
    while (model.joints.size() < joints)
        model.joints.push_back({ "", int32_t(model.joints.size()) - 1, model.joints[1].bind });
    std::vector<IqmModel::Placing> placings;
    for (const IqmModel::Joint& joint : model.joints)
        placings.push_back(joint.bind);
    placings.resize(model.joints.size());
    model.frames = { placings };
    return with_field(write_iqm(model), offsetof(Header, frame_count), frames);
}

TEST(Iqm, FramesThatTakeNoRoomStayWithinTheBudget)
{
    using vkpt::tests::expect_within_budget;
    const File many = make_frames_of_nothing(1300, 4096, 250);
    ASSERT_LT(many.size(), vkpt::tests::small_file_bytes);
    expect_within_budget("1300 vertices, 4096 frames", [&] { EXPECT_EQ(refusal(many), "it is read"); });
    expect_within_budget("1400 vertices, 4096 frames", [&] {
        EXPECT_NE(refusal(make_frames_of_nothing(1400, 4096, 250)).find("too large: 4096 frames of 1400 vertices"),
            std::string::npos);
    });
    File meshes = make_frames_of_nothing(40, 4096, 250);
    ByteWriter writer; // 32 meshes of one triangle each, over the same vertices
    writer.write_bytes(meshes);
    for (uint32_t i = 0; i < 32; i++)
        writer.write(Mesh { 0, 0, 0, 40, i % 3, 1 });
    meshes = with_field(writer.take(), offsetof(Header, meshes), uint32_t(meshes.size()));
    meshes = with_field(std::move(meshes), offsetof(Header, mesh_count), 32);
    meshes = with_field(std::move(meshes), offsetof(Header, triangle_count), 32);
    expect_within_budget("32 meshes", [&] { refusal(meshes); });
}

} // namespace

} // namespace formats

// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/md3_disk.hpp"
#include "formats/model.hpp"
#include "tests/formats/file_budget.hpp"
#include "tests/formats/samples.hpp"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace formats {

namespace {

using vkpt::samples::make_md3;
using namespace md3_disk;

constexpr size_t header_at = sizeof(ident) + sizeof(version);

Header header_of(const std::vector<std::byte>& file)
{
    Header header;
    std::memcpy(&header, file.data() + header_at, sizeof(header));
    return header;
}

template <class T> std::vector<std::byte> with(std::vector<std::byte> file, size_t offset, T value)
{
    std::memcpy(file.data() + offset, &value, sizeof(value));
    return file;
}

std::string refusal(const std::vector<std::byte>& file)
{
    try {
        read_md3(file, "models/broken.md3");
    } catch (const FormatError& error) {
        EXPECT_EQ(error.file(), "models/broken.md3");
        return error.reason();
    }
    return "it is read";
}

TEST(Md3, RoundTrip)
{
    const std::vector<Md2Model> surfaces = make_md3();
    const auto file = write_md3(surfaces);
    const std::vector<Md2Model> again = read_md3(file, "sample.md3");
    ASSERT_EQ(again.size(), surfaces.size());
    for (size_t s = 0; s < surfaces.size(); s++) {
        EXPECT_EQ(again[s].skins, surfaces[s].skins);
        EXPECT_EQ(again[s].indices, surfaces[s].indices);
        EXPECT_EQ(again[s].texture_coordinates, surfaces[s].texture_coordinates);
        ASSERT_EQ(again[s].frames.size(), surfaces[s].frames.size());
        for (size_t f = 0; f < surfaces[s].frames.size(); f++) {
            const Md2Model::Frame &seen = again[s].frames[f], &wanted = surfaces[s].frames[f];
            EXPECT_EQ(seen.name, wanted.name);
            for (size_t i = 0; i < wanted.positions.size(); i++) {
                EXPECT_LE(glm::distance(seen.positions[i], wanted.positions[i]), 1.0f / 64);
                EXPECT_GT(glm::dot(seen.normals[i], wanted.normals[i]), 0.999f);
                EXPECT_NEAR(glm::length(seen.normals[i]), 1, 1e-6);
                for (int axis = 0; axis < 3; axis++) {
                    EXPECT_GE(seen.positions[i][axis], seen.mins[axis]);
                    EXPECT_LE(seen.positions[i][axis], seen.maxs[axis]);
                }
            }
        }
    }
    EXPECT_EQ(write_md3(again), file);
}

// By the format's definition: steps of 1/64 unit; the normal's low byte is the angle from +z, its high byte the one
// from +x around z; triangles are clockwise.
TEST(Md3, FieldsMeanWhatTheFormatSays)
{
    std::vector<std::byte> file = write_md3(make_md3());
    const size_t surface_at = header_of(file).surfaces;
    Surface surface;
    std::memcpy(&surface, file.data() + surface_at, sizeof(surface));
    const size_t vertex_at = surface_at + surface.vertices;
    file = with<std::array<int16_t, 3>>(std::move(file), vertex_at, { 64, -96, 32 });
    const std::pair<uint16_t, glm::vec3> normals[] { { 0x0000, { 0, 0, 1 } }, { 0x0040, { 1, 0, 0 } },
        { 0x4040, { 0, 1, 0 } }, { 0x8040, { -1, 0, 0 } }, { 0xc040, { 0, -1, 0 } }, { 0x0080, { 0, 0, -1 } } };
    for (const auto& [code, normal] : normals) {
        const auto model = read_md3(with<uint16_t>(file, vertex_at + 6, code), "sample.md3");
        EXPECT_EQ(model[0].frames[0].positions[0], glm::vec3(1, -1.5f, 0.5f));
        EXPECT_LT(glm::distance(model[0].frames[0].normals[0], normal), 1e-6f) << code;
    }
    file = with<Triangle>(std::move(file), surface_at + surface.triangles, { 4, 2, 3 });
    const auto model = read_md3(file, "sample.md3");
    EXPECT_EQ(std::vector<uint32_t>(model[0].indices.begin(), model[0].indices.begin() + 3),
        (std::vector<uint32_t> { 4, 3, 2 }));
}

TEST(Md3, RefusesBrokenFilesAndSaysWhy)
{
    const auto file = write_md3(make_md3());
    const size_t surface_at = header_of(file).surfaces;
    Surface surface;
    std::memcpy(&surface, file.data() + surface_at, sizeof(surface));
    const auto header_with
        = [&](size_t field, uint32_t value) { return refusal(with(file, header_at + field, value)); };
    const auto surface_with
        = [&](size_t field, uint32_t value) { return refusal(with(file, surface_at + field, value)); };
    EXPECT_NE(refusal(with(file, 0, 0)).find("IDP3"), std::string::npos);
    EXPECT_NE(refusal(with(file, 4, 16)).find("version 16; export the model as version 15"), std::string::npos);
    EXPECT_NE(header_with(offsetof(Header, frame_count), 0).find("0 frames"), std::string::npos);
    EXPECT_NE(header_with(offsetof(Header, frame_count), 1025).find("1025 frames"), std::string::npos);
    EXPECT_NE(header_with(offsetof(Header, surface_count), 33).find("33 surfaces"), std::string::npos);
    EXPECT_NE(header_with(offsetof(Header, frames), 0xfffffff0).find("frames"), std::string::npos);
    EXPECT_NE(header_with(offsetof(Header, surfaces), 0xfffffff0), "it is read");
    EXPECT_NE(header_with(offsetof(Header, surfaces), 4).find("no surface begins here"), std::string::npos);
    EXPECT_NE(surface_with(offsetof(Surface, frame_count), 1).find("as many frames"), std::string::npos);
    EXPECT_NE(surface_with(offsetof(Surface, vertex_count), 4097).find("4097 vertices"), std::string::npos);
    EXPECT_NE(surface_with(offsetof(Surface, vertex_count), 4).find("vertex that does not exist"), std::string::npos);
    EXPECT_NE(surface_with(offsetof(Surface, triangle_count), 8193).find("8193 triangles"), std::string::npos);
    EXPECT_NE(surface_with(offsetof(Surface, shader_count), 0x7fffffff).find("skins"), std::string::npos);
    EXPECT_NE(surface_with(offsetof(Surface, end), 8).find("no surface begins here"), std::string::npos);
    for (const float bad : { NAN, INFINITY, -1e9f })
        EXPECT_NE(refusal(with(file, surface_at + surface.coordinates + 8, bad)).find("texture coordinate"),
            std::string::npos);
}

TEST(Md3, RefusesToWriteWhatTheFormatCannotHold)
{
    std::vector<Md2Model> surfaces = make_md3();
    surfaces[1].frames.pop_back();
    EXPECT_THROW(write_md3(surfaces), std::invalid_argument);
    surfaces = make_md3();
    surfaces[0].frames[0].positions[0].x = 600;
    EXPECT_THROW(write_md3(surfaces), std::invalid_argument);
    surfaces = make_md3();
    surfaces[0].indices[0] = 5;
    EXPECT_THROW(write_md3(surfaces), std::invalid_argument);
    EXPECT_THROW(write_md3({}), std::invalid_argument);
}

// All surfaces may lie over each other, as nothing says where one has to begin.
TEST(Md3, ManySurfacesOverEachOtherStayWithinTheBudget)
{
    Md2Model model = make_md3()[0];
    while (model.vertex_count() < 1000) {
        model.texture_coordinates.emplace_back(0, 0);
        for (Md2Model::Frame& frame : model.frames) {
            frame.positions.emplace_back(0, 0, 0);
            frame.normals.emplace_back(0, 0, 1);
        }
    }
    while (model.frames.size() < 64)
        model.frames.push_back(model.frames[0]);
    auto file = write_md3(std::span(&model, 1));
    ASSERT_LT(file.size(), vkpt::tests::small_file_bytes);
    file = with<uint32_t>(std::move(file), header_at + offsetof(Header, surface_count), 32);
    file = with<uint32_t>(std::move(file), header_of(file).surfaces + offsetof(Surface, end), 0);
    vkpt::tests::expect_within_budget("32 times one surface", [&] { read_md3(file, "one.md3"); });
    file = with<uint32_t>(std::move(file), header_at + offsetof(Header, frame_count), 128);
    EXPECT_NE(refusal(file), "it is read");
}

TEST(Md3, TooLargeOnesAreRefusedBeforeTheMemoryIsTaken)
{
    Md2Model model = make_md3()[0];
    while (model.vertex_count() < 100) {
        model.texture_coordinates.emplace_back(0, 0);
        for (Md2Model::Frame& frame : model.frames) {
            frame.positions.emplace_back(0, 0, 0);
            frame.normals.emplace_back(0, 0, 1);
        }
    }
    while (model.frames.size() < 1024)
        model.frames.push_back(model.frames[0]);
    auto file = write_md3(std::span(&model, 1));
    const uint32_t zeros = uint32_t(file.size()) - header_of(file).surfaces;
    file = with<uint32_t>(std::move(file), header_of(file).surfaces + offsetof(Surface, coordinates), zeros);
    file = with<uint32_t>(std::move(file), header_of(file).surfaces + offsetof(Surface, vertex_count), 4096);
    file = with<uint32_t>(std::move(file), header_at + offsetof(Header, surface_count), 32);
    file = with<uint32_t>(std::move(file), header_of(file).surfaces + offsetof(Surface, end), 0);
    file.resize(size_t(36) << 20);
    EXPECT_NE(refusal(file).find("too large: 1024 frames of 4096 vertices"), std::string::npos) << refusal(file);
}

} // namespace

} // namespace formats

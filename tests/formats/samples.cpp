// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/formats/samples.hpp"
#include "formats/byte_writer.hpp"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace vkpt::samples {

using namespace formats;

namespace {

std::vector<uint8_t> make_visibility()
{
    ByteWriter writer;
    writer.write(int32_t(2));
    for (const int32_t row : { 20, 21 }) {
        writer.write(row);
        writer.write(row);
    }
    writer.write(uint8_t(1));
    writer.write(uint8_t(2));
    const auto bytes = writer.take();
    std::vector<uint8_t> lump(bytes.size());
    std::memcpy(lump.data(), bytes.data(), bytes.size());
    return lump;
}

} // namespace

Bsp make_bsp()
{
    Bsp bsp;
    bsp.name = "maps/sample.bsp";
    bsp.entity_text = "{\n\"classname\" \"worldspawn\"\n}\n{\n\"classname\" \"light\"\n\"origin\" \"16 0 32\"\n}\n";
    bsp.planes = { { { 0, 0, 1 }, 0, 2 }, { { 1, 0, 0 }, 0, 0 }, { { 0, 0, -1 }, 0, 2 } };
    bsp.vertices = { { -64, -64, 0 }, { 0, -64, 0 }, { 64, -64, 0 }, { 64, 64, 0 }, { 0, 64, 0 }, { -64, 64, 0 } };
    bsp.edges = { { { 0, 0 } }, { { 0, 5 } }, { { 5, 4 } }, { { 4, 1 } }, { { 1, 0 } }, { { 4, 3 } }, { { 3, 2 } },
        { { 2, 1 } } };
    bsp.surface_edges = { 1, 2, 3, 4, -3, 5, 6, 7 }; // both squares clockwise seen from above
    bsp.texinfos = { { { 1, 0, 0 }, 0, { 0, -1, 0 }, 8, SURF_LIGHT, 300, "sample/lamp", -1 },
        { { 0.5f, 0, 0 }, 0, { 0, -0.5f, 0 }, 0, 0, 0, "sample/floor1", 2 },
        { { 0.5f, 0, 0 }, 0, { 0, -0.5f, 0 }, 0, 0, 0, "sample/floor2", 1 } };
    bsp.faces = { { 0, 0, 0, 4, 0, { 0, 255, 255, 255 }, 0 }, { 2, 1, 4, 4, 1, { 0, 255, 255, 255 }, -1 } };
    bsp.lighting.resize(5 * 10 * 3, 100);
    bsp.leaf_faces = { 0, 1 };
    bsp.leaf_brushes = { 0 };
    bsp.leaves = { { CONTENTS_SOLID, -1, 0, { -64, -64, -64 }, { 64, 64, 0 }, 0, 0, 0, 1 },
        { 0, 0, 1, { -64, -64, 0 }, { 0, 64, 64 }, 0, 1, 0, 0 },
        { 0, 1, 1, { 0, -64, 0 }, { 64, 64, 64 }, 1, 1, 0, 0 } };
    bsp.nodes = { { 0, { 1, -1 }, { -64, -64, -64 }, { 64, 64, 64 }, 0, 2 },
        { 1, { -3, -2 }, { -64, -64, 0 }, { 64, 64, 64 }, 0, 0 } };
    bsp.models = { { { -64, -64, -64 }, { 64, 64, 64 }, { 0, 0, 0 }, 0, 0, 2 } };
    bsp.brushes = { { 0, 1, CONTENTS_SOLID } };
    bsp.brush_sides = { { 0, -1 } };
    bsp.areas = { { 0, 0 }, { 1, 0 } };
    bsp.area_portals = { { 0, 0 } };
    bsp.visibility = make_visibility();
    bsp.cluster_count = 2;
    return bsp;
}

IndexedImage make_indexed_image(int width, int height)
{
    IndexedImage image { width, height, {}, {} };
    for (int i = 0; i < 256; i++)
        image.palette[size_t(i)] = { uint8_t(i), uint8_t(255 - i), uint8_t(i * 7), 255 };
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            image.pixels.push_back(uint8_t(y % 3 == 0 ? 7 : y % 3 == 1 ? 250 + x / 70 : x * 37 + y * 11));
    return image;
}

Image make_image(int width, int height)
{
    Image image { width, height, {} };
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            image.pixels.push_back({ uint8_t(x * 8), uint8_t(y * 8), uint8_t(x ^ y), uint8_t(255 - x) });
    return image;
}

Md2Model make_md2()
{
    const std::array<glm::vec3, 4> corners { { { 0, 0, 20 }, { 10, 0, 0 }, { -10, 10, 0 }, { -10, -10, 0 } } };
    constexpr std::array<uint8_t, 5> source { 0, 1, 2, 3, 1 }; // corner 1 twice: the seam
    Md2Model model;
    model.skin_width = 64;
    model.skin_height = 32;
    model.skins = { "models/sample/skin.pcx", "models/sample/pain.pcx" };
    model.texture_coordinates = { { 32.5f / 64, 0.5f / 32 }, { 0.5f / 64, 16.5f / 32 }, { 20.5f / 64, 16.5f / 32 },
        { 40.5f / 64, 16.5f / 32 }, { 63.5f / 64, 16.5f / 32 } };
    model.indices = { 0, 1, 2, 0, 2, 3, 0, 3, 4, 1, 3, 2 };
    for (const float stretch : { 1.f, 1.5f }) {
        Md2Model::Frame frame;
        frame.name = stretch == 1.f ? "stand01" : "jump02";
        for (const uint8_t corner : source) {
            frame.positions.push_back(corners[corner] * glm::vec3(1, 1, stretch));
            frame.normals.push_back(glm::normalize(corners[corner] - glm::vec3(0, 0, 5)));
        }
        model.frames.push_back(frame);
    }
    return model;
}

std::vector<Md2Model> make_md3()
{
    std::vector<Md2Model> surfaces(2, make_md2());
    surfaces[1].skins = { "models/sample/base.tga" };
    for (Md2Model::Frame& frame : surfaces[1].frames)
        for (glm::vec3& position : frame.positions)
            position.z -= 40;
    return surfaces;
}

IqmModel make_iqm()
{
    constexpr uint8_t shoulder = 0, elbow = 1;
    const auto vertex = [](glm::vec3 position, glm::vec3 normal, glm::vec2 coordinate, std::array<uint8_t, 4> weights) {
        return IqmModel::Vertex { position, normal, coordinate, { shoulder, elbow, 0, 0 }, weights };
    };
    constexpr std::array<uint8_t, 4> upper { 255, 0, 0, 0 }, lower { 0, 255, 0, 0 }, both { 51, 204, 0, 0 };
    IqmModel model;
    IqmModel::Mesh arm { "arm", "Red", {}, { 0, 1, 2, 0, 2, 3, 3, 2, 4 } };
    arm.vertices = { vertex({ 0, -4, 0 }, { 0, -1, 0 }, { 0, 0 }, upper),
        vertex({ 4, 0, 0 }, { 1, 0, 0 }, { 1, 0 }, upper), vertex({ 4, 0, 20 }, { 1, 0, 0 }, { 1, 0.5f }, both),
        vertex({ 0, -4, 20 }, { 0, -1, 0 }, { 0, 0.5f }, both), vertex({ 0, 0, 40 }, { 0, 0, 1 }, { 0.5f, 1 }, lower) };
    IqmModel::Mesh hand { "hand", "blue", {}, { 0, 1, 2 } };
    hand.vertices = { vertex({ 0, 0, 40 }, { 1, 0, 0 }, { 0, 0 }, lower),
        vertex({ 0, 6, 50 }, { 1, 0, 0 }, { 1, 0 }, lower), vertex({ 0, -6, 50 }, { 1, 0, 0 }, { 0, 1 }, lower) };
    model.meshes = { arm, hand };
    IqmModel::Joint lower_arm { "elbow", shoulder, {} };
    lower_arm.bind.translation = { 0, 0, 20 };
    model.joints = { { "shoulder", -1, {} }, lower_arm };
    IqmModel::Placing bent = lower_arm.bind, lifted;
    bent.rotation = glm::angleAxis(glm::half_pi<float>(), glm::vec3(0, 1, 0)); // z turns to x
    lifted.translation = { 0, 0, 8 };
    model.frames = { { {}, lower_arm.bind }, { lifted, bent } };
    return model;
}

Sp2Sprite make_sp2()
{
    return { { { 32, 48, 16, 24, "sprites/sample_0.pcx" }, { 64, 64, 32, 0, "sprites/sample_1.pcx" } } };
}

std::vector<std::byte> make_m8()
{
    ByteWriter writer;
    writer.write(int32_t(2));
    writer.write_string("walls/m8", 32);
    for (const uint32_t first : { 8u, 4u, 1040u }) {
        writer.write(first);
        for (int mip = 1; mip < 16; mip++)
            writer.write(uint32_t(0));
    }
    writer.write_string("walls/m8_next", 32);
    for (int i = 0; i < 256; i++)
        writer.write(std::array<uint8_t, 3> { uint8_t(i), uint8_t(i / 2), uint8_t(i / 4) });
    for (const int32_t number : { 1, 2, 3 })
        writer.write(number);
    for (int i = 0; i < 32; i++)
        writer.write(uint8_t(i * 8));
    return writer.take();
}

std::vector<std::byte> make_m32()
{
    ByteWriter writer;
    writer.write(int32_t(4));
    for (const char* name : { "walls/m32", "walls/other", "walls/m32_next", "walls/damaged" })
        writer.write_string(name, 128);
    for (const uint32_t first : { 8u, 4u, 968u }) {
        writer.write(first);
        for (int mip = 1; mip < 16; mip++)
            writer.write(uint32_t(0));
    }
    for (const int32_t number : { 1, 2, 3 })
        writer.write(number);
    writer.write_string("", 968 - writer.position());
    for (int i = 0; i < 32; i++)
        writer.write(Rgba8 { uint8_t(i), uint8_t(2 * i), uint8_t(3 * i), uint8_t(4 * i) });
    return writer.take();
}

std::vector<std::byte> make_jpg(int width, int height)
{
    const Image image = make_image(width, height);
    ByteWriter writer;
    const auto append = [](void* context, void* data, int size) {
        static_cast<ByteWriter*>(context)->write_bytes({ static_cast<const std::byte*>(data), size_t(size) });
    };
    stbi_write_jpg_to_func(append, &writer, width, height, 4, image.pixels.data(), 95);
    return writer.take();
}

std::vector<std::byte> make_packed_tga()
{
    ByteWriter writer;
    for (const int byte : { 3, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 5, 0, 3, 0, 24, 0 })
        writer.write(uint8_t(byte));
    writer.write_bytes(std::as_bytes(std::span("abc", 3))); // the picture's id
    for (const int byte : { 0x86, 10, 20, 30 }) // seven of one colour: all of the lowest row, two of the next
        writer.write(uint8_t(byte));
    writer.write(uint8_t(7)); // eight literal pixels
    for (int i = 0; i < 8; i++)
        writer.write(std::array<uint8_t, 3> { uint8_t(i), uint8_t(100 + i), uint8_t(200 + i) });
    return writer.take();
}

} // namespace vkpt::samples

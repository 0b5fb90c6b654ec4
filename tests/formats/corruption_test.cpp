// SPDX-License-Identifier: GPL-2.0-or-later
// Every reader gets thousands of broken files: it must read them or throw FormatError, in bounded memory.
#include "formats/entities.hpp"
#include "tests/formats/memory_watch.hpp"
#include "tests/formats/samples.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace formats {

namespace {

using namespace vkpt;

constexpr size_t memory_limit = size_t(256) << 20;

using File = std::vector<std::byte>;

class Mutator {
public:
    explicit Mutator(const File& original)
        : original_(original)
    {
    }

    // The same file for the same number, on every machine.
    File make(uint32_t number)
    {
        random_.seed(number);
        File file = original_;
        const size_t changes = 1 + pick(number % 4 == 0 ? 16 : 3);
        for (size_t i = 0; i < changes && !file.empty(); i++)
            change(file);
        return file;
    }

private:
    size_t pick(size_t count) { return random_() % count; }

    // Half of all changes hit the first bytes: headers are short, and most of what can go wrong is there.
    size_t pick_place(const File& file)
    {
        return pick(2) == 0 ? pick(std::min<size_t>(file.size(), 192)) : pick(file.size());
    }

    void change(File& file)
    {
        const size_t place = pick_place(file);
        switch (pick(6)) {
        case 0:
            file.resize(place);
            break;
        case 1:
            file[place] ^= std::byte(1 << pick(8));
            break;
        case 2:
            file[place] = std::byte(random_());
            break;
        case 3:
            put(file, place & ~size_t(3), uint32_t(random_()));
            break;
        case 4:
            put(file, place & ~size_t(3), hostile_numbers[pick(std::size(hostile_numbers))]);
            break;
        case 5: // a piece of the file in the wrong place
            std::copy_n(file.begin() + ptrdiff_t(pick_place(file)) / 2,
                std::min<size_t>(pick(64), file.size() - place) / 2, file.begin() + ptrdiff_t(place));
            break;
        }
    }

    static void put(File& file, size_t place, uint32_t value)
    {
        std::memcpy(file.data() + place, &value, std::min(sizeof(value), file.size() - place));
    }

    static constexpr uint32_t hostile_numbers[] { 0, 1, 0x7f, 0xff, 0x7fff, 0xffff, 0x10000, 0x7fffffff, 0x80000000,
        0xffffffff, 0xfffffffc, 0x40000000, 0x7f800000 /* infinity */, 0x7fc00000 /* NaN */, 0x00ffffff, 16384 };

    const File& original_;
    std::mt19937 random_;
};

// Gives how many of them were refused.
int count_refused(const File& original, const std::function<void(Bytes)>& read, int mutation_count)
{
    Mutator mutator(original);
    int refused = 0;
    for (int i = 0; i < mutation_count; i++) {
        const File file = mutator.make(uint32_t(i));
        memory_watch::reset_peak();
        try {
            read(file);
        } catch (const FormatError& error) {
            refused++;
            EXPECT_FALSE(error.reason().empty());
        } catch (const std::exception& error) {
            ADD_FAILURE() << "mutation " << i << ": " << error.what();
        }
        EXPECT_LE(memory_watch::peak(), memory_limit) << "mutation " << i;
    }
    return refused;
}

void try_mutations(const File& original, const std::function<void(Bytes)>& read, int mutation_count = 3000)
{
    ASSERT_NO_THROW(read(original));
    const int refused = count_refused(original, read, mutation_count);
    EXPECT_GT(refused, mutation_count / 50); // else the mutations do not reach what is checked
}

// Everything that a user would do with a map that was accepted.
void use_bsp(const Bsp& bsp)
{
    for (size_t face = 0; face < bsp.faces.size(); face++) {
        const auto polygon = bsp.face_polygon(face);
        bsp.texture_coordinates(bsp.texinfos[bsp.faces[face].texinfo], polygon[0] + bsp.face_normal(face));
        bsp.lightmap_extent(face);
    }
    for (const BspLeaf& leaf : bsp.leaves) {
        const ClusterSet set = bsp.pvs(leaf.cluster);
        ASSERT_TRUE(leaf.cluster < 0 || set.contains(leaf.cluster));
    }
    for (const BspModel& model : bsp.models)
        for (const float x : { -100.f, 0.f, 100.f })
            ASSERT_LT(bsp.find_leaf({ x, -x, 1 }, model.head_node), bsp.leaves.size());
    for (size_t i = 0; i < bsp.texinfos.size(); i++) {
        size_t steps = 0;
        for (int32_t at = bsp.texinfos[i].next; at >= 0 && at != int32_t(i); at = bsp.texinfos[size_t(at)].next)
            ASSERT_LE(++steps, bsp.texinfos.size());
    }
    parse_entities(bsp.entity_text, bsp.name);
}

void use_md2(const Md2Model& model)
{
    ASSERT_FALSE(model.frames.empty());
    for (const uint32_t index : model.indices)
        ASSERT_LT(index, model.vertex_count());
    for (const auto& frame : model.frames) {
        ASSERT_EQ(frame.positions.size(), model.vertex_count());
        ASSERT_EQ(frame.normals.size(), model.vertex_count());
    }
}

void use_image(const Image& image)
{
    ASSERT_GT(image.width, 0);
    ASSERT_EQ(image.pixels.size(), size_t(image.width) * size_t(image.height));
}

TEST(Corruption, Bsp)
{
    try_mutations(write_bsp(samples::make_bsp()), [](Bytes file) { use_bsp(read_bsp(file, "m.bsp")); });
}

TEST(Corruption, Qbsp)
{
    Bsp bsp = samples::make_bsp();
    bsp.format = BspFormat::qbsp;
    try_mutations(write_bsp(bsp), [](Bytes file) { use_bsp(read_bsp(file, "m.bsp")); });
}

TEST(Corruption, RealMaps)
{
    const char* folder = std::getenv("VKPT_TEST_MAPS");
    if (!folder)
        GTEST_SKIP() << "set VKPT_TEST_MAPS to a folder of BSP files to break them too";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".bsp" || entry.file_size() > 1000000)
            continue;
        SCOPED_TRACE(entry.path().string());
        File file(entry.file_size());
        std::ifstream(entry.path(), std::ios::binary)
            .read(reinterpret_cast<char*>(file.data()), std::streamsize(file.size()));
        try_mutations(
            file, [](Bytes bytes) { use_bsp(read_bsp(bytes, "m.bsp")); }, 300);
    }
}

TEST(Corruption, Entities)
{
    const std::string text
        = samples::make_bsp().entity_text + "{ \"origin\" \"1 2 3\" // x\n \"light\" \"300\" { ( 0 0 ) } }";
    const auto bytes = std::as_bytes(std::span(text));
    try_mutations(File(bytes.begin(), bytes.end()), [](Bytes file) {
        const std::string_view view(reinterpret_cast<const char*>(file.data()), file.size());
        for (const EntityText& entity : parse_entities(view, "m.ent")) {
            entity.vector("origin");
            entity.number("light", 0);
        }
    });
}

TEST(Corruption, Pcx)
{
    try_mutations(
        write_pcx(samples::make_indexed_image(61, 40)), [](Bytes file) { use_image(read_image(file, "m.pcx", {})); });
}

TEST(Corruption, Wal)
{
    const auto image = samples::make_indexed_image(32, 16);
    try_mutations(write_wal(image, { "a", "b" }), [&](Bytes file) {
        read_wal_info(file, "m.wal");
        use_image(read_image(file, "m.wal", image.palette));
    });
}

TEST(Corruption, M8)
{
    try_mutations(samples::make_m8(), [](Bytes file) { use_image(read_image(file, "m.m8", {})); });
}

TEST(Corruption, M32)
{
    try_mutations(samples::make_m32(), [](Bytes file) { use_image(read_image(file, "m.m32", {})); });
}

TEST(Corruption, Tga)
{
    try_mutations(write_tga(samples::make_image(20, 10)), [](Bytes file) { use_image(read_image(file, "m.tga", {})); });
    try_mutations(samples::make_packed_tga(), [](Bytes file) { use_image(read_image(file, "m.tga", {})); });
}

TEST(Corruption, Png)
{
    try_mutations(write_png(samples::make_image(40, 30)), [](Bytes file) { use_image(read_image(file, "m.png", {})); });
}

TEST(Corruption, Jpg)
{
    try_mutations(samples::make_jpg(40, 30), [](Bytes file) { use_image(read_image(file, "m.jpg", {})); });
}

// Marked as progressive, so that the mutations reach that half of the decoder.
TEST(Corruption, ProgressiveJpg)
{
    File file = samples::make_jpg(40, 30);
    for (size_t i = 0; i + 1 < file.size(); i++) {
        if (file[i] == std::byte { 0xff } && file[i + 1] == std::byte { 0xc0 }) {
            file[i + 1] = std::byte { 0xc2 };
        }
        if (file[i] == std::byte { 0xff } && file[i + 1] == std::byte { 0xda }) {
            file[i + 12] = std::byte { 0 }; // the scan's last coefficient: only the first, as progressive files begin
        }
    }
    const int refused = count_refused(
        file, [](Bytes bytes) { use_image(read_image(bytes, "m.jpg", {})); }, 3000);
    EXPECT_GT(refused, 0);
}

TEST(Corruption, Md2)
{
    try_mutations(write_md2(samples::make_md2()), [](Bytes file) { use_md2(read_md2(file, "m.md2")); });
}

TEST(Corruption, Iqm)
{
    try_mutations(write_iqm(samples::make_iqm()), [](Bytes file) {
        for (const Md2Model& mesh : read_iqm(file, "m.iqm"))
            use_md2(mesh);
    });
}

TEST(Corruption, Md3)
{
    try_mutations(write_md3(samples::make_md3()), [](Bytes file) {
        for (const Md2Model& surface : read_md3(file, "m.md3"))
            use_md2(surface);
    });
}

TEST(Corruption, Sp2)
{
    try_mutations(write_sp2(samples::make_sp2()), [](Bytes file) { read_sp2(file, "m.sp2"); });
}

} // namespace

} // namespace formats

// SPDX-License-Identifier: GPL-2.0-or-later
// The mutators must change what is behind directories, checksums and compression, and leave these whole: else readers
// refuse everything at their door and fuzzing sees nothing of what comes after.
#include "common/trace/file_format.hpp"
#include "formats/bsp.hpp"
#include "formats/image.hpp"
#include "formats/model.hpp"
#include "fuzz/support/mutate.hpp"
#include "fuzz/support/packed.hpp"
#include "tests/formats/samples.hpp"

#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <set>

namespace vkpt::fuzz {
namespace {

constexpr size_t limit = 4096;
constexpr int tries = 2000;

File to_file(const std::vector<std::byte>& bytes)
{
    const auto* first = reinterpret_cast<const uint8_t*>(bytes.data());
    return { first, first + bytes.size() };
}
formats::Bytes to_bytes(const File& file) { return std::as_bytes(std::span(file)); }

struct Counts {
    int accepted = 0;
    std::set<File> different;
};

Counts mutate_often(const File& seed, File (*mutate)(const File&, size_t, Random&),
    const std::function<void(const File&)>& read, size_t longest = limit)
{
    Random random(1);
    Counts counts;
    for (int i = 0; i < tries; i++) {
        const File file = mutate(seed, longest, random);
        EXPECT_LE(file.size(), longest);
        counts.different.insert(file);
        try {
            read(file);
            counts.accepted++;
        } catch (const formats::FormatError&) {
        }
    }
    return counts;
}

TEST(Mutators, MapsStayReadable)
{
    for (const formats::BspFormat format : { formats::BspFormat::ibsp, formats::BspFormat::qbsp }) {
        formats::Bsp bsp = samples::make_bsp();
        bsp.format = format;
        const Counts counts = mutate_often(to_file(formats::write_bsp(bsp)), mutate_bsp,
            [](const File& file) { formats::read_bsp(to_bytes(file), "map"); });
        EXPECT_GT(counts.accepted, tries / 5);
        EXPECT_LT(counts.accepted, tries * 9 / 10);
        EXPECT_GT(counts.different.size(), size_t(tries / 2));
    }
}

TEST(Mutators, ModelsStayReadable)
{
    const Counts counts = mutate_often(to_file(formats::write_md2(samples::make_md2())), mutate_md2,
        [](const File& file) { formats::read_md2(to_bytes(file), "model"); });
    EXPECT_GT(counts.accepted, tries / 5);
    EXPECT_LT(counts.accepted, tries * 9 / 10);
    EXPECT_GT(counts.different.size(), size_t(tries / 2));
}

TEST(Mutators, PicturesStayReadable)
{
    const Counts counts = mutate_often(to_file(formats::write_png(samples::make_image(5, 5))), mutate_png,
        [](const File& file) { formats::read_common_image(to_bytes(file), "picture"); });
    EXPECT_GT(counts.accepted, tries / 10);
    EXPECT_LT(counts.accepted, tries * 9 / 10);
}

// A trace of one chunk of 256 bytes.
File make_trace()
{
    using namespace trace;
    FileHeader start;
    start.crc = header_crc(start);
    const File packed = pack(File(256, 7));
    ChunkHeader header { tag_calls, uint32_t(packed.size()), 256, 0, crc_of(packed), 0 };
    header.crc = header_crc(header);
    File file(sizeof start + sizeof header);
    std::memcpy(file.data(), &start, sizeof start);
    std::memcpy(file.data() + sizeof start, &header, sizeof header);
    file.insert(file.end(), packed.begin(), packed.end());
    return file;
}

TEST(Mutators, ChunksOfTracesKeepTheirChecksums)
{
    using namespace trace;
    std::set<File> payloads;
    const Counts counts = mutate_often(make_trace(), mutate_trace, [&](const File& file) {
        ChunkHeader header;
        if (file.size() < sizeof(FileHeader) + sizeof header)
            throw formats::FormatError("trace", 0, "short");
        std::memcpy(&header, file.data() + sizeof(FileHeader), sizeof header);
        const File packed(file.begin() + sizeof(FileHeader) + sizeof header, file.end());
        if (header.crc != header_crc(header) || packed.size() < header.packed_bytes)
            throw formats::FormatError("trace", 0, "damaged");
        const File raw = unpack(File(packed.begin(), packed.begin() + header.packed_bytes), 1 << 16);
        if (raw.size() != header.raw_bytes)
            throw formats::FormatError("trace", 0, "damaged");
        payloads.insert(raw);
    });
    EXPECT_GT(counts.accepted, tries / 2);
    EXPECT_GT(payloads.size(), size_t(tries / 10));
}

TEST(Mutators, TakeAnything)
{
    Random random(2);
    for (const auto mutate : { mutate_bsp, mutate_md2, mutate_png, mutate_trace, mutate_numbers })
        for (const size_t size : { 0, 1, 7, 16, 60, 200 }) {
            File file(size, 0xff);
            for (int i = 0; i < 200; i++) {
                file = mutate(file, 256, random);
                ASSERT_LE(file.size(), 256u);
            }
        }
}

TEST(Mutators, AreRepeatable)
{
    const File seed = to_file(formats::write_bsp(samples::make_bsp()));
    for (uint32_t i = 0; i < 100; i++) {
        Random a(i), b(i);
        ASSERT_EQ(mutate_bsp(seed, limit, a), mutate_bsp(seed, limit, b));
    }
}

} // namespace
} // namespace vkpt::fuzz

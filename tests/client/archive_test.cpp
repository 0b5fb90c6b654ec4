// SPDX-License-Identifier: GPL-2.0-or-later
// Game folders with damaged or hostile archives, and with links.
#include "client/host/file_system.hpp"
#include "tests/client/run_program.hpp"
#include "tests/formats/file_budget.hpp"

#include <cstdint>
#include <gtest/gtest.h>
#include <zlib.h>

namespace vkpt::tests {
namespace {

namespace fs = std::filesystem;
using client::FileSystem;

struct ZipFile {
    std::string name, text;
    uint32_t told_size = 0; // 0: as it is
    uint32_t attributes = 0;
};

std::string little_endian(uint32_t number, size_t bytes)
{
    std::string text;
    for (size_t i = 0; i < bytes; i++)
        text += char(number >> (8 * i) & 0xff);
    return text;
}

std::string deflate_raw(const std::string& text)
{
    z_stream stream {};
    deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY);
    std::string packed(deflateBound(&stream, text.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = uInt(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

std::string make_zip(const std::vector<ZipFile>& files)
{
    std::string zip, directory;
    for (const ZipFile& file : files) {
        const std::string packed = deflate_raw(file.text);
        const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(file.text.data()), uInt(file.text.size()));
        const uint32_t size = file.told_size ? file.told_size : uint32_t(file.text.size());
        const std::string common = little_endian(20, 2) + little_endian(0, 2) + little_endian(8, 2)
            + little_endian(0, 4) + little_endian(uint32_t(sum), 4) + little_endian(uint32_t(packed.size()), 4)
            + little_endian(size, 4) + little_endian(uint32_t(file.name.size()), 2) + little_endian(0, 2);
        const size_t offset = zip.size();
        zip += "PK\x03\x04" + common + file.name + packed;
        directory += "PK\x01\x02" + little_endian(0x0314, 2) + common + little_endian(0, 6)
            + little_endian(file.attributes, 4) + little_endian(uint32_t(offset), 4) + file.name;
    }
    const std::string count = little_endian(uint32_t(files.size()), 2);
    const uint32_t start = uint32_t(zip.size());
    return zip + directory + "PK\x05\x06" + little_endian(0, 4) + count + count
        + little_endian(uint32_t(directory.size()), 4) + little_endian(start, 4) + little_endian(0, 2);
}

class Archives : public testing::Test {
protected:
    std::string read(const FileSystem& files, const char* path) const
    {
        const auto bytes = files.read(path);
        return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "(missing)";
    }
    FileSystem::Warn warn()
    {
        return [this](const std::string& line) { warnings_.push_back(line); };
    }
    void expect_warning(const std::string& a, const std::string& b)
    {
        ASSERT_EQ(warnings_.size(), 1u);
        EXPECT_NE(warnings_[0].find(a), std::string::npos) << warnings_[0];
        EXPECT_NE(warnings_[0].find(b), std::string::npos) << warnings_[0];
    }

    ScratchFolder folder_;
    std::vector<std::string> warnings_;
};

TEST_F(Archives, GoodZipsAreReadWithoutAWord)
{
    folder_.write("baseq2/good.pk3", make_zip({ { "a.txt", "good" }, { "maps/b.txt", "deep" } }));
    const FileSystem files(folder_.path(), "", warn());
    EXPECT_EQ(read(files, "a.txt"), "good");
    EXPECT_EQ(read(files, "maps/b.txt"), "deep");
    EXPECT_TRUE(warnings_.empty()) << warnings_[0];
}

TEST_F(Archives, ABadOneIsNamedAndLeftOut)
{
    folder_.write("baseq2/good.pk3", make_zip({ { "a.txt", "good" } }));
    folder_.write("baseq2/a.txt", "loose");
    const std::string good = make_zip({ { "a.txt", "bad" } });
    std::string no_end = good, no_directory = good, short_directory = good;
    no_end[good.size() - 22] = 'x';
    no_directory[good.find("PK\x01\x02")] = 'x';
    short_directory[good.size() - 22 + 10] = '\x09'; // nine files
    for (const std::string& bad : { std::string("this is no archive"), std::string(), no_end, no_directory,
             short_directory, good.substr(0, good.size() - 30), std::string("PACK") }) {
        warnings_.clear();
        folder_.write("baseq2/z.pk3", bad);
        const FileSystem files(folder_.path(), "", warn());
        EXPECT_EQ(read(files, "a.txt"), "good");
        expect_warning("z.pk3", "left out");
    }
}

TEST_F(Archives, FalseSizesTakeNoMemory)
{
    const Cost cost = expect_within_budget("false sizes", [&] {
        folder_.write(
            "baseq2/size.pk3", make_zip({ { "a.txt", "short", 0xfffffff0 }, { "b.txt", "short", 30000000 } }));
        const FileSystem files(folder_.path(), "", warn());
        if (files.read("a.txt") || files.read("b.txt") || warnings_.size() != 2)
            throw std::runtime_error("was read");
    });
    EXPECT_EQ(cost.outcome, "read");
    EXPECT_LT(cost.peak_bytes, size_t(64) << 20);
}

TEST_F(Archives, ZerosUnpackToALimit)
{
    folder_.write("baseq2/zeros.pk3", make_zip({ { "a.txt", std::string(size_t(80) << 20, '\0') } }));
    const Cost cost = expect_within_budget("zeros", [&] {
        const FileSystem files(folder_.path(), "", warn());
        if (files.read("a.txt"))
            throw std::runtime_error("was read");
    });
    EXPECT_EQ(cost.outcome, "read");
    EXPECT_LT(cost.peak_bytes, size_t(64) << 20);
}

// Each folder of a name takes memory for all of the name up to it: 60,000 bytes of name a gigabyte.
TEST_F(Archives, LongNamesAndLinksAreRefused)
{
    std::string name;
    while (name.size() < 60000)
        name += "a/";
    const uint32_t unix_link = 0xa1ffu << 16;
    for (const ZipFile& file : { ZipFile { name + "b", "x" }, ZipFile { "link", "x", 0xfffffff0, unix_link } }) {
        const Cost cost = expect_within_budget(file.name.substr(0, 10), [&] {
            folder_.write("baseq2/z.pk3", make_zip({ file }));
            const FileSystem files(folder_.path(), "", warn());
            if (warnings_.size() != 1)
                throw std::runtime_error("no warning");
        });
        EXPECT_EQ(cost.outcome, "read");
        EXPECT_LT(cost.peak_bytes, size_t(64) << 20);
    }
}

TEST_F(Archives, LinkedFoldersAreSearched)
{
    folder_.write("elsewhere/packs/base1.bsp", "map");
    folder_.write("elsewhere/deep.txt", "deep");
    folder_.write("baseq2/a.txt", "loose");
    fs::create_directory_symlink(folder_.path() / "elsewhere/packs", folder_.path() / "baseq2/maps");
    fs::create_directory_symlink(folder_.path() / "elsewhere", folder_.path() / "baseq2/all");
    fs::create_symlink(folder_.path() / "elsewhere/deep.txt", folder_.path() / "baseq2/one.txt");
    const FileSystem files(folder_.path(), "", warn());
    EXPECT_EQ(read(files, "maps/base1.bsp"), "map");
    EXPECT_EQ(read(files, "all/packs/base1.bsp"), "map");
    EXPECT_EQ(read(files, "one.txt"), "deep");
    EXPECT_EQ(files.list("maps", ".bsp"), std::vector<std::string> { "maps/base1.bsp" });
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(Archives, LinksInCirclesEnd)
{
    folder_.write("baseq2/a.txt", "loose");
    folder_.write("baseq2/x/b.txt", "b");
    fs::create_directory_symlink(folder_.path() / "baseq2", folder_.path() / "baseq2/self");
    fs::create_directory_symlink(folder_.path(), folder_.path() / "baseq2/x/up");
    fs::create_directory_symlink(folder_.path() / "nowhere", folder_.path() / "baseq2/broken");
    const FileSystem files(folder_.path(), "", warn());
    EXPECT_EQ(read(files, "a.txt"), "loose");
    EXPECT_EQ(read(files, "x/b.txt"), "b");
    EXPECT_FALSE(files.exists("self/self/a.txt"));
}

} // namespace
} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// The search for pictures, on a made-up set of files.
#include "ref_vkpt/scene/texture_files.hpp"
#include "tests/formats/picture_bombs.hpp"
#include "tests/textures/make_plain.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>

namespace vkpt {
namespace {

const TextureWish with_replacements { .retexturing = true };
const TextureWish originals_only;

formats::Palette make_test_palette()
{
    formats::Palette palette;
    for (size_t i = 0; i < palette.size(); i++)
        palette[i] = { uint8_t(i), uint8_t(255 - i), 7, 255 };
    return palette;
}

formats::IndexedImage make_indexed(int width, int height, uint8_t index)
{
    return { width, height, std::vector<uint8_t>(size_t(width * height), index), make_test_palette() };
}

class PictureFilesTest : public testing::Test {
protected:
    PictureFilesTest() { files["pics/colormap.pcx"] = formats::write_pcx(make_indexed(4, 4, 1)); }

    void add_wall(const std::string& path, int width, int height, uint8_t index)
    {
        formats::WallInfo info;
        info.name = "test";
        info.width = width;
        info.height = height;
        files[path] = formats::write_wal(make_indexed(width, height, index), info);
    }

    TextureFiles make()
    {
        TextureFiles pictures(
            [this](const std::string& path) -> std::optional<std::vector<std::byte>> {
                asked.push_back(path);
                const auto found = files.find(path);
                return found == files.end() ? std::nullopt : std::optional(found->second);
            },
            [this](std::string_view line) { reports.emplace_back(line); });
        pictures.load_palette();
        return pictures;
    }

    bool reported(std::string_view part) const
    {
        return std::ranges::any_of(reports, [&](const std::string& r) { return r.find(part) != std::string::npos; });
    }

    std::map<std::string, std::vector<std::byte>> files;
    std::vector<std::string> asked, reports;
};

TEST_F(PictureFilesTest, WallsGetTheGamesPaletteAndStayOpaque)
{
    add_wall("textures/e1u1/floor.wal", 32, 16, 255);
    const auto wall = make().load("e1u1/floor", TextureUse::wall, originals_only);
    ASSERT_TRUE(wall);
    EXPECT_EQ(wall->path, "textures/e1u1/floor.wal");
    EXPECT_EQ(wall->file, wall->path);
    EXPECT_EQ(wall->width, 32);
    EXPECT_EQ(wall->height, 16);
    EXPECT_EQ(wall->image.at(3, 3), (formats::Rgba8 { 255, 0, 7, 255 }));
    EXPECT_TRUE(reports.empty());
}

TEST_F(PictureFilesTest, PicturesHaveTransparentPixelsSkinsDoNot)
{
    files["pics/a.pcx"] = formats::write_pcx(make_indexed(8, 8, 255));
    files["players/male/a.pcx"] = files["pics/a.pcx"];
    TextureFiles pictures = make();
    EXPECT_EQ(pictures.load("a", TextureUse::image, originals_only)->image.at(0, 0).a, 0);
    EXPECT_EQ(pictures.load("/players/male/a.pcx", TextureUse::image, originals_only)->image.at(0, 0).a, 0);
    EXPECT_EQ(pictures.load("players/male/a.pcx", TextureUse::sprite, originals_only)->image.at(0, 0).a, 0);
    EXPECT_EQ(pictures.load("players/male/a.pcx", TextureUse::skin, originals_only)->image.at(0, 0).a, 255);
}

// The pattern of the algorithm's own description: a diagonal edge gets steps of half a pixel, a straight one stays.
TEST(DoubleTexture, RoundsDiagonalsAndKeepsStraightEdges)
{
    const formats::Rgba8 o { 0, 0, 0, 255 }, x { 200, 100, 50, 255 }, y { 1, 2, 3, 0 };
    const formats::Image diagonal { 3, 3, { x, o, o, x, x, o, x, x, x } };
    const formats::Image twice = double_texture(diagonal);
    EXPECT_EQ(twice.width, 6);
    EXPECT_EQ(twice.height, 6);
    EXPECT_EQ(twice.pixels,
        (std::vector<formats::Rgba8> {
            x,
            x,
            o,
            o,
            o,
            o, //
            x,
            x,
            x,
            o,
            o,
            o, //
            x,
            x,
            x,
            o,
            o,
            o, //
            x,
            x,
            x,
            x,
            x,
            o, //
            x,
            x,
            x,
            x,
            x,
            x, //
            x,
            x,
            x,
            x,
            x,
            x,
        }));
    const formats::Image edge { 2, 2, { x, y, x, y } };
    EXPECT_EQ(
        double_texture(edge).pixels, (std::vector<formats::Rgba8> { x, x, y, y, x, x, y, y, x, x, y, y, x, x, y, y }));
    EXPECT_EQ(double_texture({ 1, 1, { x } }).pixels, std::vector<formats::Rgba8>(4, x));
    const formats::Image dot = double_texture({ 3, 3, { o, o, o, o, x, o, o, o, o } });
    EXPECT_EQ(std::ranges::count(dot.pixels, x), 4); // it stays
}

TEST_F(PictureFilesTest, OriginalsOf8BitsAreDoubledOnRequestAlone)
{
    add_wall("textures/a.wal", 32, 16, 3);
    add_wall("textures/b.wal", 32, 16, 3);
    files["textures/b.png"] = formats::write_png(make_plain(32, 16, { 1, 2, 3, 255 }));
    files["env/c.tga"] = formats::write_tga(make_plain(8, 8, { 1, 2, 3, 255 }));
    const auto width = [&](std::string_view name, TextureUse use, bool doubled) {
        const auto loaded = make().load(name, use, { .retexturing = true, .doubled = doubled });
        EXPECT_TRUE(loaded && loaded->width == (use == TextureUse::sky ? 8 : 32)) << name;
        return loaded ? loaded->image.width : 0;
    };
    EXPECT_EQ(width("a", TextureUse::wall, false), 32);
    EXPECT_EQ(width("a", TextureUse::wall, true), 64);
    EXPECT_EQ(width("b", TextureUse::wall, true), 32); // replaced
    EXPECT_EQ(width("c", TextureUse::sky, true), 8);
    EXPECT_TRUE(reports.empty());
}

TEST_F(PictureFilesTest, NamesBecomePaths)
{
    const auto first = [](std::string_view name, TextureUse use) { return TextureFiles::original_paths(name, use)[0]; };
    EXPECT_EQ(first("inven", TextureUse::image), "pics/inven.pcx");
    EXPECT_EQ(first("/pics/colors.png", TextureUse::image), "pics/colors.png");
    EXPECT_EQ(first("\\players\\male\\a_i.pcx", TextureUse::image), "players/male/a_i.pcx");
    EXPECT_EQ(first("e1u1/floor", TextureUse::wall), "textures/e1u1/floor.wal");
    EXPECT_EQ(first("unit1_rt", TextureUse::sky), "env/unit1_rt.tga");
    EXPECT_EQ(first("models\\a\\skin.pcx", TextureUse::skin), "models/a/skin.pcx");
}

TEST_F(PictureFilesTest, ReplacementsComeFirstInTheEnginesOrderAndKeepTheOriginalsSize)
{
    add_wall("textures/a.wal", 16, 16, 3);
    files["textures/a.png"] = formats::write_png(make_plain(64, 32, { 1, 2, 3, 255 }));
    const auto png = make().load("a", TextureUse::wall, with_replacements);
    ASSERT_TRUE(png);
    EXPECT_EQ(png->path, "textures/a.wal");
    EXPECT_EQ(png->file, "textures/a.png");
    EXPECT_EQ(png->image.width, 64);
    EXPECT_EQ(png->width, 16);
    EXPECT_EQ(png->height, 16);

    files["textures/a.tga"] = formats::write_tga(make_plain(32, 32, { 9, 9, 9, 255 }));
    EXPECT_EQ(make().load("a", TextureUse::wall, with_replacements)->file, "textures/a.tga");
    EXPECT_EQ(make().load("a", TextureUse::wall, originals_only)->file, "textures/a.wal");
}

TEST_F(PictureFilesTest, ReplacementWithoutOriginalHasItsOwnSize)
{
    files["pics/new.png"] = formats::write_png(make_plain(20, 10, { 1, 2, 3, 128 }));
    TextureFiles pictures = make();
    const auto picture = pictures.load("new", TextureUse::image, with_replacements);
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->width, 20);
    EXPECT_EQ(picture->height, 10);
    EXPECT_EQ(picture->image.at(0, 0).a, 128);
    EXPECT_FALSE(pictures.load("new", TextureUse::image, originals_only));
}

TEST_F(PictureFilesTest, MasksCutHolesInWalls)
{
    add_wall("textures/a.wal", 8, 4, 3);
    formats::Image mask = make_plain(4, 2, { 127, 255, 255, 255 });
    mask.pixels[1].r = mask.pixels[6].r = 128;
    files["masks/a.png"] = formats::write_png(mask);
    TextureWish wish = with_replacements;
    wish.mask = "masks/a";
    const auto wall = make().load("a", TextureUse::wall, wish);
    ASSERT_TRUE(wall && wall->has_holes);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 8; x++) {
            const bool is_solid = (x / 2 == 1 && y / 2 == 0) || (x / 2 == 2 && y / 2 == 1);
            EXPECT_EQ(wall->image.at(x, y).a, is_solid ? 255 : 0) << x << ' ' << y;
        }
    wish.retexturing = false;
    EXPECT_FALSE(make().load("a", TextureUse::wall, wish)->has_holes);
    wish = with_replacements;
    wish.mask = "masks/none";
    EXPECT_FALSE(make().load("a", TextureUse::wall, wish)->has_holes);
    EXPECT_TRUE(reported("texture_mask masks/none of textures/a.wal is missing"));
}

TEST_F(PictureFilesTest, MissingFilesOfMaterialsAreNamed)
{
    add_wall("textures/a.wal", 16, 16, 3);
    TextureWish wish = with_replacements;
    wish.file = "overrides/a.tga";
    EXPECT_EQ(make().load("a", TextureUse::wall, wish)->file, "textures/a.wal");
    EXPECT_TRUE(reported("texture_base overrides/a.tga of textures/a.wal is missing"));
    reports.clear();
    wish.retexturing = false;
    make().load("a", TextureUse::wall, wish);
    wish.retexturing = true;
    files["overrides/a.png"] = formats::write_png(make_plain(16, 16, { 1, 2, 3, 255 }));
    EXPECT_EQ(make().load("a", TextureUse::wall, wish)->file, "overrides/a.png");
    EXPECT_TRUE(reports.empty());
}

TEST_F(PictureFilesTest, SmallerOrDamagedReplacementIsNamedAndPassedOver)
{
    add_wall("textures/a.wal", 64, 64, 3);
    files["textures/a.tga"] = std::vector<std::byte>(7, std::byte { 1 });
    files["textures/a.png"] = formats::write_png(make_plain(32, 64, { 1, 2, 3, 255 }));
    const auto wall = make().load("a", TextureUse::wall, with_replacements);
    ASSERT_TRUE(wall);
    EXPECT_EQ(wall->file, "textures/a.wal");
    EXPECT_TRUE(reported("textures/a.tga is damaged at byte"));
    EXPECT_TRUE(reported("textures/a.png is not used"));
}

TEST_F(PictureFilesTest, ReplacementStandsInForDamagedOriginal)
{
    files["textures/a.wal"] = std::vector<std::byte>(50);
    files["textures/a.png"] = formats::write_png(make_plain(32, 64, { 1, 2, 3, 255 }));
    const auto wall = make().load("a", TextureUse::wall, with_replacements);
    ASSERT_TRUE(wall);
    EXPECT_EQ(wall->width, 32);
    EXPECT_EQ(wall->height, 64);
}

TEST_F(PictureFilesTest, EveryCutOfAWallIsReportedNotThrown)
{
    add_wall("textures/a.wal", 16, 16, 3);
    const std::vector<std::byte> whole = files["textures/a.wal"];
    // The format's header and the picture itself; what follows is smaller copies that are not read.
    for (size_t size = 0; size < 100 + 16 * 16; size += 9) {
        files["textures/a.wal"].assign(whole.begin(), whole.begin() + std::ptrdiff_t(size));
        reports.clear();
        EXPECT_FALSE(make().load("a", TextureUse::wall, with_replacements)) << size;
        EXPECT_EQ(reports.size(), 1u) << size;
        EXPECT_TRUE(reported("textures/a.wal")) << size;
    }
}

TEST_F(PictureFilesTest, MissingPicturesAreNothingAndSilent)
{
    TextureFiles pictures = make();
    for (TextureUse use :
        { TextureUse::wall, TextureUse::skin, TextureUse::sprite, TextureUse::image, TextureUse::sky })
        for (const char* name : { "none", "", "/", "/a", "a.b", "../x.pcx", "dir.x/none" })
            EXPECT_FALSE(pictures.load(name, use, with_replacements)) << name;
    EXPECT_TRUE(reports.empty());
}

TEST_F(PictureFilesTest, SkiesPreferTga)
{
    files["env/s_rt.pcx"] = formats::write_pcx(make_indexed(8, 8, 255));
    EXPECT_EQ(make().load("s_rt", TextureUse::sky, originals_only)->file, "env/s_rt.pcx");
    EXPECT_EQ(make().load("s_rt", TextureUse::sky, originals_only)->image.at(0, 0).a, 255);
    files["env/s_rt.tga"] = formats::write_tga(make_plain(8, 8, { 1, 2, 3, 4 }));
    EXPECT_EQ(make().load("s_rt", TextureUse::sky, originals_only)->file, "env/s_rt.tga");
    EXPECT_EQ(make().load("s_rt", TextureUse::sky, originals_only)->image.at(0, 0).a, 255);
}

TEST_F(PictureFilesTest, PaletteIsTheGamesOrAStandIn)
{
    EXPECT_EQ(make().palette()[10], (formats::Rgba8 { 10, 245, 7, 255 }));
    EXPECT_EQ(make().palette()[255].a, 0);
    EXPECT_TRUE(reports.empty());

    files["pics/colormap.pcx"].resize(20);
    EXPECT_EQ(make().palette(), make_neutral_palette());
    EXPECT_TRUE(reported("pics/colormap.pcx is damaged"));

    reports.clear();
    files.erase("pics/colormap.pcx");
    EXPECT_EQ(make().palette(), make_neutral_palette());
    ASSERT_EQ(reports.size(), 1u);
    EXPECT_TRUE(reported("pics/colormap.pcx is missing"));
}

// One archive may have hundreds of such pictures in a megabyte.
TEST_F(PictureFilesTest, ALevelsPicturesHaveABudgetTogether)
{
    constexpr int large = 4096; // two of these are the budget
    const std::vector<std::byte> black
        = samples::make_black_png({ .width = large, .height = large, .bits = 1, .colour_type = 0 });
    ASSERT_LT(black.size(), 8192u);
    for (const char* name : { "a", "b", "c" })
        files["textures/" + std::string(name) + ".png"] = black;
    add_wall("textures/c.wal", 32, 16, 5);
    files["textures/d.png"] = samples::make_black_png({ .width = 64, .height = 64 });
    TextureFiles pictures = make();
    for (const char* name : { "a", "b" })
        EXPECT_EQ(pictures.load(name, TextureUse::wall, with_replacements).value().image.width, large);
    EXPECT_TRUE(reports.empty());
    EXPECT_EQ(pictures.load("c", TextureUse::wall, with_replacements).value().file, "textures/c.wal");
    EXPECT_TRUE(reported("textures/c.png")) << "is named";
    EXPECT_TRUE(reported("have left room for")) << "with the reason";
    add_wall("textures/d.wal", 64, 64, 5);
    EXPECT_EQ(pictures.load("d", TextureUse::wall, with_replacements).value().file, "textures/d.png") << "it is small";
    pictures.begin_level();
    EXPECT_EQ(pictures.load("c", TextureUse::wall, with_replacements).value().file, "textures/c.png");
}

TEST(PixelBudgetTest, GrowsWithTheFiles)
{
    PixelBudget budget;
    formats::Image image;
    image.pixels.resize(PixelBudget::pixels_of_any_files / 2);
    for (int i = 0; i < 5; i++) // a byte for each 32 pixels: for ever
        budget.spend(image, image.pixels.size() / PixelBudget::pixels_per_byte);
    EXPECT_EQ(budget.room(0), PixelBudget::pixels_of_any_files);
    EXPECT_EQ(budget.room(100), PixelBudget::pixels_of_any_files + 100 * PixelBudget::pixels_per_byte);
    for (int i = 0; i < 3; i++) // by none
        budget.spend(image, 0);
    EXPECT_EQ(budget.room(0), 0u);
}

TEST(NeutralPaletteTest, StartsWithAGreyRampAndEndsTransparent)
{
    const formats::Palette palette = make_neutral_palette();
    for (size_t i = 0; i < 16; i++) {
        EXPECT_EQ(palette[i].r, palette[i].g);
        EXPECT_EQ(palette[i].g, palette[i].b);
        EXPECT_TRUE(i == 0 || palette[i].r > palette[i - 1].r);
    }
    EXPECT_EQ(palette[0], (formats::Rgba8 { 0, 0, 0, 255 }));
    EXPECT_EQ(palette[15], (formats::Rgba8 { 255, 255, 255, 255 }));
    EXPECT_EQ(palette[255].a, 0);
}

TEST(MeasurePictureTest, AveragesLinearLightByAlpha)
{
    formats::Image image = make_plain(2, 2, { 255, 0, 0, 255 });
    image.pixels[1] = { 0, 255, 0, 0 };
    image.pixels[2] = { 188, 0, 0, 255 }; // about half the light
    image.pixels[3] = { 0, 0, 0, 127 };
    const TextureMeasure measure = measure_texture(image);
    EXPECT_NEAR(measure.average.x, (1 + 0.503) / (2 + 127 / 255.0), 0.002);
    EXPECT_EQ(measure.average.y, 0);
    EXPECT_FLOAT_EQ(measure.opaque_fraction, 0.5f);
    EXPECT_TRUE(measure.has_alpha);
    EXPECT_FALSE(measure_texture(make_plain(3, 3, { 1, 1, 1, 255 })).has_alpha);
}

TEST(ShrinkPictureTest, HalvesInLinearLightUntilItFits)
{
    formats::Image image = make_plain(64, 6, { 0, 0, 0, 255 });
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x += 2)
            image.pixels[size_t(y * image.width + x)] = { 255, 255, 255, 255 };
    const formats::Image small = shrink_texture(image, 16);
    EXPECT_EQ(small.width, 16);
    EXPECT_EQ(small.height, 1);
    EXPECT_NEAR(small.at(5, 0).r, 188, 1);
    EXPECT_EQ(shrink_texture(image, 64).pixels, image.pixels);
}

} // namespace
} // namespace vkpt

// SPDX-License-Identifier: GPL-2.0-or-later
// The 2D layer over a 3D view, pixel by pixel.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr int font_size = 128, character_size = 8, characters_per_row = 16;
constexpr uint8_t transparent = 255;

// Character `code` is palette entry `code` on its diagonal and corners, transparent elsewhere.
bool is_drawn(int x, int y) { return x == y || (x == 7 && y == 0); }

std::vector<std::byte> make_font()
{
    formats::IndexedImage image { font_size, font_size, {}, test_palette() };
    for (int y = 0; y < font_size; y++)
        for (int x = 0; x < font_size; x++) {
            const int code = y / character_size * characters_per_row + x / character_size;
            image.pixels.push_back(is_drawn(x % character_size, y % character_size) ? uint8_t(code) : transparent);
        }
    return formats::write_pcx(image);
}

// Every texel another colour; with `holes`, those of a diagonal are transparent.
constexpr int picture_width = 8, picture_height = 6;
uint8_t texel_index(int x, int y) { return uint8_t(y * 24 + x * 3 + 20); }

std::vector<std::byte> make_picture(bool holes)
{
    formats::IndexedImage image { picture_width, picture_height, {}, test_palette() };
    for (int y = 0; y < picture_height; y++)
        for (int x = 0; x < picture_width; x++)
            image.pixels.push_back(holes && x == y ? transparent : texel_index(x, y));
    return formats::write_pcx(image);
}

// A diagonal edge between two colours.
constexpr int stairs_size = 6;
constexpr uint8_t stairs_below = 40, stairs_above = 200;
constexpr formats::Rgba8 replacement { 11, 222, 33, 255 }; // in all of a PNG of this size
std::vector<std::byte> make_stairs()
{
    formats::IndexedImage image { stairs_size, stairs_size, {}, test_palette() };
    for (int y = 0; y < stairs_size; y++)
        for (int x = 0; x < stairs_size; x++)
            image.pixels.push_back(x <= y ? stairs_below : stairs_above);
    return formats::write_pcx(image);
}

constexpr int tile_texels = 64; // and pixels: how often tiles are repeated
uint8_t tile_index(int x, int y) { return uint8_t((x * 2 + y * 3) & 127); }

std::vector<std::byte> make_tile()
{
    formats::IndexedImage image { tile_texels, tile_texels, {}, test_palette() };
    for (int y = 0; y < tile_texels; y++)
        for (int x = 0; x < tile_texels; x++)
            image.pixels.push_back(tile_index(x, y));
    return formats::write_pcx(image);
}

class Layer2d : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        folder_->add_wall("wall", 180);
        folder_->add("pics/conchars.pcx", make_font());
        folder_->add("pics/thing.pcx", make_picture(false));
        folder_->add("pics/grate.pcx", make_picture(true));
        folder_->add("pics/backtile.pcx", make_tile());
        folder_->add("pics/stairs.pcx", make_stairs());
        folder_->add("pics/round.pcx", make_stairs());
        for (const char* const name : { "replaced", "original" }) {
            folder_->add(fmt::format("pics/{}.pcx", name), make_stairs());
            folder_->add(fmt::format("pics/{}.png", name),
                formats::write_png({ stairs_size, stairs_size,
                    std::vector<formats::Rgba8>(size_t(stairs_size) * stairs_size, replacement) }));
        }
        MapBuilder map;
        map.add_room({ -128, -128, 0 }, { 128, 128, 128 }, map.add_material("wall", 0, 300));
        folder_->add_map("room", map.finish());
        session_ = std::make_unique<Session>(*folder_);
        session_->load_map("room");
        session_->look({ -60, 0, 60 }, { 0, 0, 0 });
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }
    void SetUp() override
    {
        for (const auto& [name, value] :
            CvarList { { "r_2D_unfiltered", "1" }, { "r_videos_unfiltered", "1" }, { "r_lerp_list", "" },
                { "r_nolerp_list", "pics/conchars.pcx" }, { "vid_gamma", "1" }, { "gl3_intensity_2D", "1" } })
            session_->set(name, value);
    }

    // The frame with `draw` over it.
    static formats::Image show(const std::function<void(const engine::Exports8&)>& draw)
    {
        const engine::Exports8& module = session_->module();
        module.begin_frame(0);
        module.render_frame(&session_->view);
        draw(module);
        module.end_frame();
        return session_->capture_display();
    }

    static bool is_near(formats::Rgba8 a, formats::Rgba8 b, int steps)
    {
        return std::abs(a.r - b.r) <= steps && std::abs(a.g - b.g) <= steps && std::abs(a.b - b.b) <= steps;
    }
    // `colour` says what must be at a pixel, give or take so many steps of 8 bits; nothing: what is there without 2D.
    static void expect(const formats::Image& shown,
        const std::function<std::optional<formats::Rgba8>(int, int)>& colour, int steps = 0)
    {
        const formats::Image plain = show([](const auto&) {});
        int wrong = 0;
        for (int y = 0; y < shown.height; y++)
            for (int x = 0; x < shown.width; x++)
                if (const formats::Rgba8 wanted = colour(x, y).value_or(plain.at(x, y));
                    !is_near(shown.at(x, y), wanted, steps) && wrong++ < 5) {
                    const formats::Rgba8 seen = shown.at(x, y);
                    ADD_FAILURE() << "pixel " << x << ", " << y << ": " << int(seen.r) << " " << int(seen.g) << " "
                                  << int(seen.b) << " " << int(seen.a) << " instead of " << int(wanted.r) << " "
                                  << int(wanted.g) << " " << int(wanted.b) << " " << int(wanted.a);
                }
        EXPECT_EQ(wrong, 0);
    }

    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
};

bool is_inside(int x, int y, int left, int top, int width, int height)
{
    return x >= left && x < left + width && y >= top && y < top + height;
}

TEST_F(Layer2d, FillsAreExact)
{
    const formats::Image shown = show([](const engine::Exports8& module) {
        module.draw_fill(3, 5, 10, 7, red_index);
        module.draw_fill(8, 8, 20, 2, blue_index); // over the first
        module.draw_fill(60, 40, 100, 100, green_index); // cut at the picture's edge
        module.draw_fill(-4, -4, 5, 5, 77);
        module.draw_fill(30, 30, 0, 5, 1);
    });
    expect(shown, [](int x, int y) -> std::optional<formats::Rgba8> {
        if (is_inside(x, y, 8, 8, 20, 2))
            return test_palette()[blue_index];
        if (is_inside(x, y, 3, 5, 10, 7))
            return test_palette()[red_index];
        if (is_inside(x, y, 60, 40, 100, 100))
            return test_palette()[green_index];
        if (x == 0 && y == 0)
            return test_palette()[77];
        return std::nullopt;
    });
}

TEST_F(Layer2d, CharactersAreExactAtEveryWholeScale)
{
    for (const int scale : { 1, 2, 3 }) {
        SCOPED_TRACE(scale);
        constexpr int left = 10, top = 9, code = 65, next = 200;
        const formats::Image shown = show([&](const engine::Exports8& module) {
            module.draw_char_scaled(left, top, code, float(scale));
            module.draw_char_scaled(left + character_size * scale, top, next, float(scale));
            module.draw_char_scaled(40, 40, ' ', float(scale));
        });
        expect(shown, [&](int x, int y) -> std::optional<formats::Rgba8> {
            const int size = character_size * scale;
            for (const auto& [start, character] : { std::pair { left, code }, std::pair { left + size, next } })
                if (is_inside(x, y, start, top, size, size) && is_drawn((x - start) / scale, (y - top) / scale))
                    return test_palette()[size_t(character)];
            return std::nullopt;
        });
    }
}

TEST_F(Layer2d, PicturesAreExactAtEveryScale)
{
    for (const float scale : { 1.0f, 2.0f, 3.5f }) {
        SCOPED_TRACE(scale);
        constexpr int left = 7, top = 5, clear_left = 38;
        const formats::Image shown = show([&](const engine::Exports8& module) {
            module.draw_pic_scaled(left, top, "thing", scale);
            module.draw_pic_scaled(clear_left, top, "grate", scale);
        });
        const auto texel = [&](int pixel, int start) { return int(std::floor((float(pixel - start) + 0.5f) / scale)); };
        expect(shown, [&](int x, int y) -> std::optional<formats::Rgba8> {
            for (const int start : { left, clear_left }) {
                const int column = texel(x, start), row = texel(y, top);
                if (is_inside(column, row, 0, 0, picture_width, picture_height)
                    && !(start == clear_left && column == row))
                    return test_palette()[texel_index(column, row)];
            }
            return std::nullopt;
        });
    }
}

TEST_F(Layer2d, TintsMultiplyEachChannel)
{
    constexpr int left = 12, top = 9;
    const float tint[3] = { 1, 0.5f, 0.25f };
    const formats::Image shown
        = show([&](const engine::Exports8& module) { module.draw_pic_scaled_tinted(left, top, "thing", 2, tint); });
    expect(
        shown,
        [&](int x, int y) -> std::optional<formats::Rgba8> {
            if (!is_inside(x, y, left, top, 2 * picture_width, 2 * picture_height))
                return std::nullopt;
            const formats::Rgba8 own = test_palette()[texel_index((x - left) / 2, (y - top) / 2)];
            return formats::Rgba8 { own.r, uint8_t(own.g * 0.5f), uint8_t(own.b * 0.25f), 255 };
        },
        1);
}

TEST_F(Layer2d, StretchedPicturesFillTheirRectangle)
{
    constexpr int left = 3, top = 4, width = 24, height = 30;
    const formats::Image shown = show([&](const engine::Exports8& module) {
        module.draw_stretch_pic(left, top, width, height, "thing");
        module.draw_stretch_pic(40, 4, 0, 10, "thing");
        module.draw_stretch_pic(40, 4, 10, -3, "thing");
    });
    expect(shown, [&](int x, int y) -> std::optional<formats::Rgba8> {
        if (!is_inside(x, y, left, top, width, height))
            return std::nullopt;
        return test_palette()[texel_index((x - left) * picture_width / width, (y - top) * picture_height / height)];
    });
}

TEST_F(Layer2d, PicturesAreReplacedUnlessThePlayerWantsTheOriginals)
{
    constexpr int left = 6, top = 8;
    for (const bool wanted : { true, false }) {
        session_->set("r_retexturing", wanted ? "1" : "0");
        const formats::Image shown = show([&](const engine::Exports8& module) {
            module.draw_pic_scaled(left, top, wanted ? "replaced" : "original", 1);
        });
        expect(shown, [&](int x, int y) -> std::optional<formats::Rgba8> {
            if (!is_inside(x, y, left, top, stairs_size, stairs_size))
                return std::nullopt;
            return wanted ? replacement : test_palette()[x - left <= y - top ? stairs_below : stairs_above];
        });
    }
    session_->set("r_retexturing", "1");
}

// At twice the size, unfiltered, a picture of 8 bits shows its texels as squares, or by r_scale8bittextures with
// smaller steps along diagonals. Its size on the screen stays.
TEST_F(Layer2d, PicturesOf8BitsAreDoubledOnRequest)
{
    constexpr int left = 6, top = 8, inner = 2; // texels away from the picture's rim
    for (const bool doubled : { false, true }) {
        SCOPED_TRACE(doubled);
        session_->set("r_scale8bittextures", doubled ? "1" : "0");
        const formats::Image shown = show([&](const engine::Exports8& module) {
            module.draw_pic_scaled(left, top, doubled ? "round" : "stairs", 2);
        });
        for (int y = 2 * inner; y < 2 * (stairs_size - inner); y++)
            for (int x = 2 * inner; x < 2 * (stairs_size - inner); x++) {
                // The texel's upper right quarter on the diagonal belongs to those above it, and the lower left one
                // beside the diagonal to those below.
                const int column = x / 2, row = y / 2;
                const bool cut = doubled && column == row && x % 2 == 1 && y % 2 == 0;
                const bool added = doubled && column == row + 1 && x % 2 == 0 && y % 2 == 1;
                const bool below = (column <= row && !cut) || added;
                const formats::Rgba8 wanted = test_palette()[below ? stairs_below : stairs_above];
                EXPECT_TRUE(is_near(shown.at(left + x, top + y), wanted, 0)) << x << ' ' << y;
            }
        EXPECT_TRUE(is_near(shown.at(left, top + 2 * stairs_size - 1), test_palette()[stairs_below], 0));
        EXPECT_TRUE(is_near(shown.at(left + 2 * stairs_size - 1, top), test_palette()[stairs_above], 0));
    }
    session_->set("r_scale8bittextures", "0");
}

// Fixed to the screen's corner, so that tiles drawn piece by piece fit together.
TEST_F(Layer2d, TilesAreRepeatedFromTheScreensCorner)
{
    for (const char* unfiltered : { "1", "0" }) { // at their own size they are the same either way
        session_->set("r_2D_unfiltered", unfiltered);
        const formats::Image shown = show([&](const engine::Exports8& module) {
            module.draw_tile_clear(0, 0, 20, 40, "backtile");
            module.draw_tile_clear(20, 10, 40, 30, "backtile");
        });
        expect(
            shown,
            [&](int x, int y) -> std::optional<formats::Rgba8> {
                if (!is_inside(x, y, 0, 0, 20, 40) && !is_inside(x, y, 20, 10, 40, 30))
                    return std::nullopt;
                return test_palette()[tile_index(x % tile_texels, y % tile_texels)];
            },
            1);
    }
}

// Between the four texels around a pixel's middle; whether they are is the player's choice, by rule and by exception.
TEST_F(Layer2d, FiltersFollowTheirSettings)
{
    constexpr int left = 6, top = 8, scale = 4;
    const auto draw = [](const engine::Exports8& module) { module.draw_pic_scaled(left, top, "thing", scale); };
    const auto expect_filtered = [&](bool filtered) {
        expect(
            show(draw),
            [&](int x, int y) -> std::optional<formats::Rgba8> {
                if (!is_inside(x, y, left, top, scale * picture_width, scale * picture_height))
                    return std::nullopt;
                const float u = (float(x - left) + 0.5f) / scale, v = (float(y - top) + 0.5f) / scale;
                if (!filtered)
                    return test_palette()[texel_index(int(u), int(v))];
                // The texels' values are linear in their place, so that the mixture is, too; the outermost are held.
                const float column = std::clamp(u - 0.5f, 0.0f, picture_width - 1.0f),
                            row = std::clamp(v - 0.5f, 0.0f, picture_height - 1.0f);
                const auto value = uint8_t(std::lround(20 + 24 * row + 3 * column));
                return formats::Rgba8 { value, value, value, 255 };
            },
            filtered ? 2 : 0);
    };
    struct Case {
        const char *unfiltered, *never, *always;
        bool filtered;
    };
    for (const Case& c : { Case { "0", "", "", true }, { "1", "", "", false }, { "0", "pics/thing.pcx", "", false },
             { "0", "pics/a.pcx pics/thing.pcx", "pics/thing.pcx", false }, { "1", "", "pics/thing.pcx", true },
             { "1", "pics/thing.pcx", "pics/thing.pcx", true }, { "0", "pics/grate.pcx", "", true },
             { "1", "", "pics/grate.pcx", false } }) {
        SCOPED_TRACE(std::string(c.unfiltered) + ", never " + c.never + ", always " + c.always);
        session_->set("r_2D_unfiltered", c.unfiltered);
        session_->set("r_nolerp_list", c.never);
        session_->set("r_lerp_list", c.always);
        expect_filtered(c.filtered);
    }
}

// As Yamagi's OpenGL 3 renderer shows it: (intensity * colour)^(1 / gamma), of what is drawn and not of what is below.
TEST_F(Layer2d, BrightnessFollowsTheMenusSlider)
{
    struct Setting {
        float gamma, intensity;
    };
    constexpr int columns = 2, rows = 2;
    const uint8_t film[columns * rows] = { 10, 60, 110, 200 }; // greys
    for (const auto& [gamma, intensity] : { Setting { 1.2f, 1.5f }, Setting { 2, 1 }, Setting { 0.7f, 1.2f } }) {
        SCOPED_TRACE("gamma " + std::to_string(gamma) + ", intensity " + std::to_string(intensity));
        session_->set("vid_gamma", double(gamma));
        session_->set("gl3_intensity_2D", double(intensity));
        const auto shown_value = [&](uint8_t own) {
            return uint8_t(std::lround(255 * std::min(1.0f, std::pow(intensity * float(own) / 255, 1 / gamma))));
        };
        const formats::Image shown = show([&](const engine::Exports8& module) {
            module.draw_fill(3, 5, 10, 7, 77);
            module.draw_pic_scaled(20, 5, "thing", 1);
            module.draw_char_scaled(40, 5, 65, 1);
            module.draw_stretch_raw(3, 20, 20, 20, columns, rows, film, 8);
        });
        expect(
            shown,
            [&](int x, int y) -> std::optional<formats::Rgba8> {
                const auto grey = [&](uint8_t own) {
                    const uint8_t value = shown_value(own);
                    return formats::Rgba8 { value, value, value, 255 };
                };
                if (is_inside(x, y, 3, 5, 10, 7))
                    return grey(77);
                if (is_inside(x, y, 20, 5, picture_width, picture_height))
                    return grey(texel_index(x - 20, y - 5));
                if (is_inside(x, y, 40, 5, character_size, character_size) && is_drawn(x - 40, y - 5))
                    return grey(65);
                if (is_inside(x, y, 3, 20, 20, 20))
                    return grey(film[(y - 20) / 10 * columns + (x - 3) / 10]);
                return std::nullopt;
            },
            1);
    }
}

TEST_F(Layer2d, FadeDarkensEverything)
{
    const formats::Image plain = show([](const auto&) {});
    const formats::Image faded = show([](const engine::Exports8& module) { module.draw_fade_screen(); });
    for (size_t i = 0; i < plain.pixels.size(); i++)
        EXPECT_NEAR(faded.pixels[i].g, 0.4 * plain.pixels[i].g, 1) << "pixel " << i;
}

TEST_F(Layer2d, VideosShowTheirOwnPalette)
{
    constexpr int columns = 4, rows = 3;
    std::vector<uint8_t> pixels, palette(768);
    for (int i = 0; i < columns * rows; i++)
        pixels.push_back(uint8_t(i * 20));
    for (size_t i = 0; i < palette.size(); i++)
        palette[i] = uint8_t(255 - i / 3 + i % 3);
    const formats::Image shown = show([&](const engine::Exports8& module) {
        module.set_palette(palette.data());
        module.draw_stretch_raw(8, 4, columns * 5, rows * 5, columns, rows, pixels.data(), 8);
        module.set_palette(nullptr);
    });
    expect(shown, [&](int x, int y) -> std::optional<formats::Rgba8> {
        if (!is_inside(x, y, 8, 4, columns * 5, rows * 5))
            return std::nullopt;
        const uint8_t* rgb = &palette[3 * size_t(pixels[size_t((y - 4) / 5 * columns + (x - 8) / 5)])];
        return formats::Rgba8 { rgb[0], rgb[1], rgb[2], 255 };
    });
}

} // namespace
} // namespace vkpt::tests

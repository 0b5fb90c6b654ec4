// SPDX-License-Identifier: GPL-2.0-or-later
// The 2D layer over a 3D view, pixel by pixel.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

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

class Layer2d : public testing::Test {
protected:
    Layer2d()
    {
        folder_.add_wall("wall", 180);
        folder_.add("pics/conchars.pcx", make_font());
        MapBuilder map;
        map.add_room({ -128, -128, 0 }, { 128, 128, 128 }, map.add_material("wall", 0, 300));
        folder_.add_map("room", map.finish());
        session_ = std::make_unique<Session>(folder_);
        session_->load_map("room");
        session_->look({ -60, 0, 60 }, { 0, 0, 0 });
    }

    // The frame with `draw` over it.
    formats::Image show(const std::function<void(const engine::Exports8&)>& draw)
    {
        const engine::Exports8& module = session_->module();
        module.begin_frame(0);
        module.render_frame(&session_->view);
        draw(module);
        module.end_frame();
        return session_->capture_display();
    }

    // `colour` says what must be at a pixel; nothing: what is there without 2D.
    void expect(const formats::Image& shown, const std::function<std::optional<formats::Rgba8>(int, int)>& colour)
    {
        const formats::Image plain = show([](const auto&) {});
        int wrong = 0;
        for (int y = 0; y < shown.height; y++)
            for (int x = 0; x < shown.width; x++)
                if (const formats::Rgba8 wanted = colour(x, y).value_or(plain.at(x, y));
                    shown.at(x, y) != wanted && wrong++ < 5) {
                    const formats::Rgba8 seen = shown.at(x, y);
                    ADD_FAILURE() << "pixel " << x << ", " << y << ": " << int(seen.r) << " " << int(seen.g) << " "
                                  << int(seen.b) << " " << int(seen.a) << " instead of " << int(wanted.r) << " "
                                  << int(wanted.g) << " " << int(wanted.b) << " " << int(wanted.a);
                }
        EXPECT_EQ(wrong, 0);
    }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
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
    session_->set("r_videos_unfiltered", 1);
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

// SPDX-License-Identifier: GPL-2.0-or-later
// How pictures on walls and floors are read: over the whole of what a pixel shows of them, and as the player wants
// large texels.
#include "common/colour.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace vkpt::tests {
namespace {

constexpr float square = 8; // units, and texels
constexpr uint8_t dark = 40, bright = 220;
constexpr float eye_height = 16;

// A floor of dark and bright squares.
class PictureFilter : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        folder_->add_wall("checkers", dark);
        formats::Image picture { 16, 16, std::vector<formats::Rgba8>(16 * 16) };
        for (int y = 0; y < 16; y++)
            for (int x = 0; x < 16; x++) {
                const uint8_t grey = (x / int(square) + y / int(square)) % 2 ? bright : dark;
                picture.pixels[size_t(y) * 16 + size_t(x)] = { grey, grey, grey, 255 };
            }
        folder_->add("textures/checkers.tga", formats::write_tga(picture));
        MapBuilder map;
        map.add(rectangle({ 0, 0, 0 }, { 2048, 0, 0 }, { 0, 2048, 0 }), map.add_material("checkers"));
        map.add_point_light({ 0, 0, 500 }, 300);
        folder_->add_map("floor", map.finish());
        session_ = std::make_unique<Session>(
            *folder_, CvarList { { "pt_debug_view", "albedo" }, { "pt_bounces", "0" } }, glm::ivec2(96, 72));
        session_->load_map("floor");
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }

    static double linear(uint8_t value) { return decode_srgb(value / 255.0); }
    // The floor's mean over a pixel.
    static double covered(int x, int y)
    {
        constexpr int rays = 16;
        double sum = 0;
        for (int i = 0; i < rays * rays; i++) {
            const glm::vec2 place { (float(i % rays) + 0.5f) / rays, (float(i / rays) + 0.5f) / rays };
            const CameraRay ray = camera_ray(session_->view, glm::vec2(x, y) + place);
            const glm::vec3 met = ray.origin - ray.direction * (ray.origin.z / ray.direction.z);
            const bool odd = int(std::floor(met.x / square) + std::floor(met.y / square)) % 2;
            // The picture hangs from the origin, its rows downwards.
            sum += linear(odd ? dark : bright);
        }
        return sum / (rays * rays);
    }
    // Mean square error of the shown albedo in the rows where a pixel is two to ten times as long as it is wide.
    static double error()
    {
        session_->draw();
        const formats::Image shown = session_->capture_display();
        double sum = 0;
        int count = 0;
        for (int y = 41; y < 58; y++)
            for (int x = 8; x < 88; x++, count++)
                sum += std::pow(linear(shown.at(x, y).r) - covered(x, y), 2);
        return sum / count;
    }

    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
};

TEST_F(PictureFilter, FloorsAreSharpAcrossTheView)
{
    session_->look({ 3, 5, eye_height }, { 103, 12, eye_height });
    session_->set("r_anisotropic", 0);
    const double blurred = error();
    session_->set("r_anisotropic", 2);
    const double better = error();
    session_->set("r_anisotropic", 4);
    const double sharp = error();
    RecordProperty("error of one, two and four taps",
        std::to_string(blurred) + " " + std::to_string(better) + " " + std::to_string(sharp));
    EXPECT_LT(better, 0.8 * blurred);
    EXPECT_LT(sharp, 0.5 * blurred);
}

TEST_F(PictureFilter, LargeTexelsAreSquaresWhereAsked)
{
    session_->look({ 2, 3, 4 }, { 10, 6, 0 });
    const auto shades = [&](const char* mode) {
        session_->set("gl_texturemode", mode);
        session_->draw();
        const formats::Image shown = session_->capture_display();
        std::set<int> seen;
        for (int y = 48; y < 72; y++)
            for (int x = 0; x < 96; x++)
                seen.insert(shown.at(x, y).r / 8); // dithered
        return seen.size();
    };
    for (const char* mode : { "GL_NEAREST", "GL_NEAREST_MIPMAP_NEAREST", "GL_NEAREST_MIPMAP_LINEAR" })
        EXPECT_EQ(shades(mode), 2u) << mode;
    for (const char* mode : { "GL_LINEAR", "GL_LINEAR_MIPMAP_NEAREST", "GL_LINEAR_MIPMAP_LINEAR", "nonsense" })
        EXPECT_GT(shades(mode), 8u) << mode;
}

} // namespace
} // namespace vkpt::tests

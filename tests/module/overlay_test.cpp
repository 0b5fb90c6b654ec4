// SPDX-License-Identifier: GPL-2.0-or-later
// What is drawn over the picture: where it is, that it goes again, and that pt_preset sets what it says.
#include "ref_vkpt/presets.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <regex>

namespace vkpt::tests {
namespace {

class OverlayOfModule : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        folder_->add_wall("wall", 180);
        folder_->add_wall("lamp", white_index);
        formats::IndexedImage font { 128, 128, std::vector<uint8_t>(128 * 128, white_index), test_palette() };
        folder_->add("pics/conchars.pcx", formats::write_pcx(font));
        MapBuilder map;
        map.add_lit_room("wall");
        folder_->add_map("room", map.finish());
        session_ = std::make_unique<Session>(*folder_, CvarList(), glm::ivec2(800, 200));
        session_->load_map("room");
        session_->look({ -100, 0, 50 }, { 100, 0, 50 });
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }
    void SetUp() override
    {
        session_->set("pt_show_times", 0);
        session_->set("pt_exposure", 0.2); // nothing but the font is white
    }

    // Pixels of the font's white in the left and the right half.
    struct Halves {
        int left = 0, right = 0;
    };
    static Halves count_text()
    {
        session_->draw(2);
        const formats::Image image = session_->capture_display();
        Halves halves;
        for (int y = 0; y < image.height; y++)
            for (int x = 0; x < image.width; x++)
                (x < image.width / 2 ? halves.left : halves.right) += image.at(x, y).g == 255;
        return halves;
    }
    // What the cvar shows stands on the left alone.
    static void show_on_the_left(const char* cvar)
    {
        const Halves before = count_text();
        session_->set(cvar, 1);
        const Halves with_panel = count_text();
        EXPECT_GT(with_panel.left, before.left + 100) << cvar;
        EXPECT_EQ(with_panel.right, before.right) << cvar;
    }
    static std::string value(const std::string& cvar) { return session_->host().cvars().find(cvar)->text; }

    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
};

TEST_F(OverlayOfModule, LightsUnderTheCrosshairStandOnTheLeftAndGo)
{
    const int before = count_text().left;
    show_on_the_left("pt_show_lights");
    session_->set("pt_show_lights", 0);
    EXPECT_EQ(count_text().left, before);
}

TEST_F(OverlayOfModule, MaterialUnderTheCrosshairStandsOnTheLeftAndGoes)
{
    const int before = count_text().left;
    show_on_the_left("pt_show_material");
    show_on_the_left("pt_show_lights"); // both
    session_->set("pt_show_lights", 0);
    session_->set("pt_show_material", 0);
    EXPECT_EQ(count_text().left, before);
}

TEST_F(OverlayOfModule, TimesStandOnTheRightAndGo)
{
    const Halves before = count_text();
    session_->set("pt_show_times", 1);
    const Halves line = count_text();
    EXPECT_GT(line.right, before.right + 3000);
    EXPECT_EQ(line.left, before.left);
    session_->set("pt_show_times", 2);
    EXPECT_GT(count_text().right, line.right + 5000);
    session_->set("pt_show_times", 0);
    EXPECT_EQ(count_text().right, before.right);
}

TEST_F(OverlayOfModule, MenuStandsOnTheLeftAndGoes)
{
    const Halves before = count_text();
    session_->host().run_text("pt_menu\n");
    const Halves open = count_text();
    EXPECT_GT(open.left, before.left + 5000);
    EXPECT_EQ(open.right, before.right);
    session_->host().run_text("pt_menu\n");
    EXPECT_EQ(count_text().left, before.left);
}

TEST_F(OverlayOfModule, PresetsSetTheirCvars)
{
    session_->host().run_text("pt_preset low\n");
    EXPECT_EQ(value("pt_render_scale"), "50");
    EXPECT_EQ(value("pt_bounces"), "0");
    session_->host().run_text("pt_preset\n");
    EXPECT_TRUE(session_->has_line("pt_preset is \"low\""));
    session_->host().run_text("pt_preset best\n");
    EXPECT_TRUE(
        session_->has_line("pt_preset \"best\" is unknown; there are: auto, low, medium, high, ultra, reference"));
    EXPECT_EQ(value("pt_render_scale"), "50");
    session_->host().run_text("pt_preset auto never\n");
    EXPECT_TRUE(session_->has_line("not \"never\""));
    session_->host().run_text("pt_preset high\n");
}

// Milliseconds of a frame with each measured preset, and the preset that is set then, as the console says.
struct Decision {
    std::array<double, PresetMeasurement::measured.size()> times {};
    std::string preset;
};

// What follows from such times.
std::string decide(const Decision& measured, double wanted)
{
    PresetMeasurement again(wanted);
    for (double now = 0; !again.is_over(); now += 0.1) {
        const auto* place = std::ranges::find(PresetMeasurement::measured, std::string_view(again.current()));
        again.add_frame(now, measured.times[size_t(place - PresetMeasurement::measured.begin())]);
    }
    return again.answer().preset;
}

TEST_F(OverlayOfModule, AutoMeasuresAndDecides)
{
    const auto measure = [](double wanted) {
        const std::regex pattern("frame here: ultra ([0-9.]+), high ([0-9.]+), medium ([0-9.]+); wanted [0-9.]+: "
                                 "pt_preset ([a-z]+),");
        size_t line = session_->lines().size();
        session_->host().run_text(fmt::format("pt_preset auto {}\n", 1000 / wanted));
        Decision said;
        for (int frame = 0; frame < 100000 && said.preset.empty(); frame++) {
            session_->draw();
            std::smatch match;
            for (; line < session_->lines().size(); line++)
                if (std::regex_search(session_->lines()[line], match, pattern))
                    said = { { std::stod(match[1]), std::stod(match[2]), std::stod(match[3]) }, match[4] };
        }
        EXPECT_EQ(said.preset, decide(said, wanted)) << "wanted: " << wanted << ", ultra takes " << said.times[0]
                                                     << ", high " << said.times[1] << ", medium " << said.times[2];
        EXPECT_EQ(value("pt_target_ms"), fmt::format("{:.2f}", wanted));
        session_->host().run_text("pt_preset\n");
        EXPECT_NE(session_->lines().back().find("pt_preset is \"" + said.preset + "\""), std::string::npos);
        return said;
    };
    const Decision slow = measure(1000);
    EXPECT_GT(slow.times[0], slow.times[2]);
    measure((slow.times[0] + slow.times[1]) / 2);
    session_->host().run_text("pt_preset high\n");
}

} // namespace
} // namespace vkpt::tests

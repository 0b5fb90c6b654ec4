// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt report: work apart, and pictures compared with what is stored. VKPT_UPDATE_STATISTICS=1 stores anew what the
// pictures look like now, in client/report/expected_pictures.txt.
#include "client/report/apart.hpp"
#include "client/report/measurements.hpp"
#include "client/report/page.hpp"
#include "tests/client/run_program.hpp"

#include <csignal>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <stdexcept>
#include <unistd.h>

namespace vkpt::client {
namespace {

TEST(Apart, ReturnsWhatWasFound)
{
    const Json found = run_apart([] { return Json { { "a", std::string(300'000, 'x') } }; });
    EXPECT_EQ(found["a"].get<std::string>().size(), 300'000u);
}

TEST(Apart, ErrorsCrashesAndHangsEndThatWorkOnly)
{
    EXPECT_EQ(run_apart([]() -> Json { throw std::runtime_error("no memory"); })["error"], "no memory");
    const Json crash = run_apart([]() -> Json {
        std::signal(SIGSEGV, SIG_DFL);
        std::raise(SIGSEGV);
        return {};
    });
    EXPECT_EQ(crash["error"], "it crashed: Segmentation fault");
    EXPECT_EQ(run_apart([]() -> Json { _exit(3); })["error"], "it ended without a result");
    const Json hang = run_apart(
        []() -> Json {
            for (;;)
                pause();
        },
        std::chrono::seconds(1));
    EXPECT_EQ(hang["error"], "it had not ended after 1 seconds");
}

formats::Image make_picture(uint8_t left, uint8_t right)
{
    formats::Image image { 64, 36, std::vector<formats::Rgba8>(64 * 36) };
    for (int i = 0; i < 64 * 36; i++)
        image.pixels[size_t(i)]
            = i % 64 < 32 ? formats::Rgba8 { left, left, left, 255 } : formats::Rgba8 { right, right, right, 255 };
    return image;
}

TEST(PictureCheck, MeasuresBrightnessInAGrid)
{
    const std::vector<float> grid = measure_grid(make_picture(10, 200));
    ASSERT_EQ(grid.size(), size_t(grid_columns * grid_rows));
    EXPECT_NEAR(grid[7], 10, 0.01);
    EXPECT_NEAR(grid[8], 200, 0.01);
    EXPECT_NEAR(grid.back(), 200, 0.01);
    const GridDifference difference = compare_grids(grid, measure_grid(make_picture(10, 210)));
    EXPECT_NEAR(difference.mean, 5, 0.01);
    EXPECT_NEAR(difference.max, 10, 0.01);
    EXPECT_FALSE(difference.is_small());
    EXPECT_TRUE(compare_grids(grid, measure_grid(make_picture(11, 199))).is_small());
}

class ReportOfModule : public testing::Test {
protected:
    ReportOptions make_options(std::vector<std::string> settings = {}) const
    {
        ReportOptions options;
        options.module.module = VKPT_TESTED_MODULE;
        options.module.settings = std::move(settings);
        options.base_folder = VKPT_GAME_DATA;
        options.scene = "maps/vkpt1.bsp";
        options.seconds = 0;
        return options;
    }
};

TEST_F(ReportOfModule, PicturesAreAsStored)
{
    const bool updates = std::getenv("VKPT_UPDATE_STATISTICS") != nullptr;
    std::string text = "# name, then mean luminance (sRGB-encoded, 0..255) in 16 x 9 parts\n"
                       "# Made anew by: VKPT_UPDATE_STATISTICS=1 ./test -- -R client_report_test\n";
    for (const CheckedView& view : list_checked_views()) {
        const std::vector<float> grid = measure_grid(draw_checked_view(make_options(), view, "software"));
        text += view.name;
        for (const float value : grid)
            text += fmt::format(" {:.1f}", value);
        text += '\n';
        if (updates)
            continue;
        ASSERT_EQ(view.expected.size(), grid.size()) << view.name;
        const GridDifference difference = compare_grids(view.expected, grid);
        std::printf("%s: %.2f, at most %.2f\n", view.name.data(), difference.mean, difference.max);
        EXPECT_TRUE(difference.is_small()) << view.name << ": " << difference.mean << ", at most " << difference.max;
    }
    if (updates)
        std::ofstream(VKPT_EXPECTED_PICTURES) << text;
}

TEST_F(ReportOfModule, AWrongPictureIsTold)
{
    const CheckedView start = list_checked_views().front();
    for (const char* setting : { "pt_emission_scale=0.7", "pt_bounces=0", "vid_gamma=1.4" }) {
        const formats::Image image = draw_checked_view(make_options({ setting }), start, "software");
        EXPECT_FALSE(compare_grids(start.expected, measure_grid(image)).is_small()) << setting;
    }
}

TEST_F(ReportOfModule, TimesAreThere)
{
    const Json device = run_apart([&] { return describe_device(make_options()); });
    ASSERT_FALSE(device.contains("error")) << device.dump();
    EXPECT_GT(device["ns_per_ray"].value("software", 0.0), 0) << device.dump();
    const Json time = run_apart([&] { return time_preset(make_options(), "low", "160x90"); });
    ASSERT_FALSE(time.contains("error")) << time.dump();
    EXPECT_GT(time["frame_ms"].get<double>(), 0);
    EXPECT_GT(time["passes"]["direct_light"].get<double>(), 0) << time.dump();
    const Json high = run_apart([&] { return time_preset(make_options(), "high", "160x90"); });
    EXPECT_GT(high["passes"]["indirect_light"].get<double>(), time["passes"]["indirect_light"].get<double>())
        << "the preset is in use";
    const Json validation = run_apart([&] { return validate_frames(make_options(), "software"); });
    EXPECT_EQ(validation["messages"], 0) << validation.dump();
}

Json make_report()
{
    return { { "scene", "demo.rtrace" },
        { "device",
            { { "device", "A <GPU>" }, { "driver", "d" }, { "vulkan", "1.3" }, { "trace_backend", "query" },
                { "ns_per_ray", { { "query", 1.5 } } }, { "console", { "a & b" } } } },
        { "times",
            { { { "preset", "low" }, { "size", "1x1" }, { "frame_ms", 2.0 }, { "first_frame_seconds", 1 },
                { "gpu_mib", 5 }, { "passes", { { "denoise", 0.5 }, { "direct_light", 1.5 } } } } } },
        { "validation", { { { "backend", "query" }, { "messages", 0 }, { "texts", Json::array() } } } },
        { "pictures",
            { { { "backend", "query" },
                { "pictures",
                    { { { "name", "start" }, { "mean_difference", 0.5 }, { "max_difference", 1 }, { "is_right", true },
                        { "png", "AAAA" } } } } } } } };
}

TEST(ReportPage, TellsWhatIsWrong)
{
    Json report = make_report();
    EXPECT_TRUE(list_problems(report).empty());
    std::string page = make_report_page(report);
    EXPECT_NE(page.find("A &lt;GPU&gt;"), std::string::npos);
    EXPECT_NE(page.find("a &amp; b"), std::string::npos);
    EXPECT_NE(page.find("direct_light 1.50, denoise 0.50"), std::string::npos) << page;
    EXPECT_NE(page.find("Nothing is wrong"), std::string::npos);
    EXPECT_NE(make_report_text(report).find("Nothing is wrong"), std::string::npos);

    report["times"][0] = { { "preset", "ultra" }, { "size", "9x9" }, { "error", "it crashed: Killed" } };
    report["validation"][0]["messages"] = 3;
    report["validation"].push_back({ { "backend", "pipeline" },
        { "error", "install vulkan-validationlayers: pt_validation 1 needs the Vulkan validation layers" } });
    report["pictures"][0]["pictures"][0]["is_right"] = false;
    report["pictures"].push_back({ { "backend", "pipeline" }, { "error", "device lost" } });
    const std::vector<std::string> problems = list_problems(report);
    EXPECT_EQ(problems.size(), 4u) << Json(problems).dump(1);
    page = make_report_page(report);
    for (const std::string& problem : problems)
        EXPECT_NE(page.find(problem), std::string::npos) << problem;
    EXPECT_NE(page.find("device lost"), std::string::npos);
}

// From the outside, with a module that draws a gradient: everything is told, and the files are whole.
TEST(ReportCommand, WritesPageAndJson)
{
    const tests::ScratchFolder folder;
    tests::write_sample_map(folder, "sample", "{\n\"classname\" \"worldspawn\"\n}\n");
    const tests::ProgramResult result = tests::run_program(VKPT_PROGRAM,
        { "report", "maps/sample.bsp", "--basedir", folder.path(), "--module", FAKE_MODULE, "--size", "64x36",
            "--seconds", "0", "-o", "out" },
        folder.path());
    EXPECT_EQ(result.status, 0) << result.errors;
    const Json report = Json::parse(folder.read("out/report.json"));
    EXPECT_EQ(report["schema"], 1);
    EXPECT_EQ(report["times"].size(), 4u);
    EXPECT_FALSE(report["problems"].empty()) << "maps/vkpt1.bsp is not there";
    EXPECT_EQ(folder.read("out/report.json").find("\"png\""), std::string::npos);
    EXPECT_NE(folder.read("out/report.html").find("</html>"), std::string::npos);
    EXPECT_NE(result.output.find("nothing was sent anywhere"), std::string::npos) << result.output;
}

} // namespace
} // namespace vkpt::client

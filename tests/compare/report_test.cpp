// SPDX-License-Identifier: GPL-2.0-or-later
// figures.json and figures.csv: what other programs read.
#include "tests/compare/sample_report.hpp"

#include "client/compare/plot.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace vkpt::tests {
namespace {

using namespace vkpt::client;

const std::vector<std::string> wanted_columns { "scene", "frame", "sampler", "subset", "noise", "denoiser", "spp",
    "rmse", "rel_mse", "flip", "bias", "bias_ci95", "spectrum_low_high", "flicker", "ms" };

TEST(ReportJson, HasOneRowAVariantWithTheColumns)
{
    const auto json = nlohmann::ordered_json::parse(make_json(make_sample_report()));
    EXPECT_EQ(json.at("schema"), report_schema);
    ASSERT_EQ(json.at("rows").size(), 8u);
    ASSERT_EQ(json.at("details").size(), 8u);
    for (const auto& row : json.at("rows")) {
        std::vector<std::string> names;
        for (const auto& item : row.items())
            names.push_back(item.key());
        EXPECT_EQ(names, wanted_columns);
    }
    const auto& row = json.at("rows").at(0);
    EXPECT_EQ(row.at("sampler"), "subset");
    EXPECT_EQ(row.at("subset"), 8);
    EXPECT_EQ(row.at("rmse"), 1.5);
    EXPECT_EQ(row.at("spectrum_low_high"), 0.5);
    EXPECT_EQ(json.at("rows").at(7).at("frame"), 12);
    EXPECT_TRUE(json.at("rows").at(2).at("subset").is_null()) << "uniform has no subset";
    EXPECT_TRUE(json.at("rows").at(2).at("bias_ci95").is_null()) << "infinity is no JSON";
    EXPECT_TRUE(json.at("rows").at(3).at("ms").is_null()) << "nothing was measured";
    EXPECT_EQ(json.at("scenes").at(0).at("reference").at("rmse"), 0.03);
}

TEST(ReportCsv, IsWhatTheJsonSays)
{
    const std::string csv = make_csv(make_sample_report());
    std::vector<std::string> lines;
    for (size_t at = 0; at < csv.size();) {
        const size_t end = csv.find("\r\n", at);
        ASSERT_NE(end, std::string::npos);
        lines.push_back(csv.substr(at, end - at));
        at = end + 2;
    }
    ASSERT_EQ(lines.size(), 9u);
    std::string header;
    for (const std::string& name : wanted_columns)
        header += (header.empty() ? "" : ",") + name;
    EXPECT_EQ(lines[0], header);
    EXPECT_EQ(lines[1], "\"maps/a.bsp@1,2,3,0,90\",0,subset,8,blue,off,1,1.5,3,0.375,0.01,0.002,0.5,0.125,15");
    EXPECT_EQ(lines[3], "\"maps/a.bsp@1,2,3,0,90\",0,uniform,,blue,off,1,4,8,1,0.01,,0.5,0.125,40");
    EXPECT_TRUE(lines[5].starts_with("\"b \"\"</script><b>\"\".rtrace\",12,")) << lines[5];
}

TEST(Plot, PutsPointsWhereTheyBelong)
{
    Plot plot { "a <title>", "x", "y", { { "line & more", { { 0, 0 }, { 10, 100 } } } } };
    const std::string svg = draw_plot(plot);
    EXPECT_NE(svg.find("a &lt;title&gt;"), std::string::npos);
    EXPECT_NE(svg.find("line &amp; more"), std::string::npos);
    // Values are widened by a twentieth on both sides: 484 / 1.1 * .05 = 22 from the left, 258 / 1.1 * .05 = 11.7 from
    // below.
    EXPECT_NE(svg.find("M86.0 280.3L526.0 45.7"), std::string::npos) << svg;
    EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Plot, LeavesOutWhatHasNoPlace)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Plot plot { "", "x", "y", { { "a", { { 1, 0 }, { -1, 1 }, { infinity, 1 } } } }, true, true };
    EXPECT_EQ(draw_plot(plot), "");
    plot.lines.push_back({ "b", { { 5, 5 } } });
    const std::string svg = draw_plot(plot);
    EXPECT_NE(svg.find(">b<"), std::string::npos);
    EXPECT_EQ(svg.find(">a<"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
}

} // namespace
} // namespace vkpt::tests

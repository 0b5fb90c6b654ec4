// SPDX-License-Identifier: GPL-2.0-or-later
// The page: whole by itself, and alive in a browser. tests/compare/page_test.js uses it as a reader does, in jsdom,
// where pictures and canvases are recorded; where there is a Chromium, it opens it as well.
#include "tests/client/run_program.hpp"
#include "tests/compare/sample_report.hpp"

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <regex>

namespace vkpt::tests {
namespace {

std::string find_program(const std::vector<std::string>& names)
{
    for (const std::string& name : names)
        for (const char* folder : { "/usr/bin/", "/usr/local/bin/" })
            if (std::filesystem::exists(folder + name))
                return folder + name;
    return "";
}

TEST(Page, NeedsNothingFromOutside)
{
    const std::string page = client::make_page(make_sample_report());
    EXPECT_EQ(page.find("{{"), std::string::npos) << "a part of the template was not filled";
    const std::regex outside(R"((src|href)\s*=\s*["']?\s*(https?:|//))", std::regex::icase);
    EXPECT_FALSE(std::regex_search(page, outside));
    EXPECT_EQ(page.find("@import"), std::string::npos);
    // The second scene's name would end the data's element.
    const size_t data = page.find("<script type=\"application/json\"");
    ASSERT_NE(data, std::string::npos);
    const size_t end = page.find("</script>", data);
    EXPECT_EQ(page.substr(end, 20), "</script>\n<script>//");
}

TEST(Page, WorksForAReader)
{
    const std::string node = find_program({ "node", "nodejs" });
    if (node.empty() || !std::filesystem::exists("/usr/share/nodejs/jsdom"))
        GTEST_SKIP() << "nodejs and node-jsdom are not installed";
    const ScratchFolder folder;
    folder.write("index.html", client::make_page(make_sample_report()));
    const ProgramResult result
        = run_program(node, { PAGE_SCRIPT, "index.html" }, folder.path(), { "NODE_PATH=/usr/share/nodejs" });
    EXPECT_EQ(result.status, 0) << result.output << result.errors;
}

TEST(Page, OpensInARealBrowser)
{
    const std::string browser = find_program({ "chromium-headless-shell", "chromium" });
    if (browser.empty())
        GTEST_SKIP() << "no Chromium is installed";
    const ScratchFolder folder;
    folder.write("index.html", client::make_page(make_sample_report()));
    const ProgramResult result = run_program(browser,
        { "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=3000", "--dump-dom",
            "file://" + (folder.path() / "index.html").string() },
        folder.path(), { "HOME=" + folder.path().string() });
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_NE(result.output.find("data-ready=\"yes\""), std::string::npos) << result.errors;
    // Two windows of three variants and the reference each: the program has made their canvases.
    const std::regex canvas("<canvas width=\"[1-9]");
    const auto first = std::sregex_iterator(result.output.begin(), result.output.end(), canvas);
    EXPECT_EQ(std::distance(first, std::sregex_iterator()), 8);
}

} // namespace
} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// `vkpt` from the outside, with a module that draws a known gradient and tells what it was asked.
#include "formats/image.hpp"
#include "tests/client/run_program.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <algorithm>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

namespace vkpt::tests {
namespace {

constexpr const char* sample_entities = R"({ "classname" "worldspawn" "sky" "desert" "skyrotate" "2" "skyaxis" "0 0 1" }
{ "classname" "info_player_deathmatch" "origin" "9 9 9" }
{ "classname" "info_player_start" "origin" "-8 4 24" "angle" "90" })";

class Cli : public testing::Test {
protected:
    Cli() { write_sample_map(folder, "sample", sample_entities); }

    ProgramResult run(std::vector<std::string> arguments) const
    {
        return run_program(VKPT_PROGRAM, arguments, folder.path(),
            { std::string("VKPT_MODULE=") + FAKE_MODULE, "XDG_CACHE_HOME=" + (folder.path() / "cache").string() });
    }
    ProgramResult render(std::vector<std::string> more) const
    {
        std::vector<std::string> arguments { "render", "maps/sample.bsp", "--size", "4x2", "--spp", "2" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    // Nothing but the game data and the module's cache is there.
    void expect_no_output_left() const
    {
        for (const std::string& name : folder.names())
            EXPECT_TRUE(name == "baseq2" || name == "cache") << name;
    }

    ScratchFolder folder;
};

void expect_in(const std::string& text, const std::string& part)
{
    EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in:\n" << text;
}

TEST_F(Cli, WrongUseExitsWithTwo)
{
    const std::vector<std::vector<std::string>> cases {
        {},
        { "paint" },
        { "render" },
        { "render", "maps/sample.bsp" },
        { "render", "maps/sample.bsp", "-o", "a.gif" },
        { "render", "sample", "-o", "a.png" },
        { "render", "maps/sample.bsp@1,2", "-o", "a.png" },
        { "render", "maps/sample.bsp@1,2,x,0,0", "-o", "a.png" },
        { "render", "maps/sample.bsp", "--size", "big", "-o", "a.png" },
        { "render", "maps/sample.bsp", "--size", "0x5", "-o", "a.png" },
        { "render", "maps/sample.bsp", "--size", "640x480x3", "-o", "a.png" },
        { "render", "maps/sample.bsp", "--spp", "0", "-o", "a.png" },
        { "render", "maps/sample.bsp", "--spp", "4", "--frames", "4", "-o", "a.png" },
        { "render", "maps/sample.bsp", "--seed", "-1", "-o", "a.png" },
        { "render", "maps/sample.bsp", "--set", "pt_bounces", "-o", "a.png" },
        { "render", "maps/sample.bsp", "--set", "pt_bouncess=2", "-o", "a.png" },
        { "info", "--yaml" },
        { "bench" },
        { "bench", "maps/sample.bsp", "--ab", "pt_bounces" },
        { "bench", "maps/sample.bsp", "--ab", "pt_bounces=1" },
        { "bench", "maps/sample.bsp", "--ab", "pt_bounces=1,2,3" },
        { "bench", "maps/sample.bsp", "--ab", "pt_bounces=1,99" },
        { "bench", "maps/sample.bsp", "--ab", "pt_nothing=1,2" },
        { "bench", "maps/sample.bsp", "--frames", "0" },
        { "record" },
        { "record", "x.dm2" },
        { "record", "x.dm2", "-o", "x.trace" },
        { "record", "x.dm2", "--rate", "5", "-o", "x.rtrace" },
        { "compare", "maps/sample.bsp", "--set", "flt_taa=on", "-o", "compared" },
        { "diff" },
        { "export", "maps/sample.bsp" },
    };
    for (const std::vector<std::string>& arguments : cases) {
        std::string line;
        for (const std::string& word : arguments)
            line += word + " ";
        SCOPED_TRACE(line);
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.status, 2) << result.errors;
        EXPECT_FALSE(result.errors.empty());
        expect_no_output_left();
    }
}

TEST_F(Cli, HelpIsNoError)
{
    for (const std::vector<std::string>& arguments :
        std::vector<std::vector<std::string>> { { "--help" }, { "render", "--help" }, { "bench", "--help" },
            { "record", "--help" }, { "info", "--help" }, { "--man-page" }, { "--completion" } }) {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.status, 0);
        EXPECT_GT(result.output.size(), 200u);
    }
}

TEST_F(Cli, MissingMapSaysWhereItLookedAndWhatThereIs)
{
    const ProgramResult result = run({ "render", "maps/nowhere.bsp", "-o", "a.png" });
    EXPECT_EQ(result.status, 1);
    expect_in(result.errors, "maps/nowhere.bsp");
    expect_in(result.errors, "baseq2");
    expect_in(result.errors, "maps/sample.bsp");
    expect_no_output_left();
}

TEST_F(Cli, MissingDataSaysWhereItLooked)
{
    const ProgramResult result = run({ "render", "maps/sample.bsp", "--basedir", "elsewhere", "-o", "a.png" });
    EXPECT_EQ(result.status, 1);
    expect_in(result.errors, "elsewhere/baseq2");
    expect_in(result.errors, "--basedir");
}

TEST_F(Cli, BrokenMapNamesFileAndPlace)
{
    folder.write("baseq2/maps/broken.bsp", folder.read("baseq2/maps/sample.bsp").substr(0, 200));
    const ProgramResult result = run({ "render", "maps/broken.bsp", "-o", "a.png" });
    EXPECT_EQ(result.status, 1);
    expect_in(result.errors, "maps/broken.bsp");
    expect_no_output_left();
}

TEST_F(Cli, MapWithoutAPlayerStartAsksForACamera)
{
    write_sample_map(folder, "empty", R"({ "classname" "worldspawn" })");
    const ProgramResult result = run({ "render", "maps/empty.bsp", "-o", "a.png" });
    EXPECT_EQ(result.status, 1);
    expect_in(result.errors, "maps/empty.bsp@x,y,z,pitch,yaw");
    EXPECT_EQ(run({ "render", "maps/empty.bsp@0,0,9,0,0", "--spp", "1", "-o", "a.png" }).status, 0);
}

TEST_F(Cli, UnwritableOutputIsFoundBeforeTheWork)
{
    for (const char* name : { "nofolder/a.png", "/proc/a.png" }) {
        const ProgramResult result = render({ "--verbose", "-o", name });
        EXPECT_EQ(result.status, 1);
        expect_in(result.errors, name);
        EXPECT_EQ(result.errors.find("call init"), std::string::npos) << "the module was started";
    }
    std::filesystem::create_directory(folder.path() / "folder.png");
    EXPECT_EQ(render({ "-o", "folder.png" }).status, 1);
}

TEST_F(Cli, MissingModuleSaysHowToNameOne)
{
    const ProgramResult result = run({ "info", "--module", "nothing.so" });
    EXPECT_EQ(result.status, 1);
    expect_in(result.errors, "nothing.so");
    folder.write("text.so", "this is no library");
    EXPECT_EQ(run({ "info", "--module", "text.so" }).status, 1);
}

TEST_F(Cli, FailureOfTheModuleIsTold)
{
    const ProgramResult at_start = render({ "--set", "fake_throw=init fatal", "-o", "a.png" });
    EXPECT_EQ(at_start.status, 1);
    expect_in(at_start.errors, "the device is lost");
    const ProgramResult later = render({ "--set", "fake_throw=render_view level", "-o", "a.png" });
    EXPECT_EQ(later.status, 1);
    expect_in(later.errors, "the level is over");
    expect_no_output_left();
}

TEST_F(Cli, CorrectedSettingIsTold)
{
    const ProgramResult result = render({ "--set", "pt_bounces=99", "-o", "a.png" });
    EXPECT_EQ(result.status, 0) << result.errors;
    expect_in(result.errors, "pt_bounces=99");
    expect_in(result.errors, "8");
    // What is set again does not count.
    const ProgramResult again = render({ "--set", "pt_bounces=99", "--set", "pt_bounces=2", "-o", "a.png" });
    EXPECT_EQ(again.status, 0);
    EXPECT_EQ(again.errors.find("pt_bounces"), std::string::npos) << again.errors;
}

TEST_F(Cli, RegistersAsTheClientDoes)
{
    const ProgramResult result = render({ "--verbose", "-o", "a.png" });
    EXPECT_EQ(result.status, 0) << result.errors;
    std::istringstream lines(result.errors);
    std::string calls;
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("call "))
            calls += line.substr(5) + "\n";
    const std::string frame = "begin_frame 0\nrender_view 4 2 -8 4 46 0 90 0\nend_frame\n";
    EXPECT_EQ(calls,
        "init\nprepare_for_window\ninit_context false\nbegin_registration sample\nregister_model maps/sample.bsp\n"
        "set_sky desert 2 0 0 1\nend_registration\n"
            + frame + frame + "shutdown\n");
}

TEST_F(Cli, WritesThePictureAsShown)
{
    ASSERT_EQ(render({ "-o", "a.png" }).status, 0);
    const std::string file = folder.read("a.png");
    const auto* bytes = reinterpret_cast<const std::byte*>(file.data());
    const formats::Image image = formats::read_common_image({ bytes, file.size() }, "a.png");
    ASSERT_EQ(image.width, 4);
    ASSERT_EQ(image.height, 2);
    EXPECT_EQ(image.at(0, 0), (formats::Rgba8 { 0, 100, 200, 255 }));
    EXPECT_EQ(image.at(3, 1), (formats::Rgba8 { 13, 113, 213, 255 }));
    EXPECT_EQ(folder.names(), (std::vector<std::string> { "a.png", "baseq2", "cache" }));
}

TEST_F(Cli, WritesRadianceAsPfm)
{
    ASSERT_EQ(render({ "-o", "a.pfm" }).status, 0);
    const std::string file = folder.read("a.pfm");
    const std::string header = "PF\n4 2\n-1";
    ASSERT_TRUE(file.starts_with(header)) << file.substr(0, 16);
    const size_t pixel_bytes = 4 * 2 * 3 * sizeof(float);
    ASSERT_GT(file.size(), pixel_bytes);
    float lower_left[3];
    std::memcpy(lower_left, file.data() + file.size() - pixel_bytes, sizeof lower_left);
    EXPECT_EQ(lower_left[0], 10); // the format's rows go from the bottom up
    EXPECT_EQ(lower_left[2], 210);
}

TEST_F(Cli, WritesRadianceAsExr)
{
    ASSERT_EQ(render({ "-o", "a.exr" }).status, 0);
    Imf::InputFile file((folder.path() / "a.exr").c_str());
    ASSERT_EQ(file.header().dataWindow().max.x, 3);
    ASSERT_EQ(file.header().dataWindow().max.y, 1);
    ASSERT_TRUE(file.header().channels().findChannel("G"));
    EXPECT_EQ(file.header().channels().findChannel("G")->type, Imf::FLOAT);
    float green[2][4] = {};
    Imf::FrameBuffer frame;
    frame.insert("G", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&green[0][0]), sizeof(float), sizeof green[0]));
    file.setFrameBuffer(frame);
    file.readPixels(0, 1);
    EXPECT_EQ(green[0][0], 100);
    EXPECT_EQ(green[1][3], 113);
}

TEST_F(Cli, PagesAreThoseInTheDocs)
{
    for (const auto& [option, name] : { std::pair("--cvars", "cvars.md"), std::pair("--passes", "passes.md") }) {
        const ProgramResult result = run({ "info", option });
        EXPECT_EQ(result.status, 0);
        std::ifstream stream(std::filesystem::path(CVAR_PAGE).parent_path() / name);
        const std::string stored { std::istreambuf_iterator<char>(stream), {} };
        EXPECT_EQ(result.output, stored) << "write it anew: vkpt info " << option << " > docs/" << name;
    }
}

// What is printed counts once it is written; the buffer's last part is written at the very end.
TEST_F(Cli, FullStandardOutputIsAFailure)
{
    ASSERT_EQ(render({ "-o", "a.pfm" }).status, 0);
    for (const std::string command : { "info --json", "info", "info --cvars", "diff a.pfm a.pfm", "--help",
             "--man-page", "export --help", "bench maps/sample.bsp --size 4x2 --frames 2" }) {
        const std::string line = std::string("exec '") + VKPT_PROGRAM + "' " + command + " >/dev/full";
        const ProgramResult result = run_program("/bin/sh", { "-c", line }, folder.path(),
            { std::string("VKPT_MODULE=") + FAKE_MODULE, "XDG_CACHE_HOME=" + (folder.path() / "cache").string() });
        EXPECT_EQ(result.status, 1) << command;
        expect_in(result.errors, "No space left");
    }
}

// Once there was a folder of a known name among the temporary files then, which anybody could have made before.
TEST_F(Cli, WithoutAHomeNothingIsKept)
{
    folder.write("tmp/other/file", "");
    const ProgramResult result = run_program("/usr/bin/env",
        { "-u", "HOME", "-u", "XDG_CACHE_HOME", "TMPDIR=" + (folder.path() / "tmp").string(),
            std::string("VKPT_MODULE=") + FAKE_MODULE, VKPT_PROGRAM, "compare", "maps/sample.bsp", "--samplers",
            "uniform", "--size", "40x36", "--runs", "2", "--frames", "2", "--reference-spp", "16", "-o", "compared" },
        folder.path());
    EXPECT_EQ(result.status, 0) << result.errors;
    expect_in(result.errors, "nothing is cached for the next run: there is no home folder");
    expect_in(result.errors, "references are not cached: there is no home folder");
    std::filesystem::remove_all(folder.path() / "tmp/other");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "tmp"));
}

TEST_F(Cli, CacheOfAnotherUserIsLeftAlone)
{
    std::filesystem::create_directories(folder.path() / "cache/vkpt");
    std::filesystem::permissions(folder.path() / "cache/vkpt", std::filesystem::perms(0777));
    const ProgramResult result = render({ "-o", "a.png" });
    EXPECT_EQ(result.status, 0);
    expect_in(result.errors, "cache/vkpt is writable by others");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "cache/vkpt"));
}

void expect_info_schema(const ProgramResult& result)
{
    ASSERT_EQ(result.status, 0) << result.errors;
    const nlohmann::json info = nlohmann::json::parse(result.output);
    EXPECT_EQ(info.at("schema"), 1);
    for (const char* key : { "module", "device", "driver", "vulkan", "trace_backend" })
        EXPECT_FALSE(info.at(key).get<std::string>().empty()) << key;
    EXPECT_EQ(info.at("api_versions"), (std::vector<int> { 5, 6, 7, 8 }));
    const std::vector<std::string> backends = info.at("trace_backends");
    EXPECT_TRUE(std::ranges::count(backends, info.at("trace_backend").get<std::string>())) << info.dump(2);
    const std::vector<std::string> samplers = info.at("light_samplers");
    EXPECT_TRUE(std::ranges::count(samplers, "uniform")) << info.dump(2);
    EXPECT_TRUE(std::ranges::count(samplers, "subset_pps")) << info.dump(2);
    EXPECT_TRUE(info.at("denoisers").is_array());
    EXPECT_GE(info.at("limits").at("entities"), 128);
    EXPECT_GE(info.at("limits").at("dlights"), 32);
    EXPECT_GE(info.at("limits").at("particles"), 4096);
    EXPECT_GE(info.at("limits").at("image_size"), 4096);
}

TEST_F(Cli, InfoHasItsSchema)
{
    expect_info_schema(run({ "info", "--json" }));
    const nlohmann::json with_cvars = nlohmann::json::parse(run({ "info", "--json", "--cvars" }).output);
    EXPECT_EQ(with_cvars.at("cvars").at(0).at("name"), "pt_bounces");
    expect_in(run({ "info" }).output, "a device of paper");
}

TEST_F(Cli, BenchHasItsKeys)
{
    const ProgramResult result = run({ "bench", "maps/sample.bsp", "--size", "4x2", "--frames", "40", "--warmup", "3",
        "--ab", "pt_bounces=0,2", "--json", "b.json" });
    ASSERT_EQ(result.status, 0) << result.errors;
    expect_in(result.output, "a device of paper");
    const nlohmann::json json = nlohmann::json::parse(folder.read("b.json"));
    EXPECT_EQ(json.at("schema"), 1);
    EXPECT_EQ(json.at("scene"), "maps/sample.bsp");
    EXPECT_EQ(json.at("size"), (std::vector<int> { 4, 2 }));
    EXPECT_EQ(json.at("frames"), 40);
    EXPECT_EQ(json.at("settings").at("pt_bounces"), "0");
    EXPECT_EQ(json.at("device"), "a device of paper");
    for (const char* key : { "median", "p5", "p95" })
        EXPECT_EQ(json.at("frame_ms").at(key), 4) << key;
    EXPECT_EQ(json.at("frame_ms").at("samples").size(), 40u);
    EXPECT_EQ(json.at("passes").at(0).at("name"), "rays");
    EXPECT_EQ(json.at("passes").at(0).at("median_ms"), 2);
    EXPECT_EQ(json.at("passes").at(0).at("p95_ms"), 2);
    EXPECT_EQ(json.at("passes").at(0).at("samples_ms").size(), 40u)
        << "warm-up does not count, the other value neither";
    EXPECT_EQ(json.at("cpu").at(0).at("name"), "scene");
    EXPECT_EQ(json.at("cpu").at(0).at("median_ms"), 0.25);
    EXPECT_EQ(json.at("rays_per_frame"), 8);
    EXPECT_GT(json.at("mrays_per_s"), 0);
    EXPECT_GT(json.at("peak_rss_mib"), 1);
    EXPECT_TRUE(json.at("gpu_mib").is_number());
    EXPECT_GT(json.at("start").at("first_frame_s"), 0);
    EXPECT_EQ(json.at("ab").at("values"), (std::vector<std::string> { "0", "2" }));
    EXPECT_EQ(json.at("ab").at("second").at("settings").at("pt_bounces"), "2");
    const nlohmann::json ratio = json.at("ab").at("ratios").at(1);
    EXPECT_EQ(ratio.at("name"), "rays");
    EXPECT_EQ(ratio.at("ratio"), 1);
    EXPECT_EQ(ratio.at("low"), 1);
}

TEST_F(Cli, BenchComparesWithAnEarlierRun)
{
    const auto run_with = [&](std::initializer_list<std::string> more, const char* size = "4x2") {
        std::vector<std::string> arguments { "bench", "maps/sample.bsp", "--frames", "20", "--size", size };
        arguments.insert(arguments.end(), more);
        return run(arguments);
    };
    ASSERT_EQ(run_with({ "--json", "b.json" }).status, 0);
    const ProgramResult again = run_with({ "--against", "b.json" });
    EXPECT_EQ(again.status, 0) << again.errors;
    expect_in(again.output, "95 % interval");
    const ProgramResult other = run_with({ "--against", "b.json" }, "8x2");
    EXPECT_EQ(other.status, 1);
    expect_in(other.errors, "4 x 2");
    EXPECT_EQ(run_with({ "--against", "none.json" }).status, 1);
    folder.write("text.json", "no json");
    EXPECT_EQ(run_with({ "--against", "text.json" }).status, 1);
    folder.write("new.json", R"({ "schema": 2 })");
    const ProgramResult newer = run_with({ "--against", "new.json" });
    EXPECT_EQ(newer.status, 1);
    expect_in(newer.errors, "newer vkpt");
}

TEST_F(Cli, DiffMeasuresAndDraws)
{
    ASSERT_EQ(render({ "-o", "a.pfm" }).status, 0);
    ASSERT_EQ(render({ "-o", "a.exr" }).status, 0);
    const ProgramResult same = run({ "diff", "a.pfm", "a.exr", "--json" });
    ASSERT_EQ(same.status, 0) << same.errors;
    const nlohmann::json json = nlohmann::json::parse(same.output);
    EXPECT_EQ(json.at("schema"), 1);
    const nlohmann::json& picture = json.at("pictures").at(0);
    for (const char* name : { "rmse", "rel_mse", "mean_difference", "flip", "specks" })
        EXPECT_EQ(picture.at(name), 0) << name;
    EXPECT_EQ(picture.at("file"), "a.exr");
    const ProgramResult heat = run({ "diff", "a.pfm", "a.exr", "-o", "heat.png" });
    EXPECT_EQ(heat.status, 0) << heat.errors;
    expect_in(heat.output, "flip");
    const std::string file = folder.read("heat.png");
    const formats::Image map
        = formats::read_common_image({ reinterpret_cast<const std::byte*>(file.data()), file.size() }, "heat.png");
    EXPECT_EQ(map.width, 4);
    EXPECT_EQ(map.at(0, 0), (formats::Rgba8 { 0, 0, 0, 255 }));
}

TEST_F(Cli, DiffRefusesWhatCannotBeCompared)
{
    ASSERT_EQ(render({ "-o", "a.pfm" }).status, 0);
    ASSERT_EQ(render({ "-o", "a.png" }).status, 0);
    ASSERT_EQ(run({ "render", "maps/sample.bsp", "--size", "2x2", "--spp", "1", "-o", "small.pfm" }).status, 0);
    folder.write("cut.pfm", folder.read("a.pfm").substr(0, 30));
    const struct {
        std::vector<std::string> arguments;
        int status;
        const char* part;
    } cases[] = {
        { { "diff", "a.pfm", "small.pfm" }, 1, "4 x 2" },
        { { "diff", "a.pfm", "a.png" }, 1, "linear" },
        { { "diff", "a.pfm", "cut.pfm" }, 1, "cut.pfm" },
        { { "diff", "a.pfm", "nowhere.exr" }, 1, "nowhere.exr" },
        { { "diff", "a.pfm", "a.pfm", "-o", "nofolder/heat.png" }, 1, "nofolder" },
        { { "diff", "a.pfm", "a.pfm", "-o", "heat.gif" }, 2, "heat.gif" },
        { { "diff", "a.pfm", "a.pfm", "a.pfm", "-o", "heat.png" }, 2, "-o" },
        { { "diff", "a.pfm" }, 2, "PICTURE" },
    };
    for (const auto& [arguments, status, part] : cases) {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.status, status) << arguments.back();
        expect_in(result.errors, part);
        for (const std::string& name : folder.names())
            EXPECT_FALSE(name.starts_with("heat") || name.starts_with(".")) << name;
    }
}

TEST_F(Cli, CompareWritesAllOfItsFiles)
{
    const std::vector<std::string> command { "compare", "maps/sample.bsp", "--samplers", "all", "--subsets", "1,8",
        "--noise", "blue,white", "--denoisers", "off,asvgf", "--size", "40x36", "--runs", "2", "--frames", "2",
        "--warmup", "1", "--reference-spp", "32", "-o", "compared" };
    const ProgramResult result = run(command);
    ASSERT_EQ(result.status, 0) << result.errors;
    expect_in(result.output, "compared/index.html");
    expect_in(result.output, "| `subset_pps R8 white asvgf` |");
    const ScratchFolder& files = folder;
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "compared"))
        names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    EXPECT_EQ(names, (std::vector<std::string> { "figures.csv", "figures.json", "index.html", "sheet.png" }));
    const nlohmann::json json = nlohmann::json::parse(files.read("compared/figures.json"));
    EXPECT_EQ(json.at("rows").size(), 12u); // subset_pps: 2 * 2 * 2, uniform: 2 * 2
    for (const nlohmann::json& row : json.at("rows")) {
        EXPECT_EQ(row.at("rmse"), 0) << "the module of paper always draws the same";
        EXPECT_EQ(row.at("flicker"), 0);
    }
    EXPECT_EQ(json.at("scenes").at(0).at("reference").at("cached"), false);
    ASSERT_EQ(run(command).status, 0);
    EXPECT_EQ(
        nlohmann::json::parse(files.read("compared/figures.json")).at("scenes").at(0).at("reference").at("cached"),
        true);
}

TEST_F(Cli, CompareRefusesWhatThereIsNot)
{
    const struct {
        std::vector<std::string> arguments;
        int status;
        const char* part;
    } cases[] = {
        { { "compare", "-o", "compared" }, 2, "--figures" },
        { { "compare", "maps/sample.bsp", "--figures", "-o", "compared" }, 2, "SCENE" },
        { { "compare", "--figures", "-o", "compared" }, 1, "maps/vkpt1.bsp" },
        { { "compare", "maps/sample.bsp", "--samplers", "best", "-o", "compared" }, 2, "subset_pps, uniform" },
        { { "compare", "maps/sample.bsp", "--reference-sampler", "best", "--samplers", "subset_pps", "-o", "compared" },
            2, "best" },
        { { "compare", "maps/sample.bsp", "--runs", "1", "-o", "compared" }, 2, "--runs" },
        { { "compare", "maps/nowhere.bsp", "-o", "compared" }, 1, "maps/nowhere.bsp" },
        { { "compare", "maps/sample.bsp", "-o", "baseq2/maps/sample.bsp" }, 1, "baseq2/maps/sample.bsp" },
        { { "export", "maps/sample.bsp", "-o", "exported" }, 1, "no map to export" },
    };
    for (const auto& [arguments, status, part] : cases) {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.status, status) << part << "\n" << result.errors;
        expect_in(result.errors, part);
        expect_no_output_left();
    }
}

#ifdef REAL_MODULE
TEST_F(Cli, InfoOfTheRealModuleHasItsSchema) { expect_info_schema(run({ "info", "--json", "--module", REAL_MODULE })); }

TEST_F(Cli, RealModuleRefusesWhatItCannotDo)
{
    const ProgramResult result = run({ "info", "--module", REAL_MODULE, "--set", "pt_device=no such device" });
    EXPECT_EQ(result.status, 1);
    expect_in(result.errors, "no such device");
}

// The CPU driver's compiler would crash.
TEST_F(Cli, ATightLimitOfAddressSpaceIsTold)
{
    const ProgramResult result = run_program("/bin/sh",
        { "-c", "ulimit -v 1000000; exec \"$0\" info --module \"$1\"", VKPT_PROGRAM, REAL_MODULE }, folder.path());
    EXPECT_EQ(result.status, 1);
    expect_in(result.errors, "976 MiB of address space");
    expect_in(result.errors, "ulimit -v unlimited");
}

TEST_F(Cli, RealModuleRendersTheSampleMap)
{
    const ProgramResult result = render({ "--module", REAL_MODULE, "--set", "pt_validation=1", "-o", "a.png" });
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(result.errors.find("vkpt validation:"), std::string::npos) << result.errors;
    EXPECT_FALSE(folder.read("a.png").empty());
}

// Nothing is cut off where the shape does not fit: who asked for a panorama learns why it looks wrong.
TEST_F(Cli, AStretchedPanoramaIsTold)
{
    const auto stretched = [&](const std::string& size, const std::string& projection) {
        const ProgramResult result = run({ "render", "maps/sample.bsp", "--size", size, "--spp", "1", "--module",
            REAL_MODULE, "--set", "pt_projection=" + projection, "-o", "a.png" });
        EXPECT_EQ(result.status, 0) << result.errors;
        return result.errors.find("use --size 12x6") != std::string::npos;
    };
    EXPECT_TRUE(stretched("8x6", "equirectangular"));
    EXPECT_FALSE(stretched("12x6", "equirectangular"));
    EXPECT_FALSE(stretched("8x6", "fisheye"));
}

TEST_F(Cli, ExportAgreesWithTheModule)
{
    const ProgramResult result = run({ "export", "maps/sample.bsp", "--module", REAL_MODULE, "--size", "16x8", "--set",
        "pt_validation=1", "-o", "scene" });
    ASSERT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(result.errors.find("vkpt validation:"), std::string::npos) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(folder.read("scene/scene.json"));
    EXPECT_EQ(json.at("emitters").size(), json.at("emitter_count"));
    EXPECT_EQ(json.at("camera").at("width"), 16);
    const std::string obj = folder.read("scene/scene.obj");
    size_t faces = 0;
    for (size_t at = 0; (at = obj.find("\nf ", at)) != std::string::npos; at++)
        faces++;
    EXPECT_EQ(faces, json.at("triangles").get<size_t>());
    EXPECT_FALSE(folder.read("scene/scene.mtl").empty());
}
#endif

#ifdef REAL_MODULE
// Nothing of the build's own folder is looked at: the copy finds what was installed with it.
TEST(Installation, FindsItsModules)
{
    const ScratchFolder folder;
    const std::filesystem::path prefix = folder.path() / "usr";
    const ProgramResult installed
        = run_program(CMAKE_PROGRAM, { "--install", BUILD_FOLDER, "--prefix", prefix.string() }, folder.path());
    ASSERT_EQ(installed.status, 0) << installed.errors;
    const std::vector<std::string> environment { "VKPT_MODULE=",
        "XDG_CACHE_HOME=" + (folder.path() / "cache").string() };
    const auto run = [&](const std::vector<std::string>& arguments) {
        return run_program((prefix / "bin/vkpt").string(), arguments, folder.path(), environment);
    };
    const ProgramResult info = run({ "info", "--json" });
    EXPECT_EQ(info.status, 0) << info.errors;
    EXPECT_TRUE(nlohmann::json::parse(info.output).contains("light_samplers"));
    for (const char* file : { "lib/vkpt/ref_record.so", "lib/vkpt/recording_clock.so", "lib/vkpt/recording_sound.so",
             "share/man/man1/vkpt.1" })
        EXPECT_TRUE(std::filesystem::exists(prefix / file)) << file;
    std::filesystem::remove(prefix / "lib/vkpt/ref_vkpt.so");
    const ProgramResult missing = run({ "info" });
    EXPECT_EQ(missing.status, 1);
    expect_in(missing.errors, "ref_vkpt.so is missing");
    expect_in(missing.errors, "lib/vkpt");
}
#endif

} // namespace
} // namespace vkpt::tests

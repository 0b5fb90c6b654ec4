// SPDX-License-Identifier: GPL-2.0-or-later
// `vkpt film` from the outside, with an ffmpeg that counts what it gets.
#include "common/trace/trace_writer.hpp"
#include "formats/image.hpp"
#include "tests/client/run_program.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sstream>

namespace vkpt::tests {
namespace {

using trace::Call;
using trace::CallKind;

class Film : public testing::Test {
protected:
    // Two seconds at ten frames a second; the camera goes ten units a second along x.
    Film()
    {
        write_sample_map(folder, "sample", R"({ "classname" "worldspawn" })");
        trace::TraceWriter writer(folder.path() / "a.rtrace");
        writer.write(make_call(CallKind::begin_registration, "sample"));
        writer.write(make_call(CallKind::register_model, "maps/sample.bsp", { 1 }));
        writer.write(make_call(CallKind::end_registration));
        for (int i = 0; i <= 20; i++) {
            writer.write(make_call(CallKind::begin_frame));
            trace::View view;
            view.refdef.width = 640;
            view.refdef.height = 480;
            view.refdef.fov_x = view.refdef.fov_y = 90;
            view.refdef.time = 3 + float(i) / 10;
            view.refdef.view_origin[0] = float(i);
            writer.write(view);
            writer.write(make_call(CallKind::draw_fill, "", { 1 }));
            writer.write(make_call(CallKind::end_frame));
        }
        writer.finish();
        std::filesystem::create_directory(folder.path() / "bin");
    }

    // `script`: after that it has answered which codecs it has.
    void write_ffmpeg(const std::string& script) const
    {
        folder.write("bin/ffmpeg",
            "#!/bin/sh\ncase \"$*\" in *-encoders) echo ' V..... libx264'; exit 0;; -version) exit 0;; esac\n"
                + script);
        std::filesystem::permissions(folder.path() / "bin/ffmpeg", std::filesystem::perms(0755));
    }
    ProgramResult film(std::vector<std::string> more, const std::string& path = "/usr/bin:/bin") const
    {
        std::vector<std::string> arguments { "film", "a.rtrace", "--verbose" };
        if (std::ranges::find(more, "--size") == more.end())
            more.insert(more.end(), { "--size", "8x4" });
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_program(VKPT_PROGRAM, arguments, folder.path(),
            { std::string("VKPT_MODULE=") + FAKE_MODULE, "XDG_CACHE_HOME=" + (folder.path() / "cache").string(),
                "PATH=" + (folder.path() / "bin").string() + ":" + path });
    }
    // Where the camera was in each of the module's frames, and whether it was blended with the one before.
    static std::vector<std::pair<double, bool>> samples_of(const ProgramResult& result)
    {
        std::vector<std::pair<double, bool>> samples;
        std::istringstream lines(result.errors);
        bool blends = false;
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words(line);
            std::string call, verb;
            double width = 0, height = 0, x = 0;
            words >> call >> verb >> width >> height >> x;
            if (verb == "render_view")
                samples.emplace_back(x, std::exchange(blends, false));
            else
                blends |= verb == "blend_next_view";
        }
        return samples;
    }

    ScratchFolder folder;
};

// 5 frames a second with the shutter open for half of that: a tenth of a second, so one unit, four samples of it.
TEST_F(Film, SamplesAreSpreadOverTheShuttersTime)
{
    const ProgramResult result
        = film({ "--spp", "4", "--fps", "5", "--shutter", "0.5", "--from", "0.4", "--seconds", "0.4", "-o", "out/" });
    EXPECT_EQ(result.status, 0) << result.errors;
    const auto samples = samples_of(result);
    ASSERT_EQ(samples.size(), 8u) << result.errors;
    for (size_t i = 0; i < samples.size(); i++) {
        const double expected = 4 + double(i / 4) * 2 + (double(i % 4) + 0.5) / 4;
        EXPECT_NEAR(samples[i].first, expected, 1e-3) << i;
        EXPECT_EQ(samples[i].second, i % 4 != 0) << i;
    }
    EXPECT_EQ(result.errors.find("draw_fill"), std::string::npos) << "films have no 2D";
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/frame000001.png"));
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/frame000002.png"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/frame000003.png"));
}

TEST_F(Film, AClosedShutterFreezesTheMoment)
{
    const auto samples
        = samples_of(film({ "--spp", "3", "--fps", "1", "--shutter", "0", "--seconds", "1", "-o", "out/" }));
    ASSERT_EQ(samples.size(), 3u);
    for (const auto& [x, blends] : samples)
        EXPECT_NEAR(x, 0, 1e-4);
}

TEST_F(Film, LensIsThatOfTheOptions)
{
    const auto lens_of = [&](std::vector<std::string> options) {
        options.insert(options.end(), { "--spp", "1", "--seconds", "0.1", "--set", "fake_lens=1", "-o", "out/" });
        const ProgramResult result = film(options);
        EXPECT_EQ(result.status, 0) << result.errors;
        const size_t start = result.errors.find("call lens "), end = result.errors.find('\n', start);
        return start == std::string::npos ? "none" : result.errors.substr(start, end - start);
    };
    EXPECT_EQ(lens_of({}), "call lens 0 256") << "all is sharp";
    EXPECT_EQ(lens_of({ "--aperture", "6.5", "--focus", "180" }), "call lens 6.5 180");
    for (const std::vector<std::string>& wrong : { std::vector<std::string> { "--aperture", "-1" },
             { "--aperture", "1001" }, { "--focus", "0" }, { "--focus", "100001" } }) {
        std::vector<std::string> options = wrong;
        options.insert(options.end(), { "-o", "out/" });
        EXPECT_EQ(film(options).status, 2) << wrong[0] << " " << wrong[1];
    }
}

TEST_F(Film, FfmpegGetsEveryPicture)
{
    write_ffmpeg("for last; do :; done\necho \"$*\" > arguments.txt\nwc -c > \"$last\"\n");
    const ProgramResult result = film({ "--spp", "1", "--fps", "10", "-o", "a.mp4" });
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(std::stoi(folder.read("a.mp4")), 20 * 8 * 4 * 4);
    const std::string arguments = folder.read("arguments.txt");
    for (const char* part : { "-video_size 8x4", "-framerate 10", "-pixel_format rgba", "-c:v libx264" })
        EXPECT_NE(arguments.find(part), std::string::npos) << arguments;
}

TEST_F(Film, FfmpegGetsTheSoundOfTheFilmsTime)
{
    write_ffmpeg("for last; do :; done\necho \"$*\" > arguments.txt\ncat > \"$last\"\n");
    folder.write("a.wav", "whatever ffmpeg reads");
    const ProgramResult result
        = film({ "--spp", "1", "--fps", "10", "--from", "0.5", "--seconds", "1", "--sound", "a.wav", "-o", "a.mp4" });
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_NE(result.output.find("with sound"), std::string::npos) << result.output;
    const std::string arguments = folder.read("arguments.txt");
    const std::string sound = "-i pipe:0 -ss 0.500000 -i " + (folder.path() / "a.wav").string();
    EXPECT_NE(arguments.find(sound), std::string::npos) << arguments;
    EXPECT_NE(arguments.find("-af apad -t 1.000000"), std::string::npos) << arguments;
    const ProgramResult silent = film({ "--spp", "1", "--fps", "10", "--no-sound", "-o", "b.mp4" });
    EXPECT_EQ(silent.status, 0) << silent.errors;
    EXPECT_NE(silent.output.find("without sound"), std::string::npos) << silent.output;
    EXPECT_EQ(folder.read("arguments.txt").find(" -ss "), std::string::npos);
}

TEST_F(Film, SaysWhatIsMissingOrWrong)
{
    const ProgramResult none = film({ "-o", "a.mp4" }, "/nowhere");
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.errors.find("apt install ffmpeg"), std::string::npos) << none.errors;
    write_ffmpeg("echo no room >&2\nexit 1\n");
    const ProgramResult broken = film({ "--spp", "1", "-o", "a.mp4" });
    EXPECT_EQ(broken.status, 1);
    EXPECT_NE(broken.errors.find("no room"), std::string::npos) << broken.errors;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.mp4"));
    EXPECT_EQ(film({ "-o", "a.avi" }).status, 2);
    const ProgramResult odd = film({ "--size", "7x5", "-o", "a.mp4" });
    EXPECT_EQ(odd.status, 2);
    EXPECT_NE(odd.errors.find("such as 8x6"), std::string::npos) << odd.errors;
    EXPECT_EQ(film({ "--size", "7x5", "--spp", "1", "--seconds", "0.1", "-o", "out/" }).status, 0);
    EXPECT_EQ(film({ "--from", "9", "-o", "out/" }).status, 2);
    EXPECT_EQ(film({ "--shutter", "2", "-o", "out/" }).status, 2);
    EXPECT_EQ(film({ "--sound", "a.wav", "-o", "out/" }).status, 2);
    EXPECT_EQ(film({ "--sound", "a.wav", "--no-sound", "-o", "a.mp4" }).status, 2);
    const ProgramResult no_sound = film({ "--sound", "none.wav", "-o", "a.mp4" });
    EXPECT_EQ(no_sound.status, 1);
    EXPECT_NE(no_sound.errors.find("none.wav"), std::string::npos) << no_sound.errors;
    const ProgramResult map = run_program(VKPT_PROGRAM, { "film", "maps/sample.bsp", "-o", "a.mp4" }, folder.path());
    EXPECT_EQ(map.status, 2);
    EXPECT_NE(map.errors.find("no recorded game"), std::string::npos) << map.errors;
}

} // namespace
} // namespace vkpt::tests

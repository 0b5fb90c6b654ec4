// SPDX-License-Identifier: GPL-2.0-or-later
// Recording by the real engine, and the replay against what the engine itself shows.
#include "common/read_text.hpp"
#include "common/trace/trace_reader.hpp"
#include "formats/wav.hpp"
#include "tests/client/run_program.hpp"
#include "tests/engine/engine_run.hpp"
#include "tests/engine/picture_statistics.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <unistd.h>

namespace vkpt::tests {

namespace {

constexpr int width = 96, height = 64;
constexpr int capture_every = 11;
constexpr int played_messages = 110; // of the demo
constexpr const char* game_data = VKPT_TEST_BUILD_DIR "/game";

// The demo's beginning. A demo is a chain of messages, each led by its length; -1 ends it.
std::string cut_demo(const std::string& demo, int messages)
{
    size_t at = 0;
    for (int32_t length = 0; messages > 0 && at + sizeof length <= demo.size(); messages--) {
        std::memcpy(&length, demo.data() + at, sizeof length);
        at += sizeof length + size_t(length);
    }
    return demo.substr(0, at) + std::string(4, '\xff');
}

// A WAV file of 16 bits, stereo.
struct Heard {
    double rate = 0;
    std::vector<int16_t> left;
    double seconds() const { return double(left.size()) / rate; }
};

Heard read_heard(const std::string& file)
{
    constexpr size_t header = 44, rate_at = 24, moment = 4;
    Heard heard;
    if (file.size() < header)
        throw std::runtime_error("no WAV file");
    uint32_t rate = 0;
    std::memcpy(&rate, file.data() + rate_at, sizeof rate);
    heard.rate = rate;
    heard.left.resize((file.size() - header) / moment);
    for (size_t i = 0; i < heard.left.size(); i++)
        std::memcpy(&heard.left[i], file.data() + header + i * moment, sizeof(int16_t));
    return heard;
}

// When something is heard after a tenth of a second of silence, in seconds.
std::vector<double> find_clicks(const Heard& heard)
{
    std::vector<double> clicks;
    constexpr int quiet = 500;
    double silent_since = -1;
    for (size_t i = 0; i < heard.left.size(); i++) {
        if (std::abs(int(heard.left[i])) < quiet)
            continue;
        const double now = double(i) / heard.rate;
        if (now - silent_since > 0.1)
            clicks.push_back(now);
        silent_since = now;
    }
    return clicks;
}

// When the first of some lights appears: the muzzle's flash, which comes with the shot's sound.
std::vector<double> find_flashes(trace::TraceReader& reader)
{
    std::vector<double> flashes;
    size_t lights = 0;
    for (size_t i = 0; i < reader.frame_count(); i++) {
        const size_t now = reader.frame(i).views[0].dlights.size();
        if (lights == 0 && now > 0)
            flashes.push_back(reader.seconds(i));
        lights = now;
    }
    return flashes;
}

constexpr double max_lag = 1.0 / 20; // seconds between sound and picture

class Recording : public testing::Test {
protected:
    ProgramResult run(const std::vector<std::string>& arguments) const
    {
        return run_program(VKPT_PROGRAM, arguments, folder.path(),
            { "XDG_CACHE_HOME=" + (folder.path() / "cache").string(),
                // The engine's cache belongs to the user that it runs as.
                std::string("VKPT_CACHE_DIR=" VKPT_TEST_BUILD_DIR "/tests/engine/cache")
                    + (geteuid() == 0 ? "-root" : "") });
    }
    ProgramResult record(const std::string& output, const std::vector<std::string>& more = {}) const
    {
        std::vector<std::string> arguments { "record", own_demo, "--basedir", game_data, "-o", output };
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    // Game data whose only sound is the blaster's shot, a click; or none at all.
    void make_data(const std::string& name, bool has_click) const
    {
        const std::filesystem::path data = folder.path() / name / "baseq2";
        std::filesystem::create_directories(data / "sound/weapons");
        for (const auto& entry : std::filesystem::directory_iterator(std::string(game_data) + "/baseq2"))
            if (entry.path().filename() != "sound")
                std::filesystem::create_symlink(entry.path(), data / entry.path().filename());
        if (has_click)
            folder.write(name + "/baseq2/sound/weapons/blastf1a.wav", make_click());
    }
    static std::string make_click()
    {
        constexpr int count = 1100, period = 40, level = 20000;
        std::vector<int16_t> samples(count);
        for (int i = 0; i < count; i++)
            samples[size_t(i)] = int16_t(i % period < period / 2 ? level : -level);
        std::string file;
        for (const std::byte byte : formats::make_wav_header({}, uint32_t(2 * samples.size())))
            file += char(byte);
        return file + std::string(reinterpret_cast<const char*>(samples.data()), 2 * samples.size());
    }
    void write_ffmpeg(const std::string& script) const
    {
        folder.write("bin/ffmpeg", "#!/bin/sh\ncase \"$*\" in *-encoders|-version) exit 0;; esac\n" + script);
        std::filesystem::permissions(folder.path() / "bin/ffmpeg", std::filesystem::perms(0755));
    }
    ProgramResult film(const std::string& data, const std::vector<std::string>& more) const
    {
        std::vector<std::string> arguments { "film", own_demo, "--basedir", data, "--size", "16x16", "--spp", "1" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_program(VKPT_PROGRAM, arguments, folder.path(),
            { "XDG_CACHE_HOME=" + (folder.path() / "cache").string(), std::string("VKPT_MODULE=") + FAKE_MODULE,
                "PATH=" + (folder.path() / "bin").string() + ":" + std::getenv("PATH") });
    }
    void expect_nothing_left() const { EXPECT_EQ(folder.names(), std::vector<std::string> {}); }

    ScratchFolder folder;
};

} // namespace

TEST_F(Recording, TwiceTheSameAndSmall)
{
    ASSERT_EQ(record("a.rtrace").status, 0);
    const ProgramResult again = record("b.rtrace");
    ASSERT_EQ(again.status, 0) << again.errors;
    EXPECT_EQ(folder.read("a.rtrace"), folder.read("b.rtrace"));
    const trace::TraceReader reader(folder.path() / "a.rtrace");
    EXPECT_EQ(reader.cut_at(), 0u);
    const double seconds = double(reader.time(reader.frame_count() - 1)) - double(reader.time(0));
    EXPECT_GT(seconds, 15);
    EXPECT_NEAR(double(reader.frame_count()) / seconds, 60, 3);
    EXPECT_LT(double(reader.file_bytes()) / seconds, 60e3);
}

TEST_F(Recording, FailuresLeaveNoFile)
{
    const ProgramResult no_demo = record("a.rtrace", { "--game", "nothere" });
    EXPECT_EQ(no_demo.status, 1);
    const ProgramResult no_engine = record("a.rtrace", { "--engine", "/nonexistent/quake2" });
    EXPECT_EQ(no_engine.status, 1);
    EXPECT_NE(no_engine.errors.find("/nonexistent/quake2"), std::string::npos) << no_engine.errors;
    EXPECT_EQ(record("a.png").status, 2);
    expect_nothing_left();
    // Engines that die half-way, one way or the other.
    for (const char* end : { "exit 3", "kill -SEGV $$", "exit 0" }) {
        SCOPED_TRACE(end);
        folder.write("engine", std::string("#!/bin/sh\necho these are its last words\n") + end + "\n");
        std::filesystem::permissions(folder.path() / "engine", std::filesystem::perms(0755));
        const ProgramResult result = record("a.rtrace", { "--engine", "engine" });
        EXPECT_EQ(result.status, 1) << result.errors;
        EXPECT_EQ(folder.names(), std::vector<std::string> { "engine" });
        EXPECT_FALSE(result.errors.empty());
        std::filesystem::remove(folder.path() / "engine");
    }
    folder.write("no.dm2", "this is no demo, however long it may be");
    EXPECT_EQ(run({ "record", "no.dm2", "--basedir", game_data, "-o", "a.rtrace" }).status, 1);
}

// The same demo, once through the engine and once through a trace, each in its own process: the same bits. Console
// lines over the picture stay for ever, because in the engine they go by the clock on the wall; none is of the capture.
TEST_F(Recording, ReplayShowsWhatTheEngineShows)
{
    const std::string size = std::to_string(width) + "x" + std::to_string(height),
                      every = std::to_string(capture_every);
    const std::string demo = cut_demo(read_text(std::string(game_data) + "/baseq2/demos/" + own_demo), played_messages);
    folder.write("start.dm2", demo);
    EngineOptions options;
    options.files["demos/start.dm2"] = demo;
    options.width = width;
    options.height = height;
    options.render_scale = 100;
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+set", "pt_capture_every", every, "+set", "timedemo",
        "1", "+set", "fixedtime", "100000", "+set", "cl_predict", "0", "+set", "con_notifytime", "100000", "+set",
        "nextdemo", "quit", "+demomap", "start.dm2" };
    const EngineRun engine(options);
    engine.expect_clean();
    const auto shown = list_pictures(engine.captures());
    ASSERT_GE(shown.size(), 8u) << engine.result().console;

    const ProgramResult recorded = run({ "record", "start.dm2", "--basedir", game_data, "--timedemo", "--size", size,
        "--set", "con_notifytime=100000", "-o", "a.rtrace" });
    ASSERT_EQ(recorded.status, 0) << recorded.errors;
    const size_t frames = trace::TraceReader(folder.path() / "a.rtrace").frame_count();
    const ProgramResult replayed = run({ "render", "a.rtrace", "--basedir", game_data, "--size", size, "--seed", "1",
        "--set", "pt_validation=1", "--frames", std::to_string(frames), "--set", "pt_capture_dir=capture", "--set",
        "pt_capture_every=" + every, "-o", "last.png" });
    ASSERT_EQ(replayed.status, 0) << replayed.errors;
    EXPECT_EQ(replayed.errors.find("vkpt validation:"), std::string::npos) << replayed.errors;
    for (const auto& picture : shown) {
        const auto other = folder.path() / "cache/vkpt/vkpt/captures/capture" / picture.filename();
        EXPECT_TRUE(read_text(picture) == read_text(other)) << other;
    }
}

// What the module kept of the game, saved and rendered; a restart of the renderer in the middle of it ends the replay.
TEST_F(Recording, InstantReplayIsSavedAndRendered)
{
    EngineOptions options;
    options.width = width;
    options.height = height;
    options.script = "wait_100\npt_replay\nwait_5\npt_replay play "
                     "-0.5\nwait_25\npt_replay save moment\nwait_5\n"
                     "vid_restart\nwait_25\npt_replay info\npt_replay\nwait_5\npt_replay off\nwait_5\nquit\n";
    options.arguments = { "+set", "pt_photo_save", "1", "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun engine(options);
    engine.expect_clean();
    const auto trace = engine.result().game_folder / "vkpt/replays/moment.rtrace";
    ASSERT_TRUE(std::filesystem::exists(trace)) << engine.result().console;
    const trace::TraceReader reader(trace);
    EXPECT_EQ(reader.cut_at(), 0u);
    ASSERT_GT(reader.frame_count(), 20u) << engine.result().console;
    EXPECT_FALSE(engine.lines_with("seconds are kept").empty()) << engine.result().console;
    const ProgramResult rendered = run({ "render", trace.string() + "@10", "--basedir", game_data, "--size", "96x64",
        "--spp", "8", "-o", "moment.png" });
    ASSERT_EQ(rendered.status, 0) << rendered.errors;
    EXPECT_EQ(rendered.errors.find("differ here"), std::string::npos) << rendered.errors;
    EXPECT_GT(measure_picture(load_picture(folder.path() / "moment.png")).mean, 0.01);
}

TEST_F(Recording, SoundLiesBesideItsPicture)
{
    make_data("data", true);
    const ProgramResult recorded
        = run({ "record", own_demo, "--basedir", "data", "-o", "a.rtrace", "--sound", "a.wav" });
    ASSERT_EQ(recorded.status, 0) << recorded.errors;
    trace::TraceReader reader(folder.path() / "a.rtrace");
    const Heard heard = read_heard(folder.read("a.wav"));
    EXPECT_NEAR(heard.seconds(), reader.seconds(reader.frame_count() - 1), max_lag);
    const std::vector<double> flashes = find_flashes(reader), clicks = find_clicks(heard);
    EXPECT_GE(flashes.size(), 3u) << "the demo's player fires";
    ASSERT_EQ(clicks.size(), flashes.size());
    for (size_t i = 0; i < clicks.size(); i++)
        EXPECT_NEAR(clicks[i], flashes[i], max_lag);
    // Sound changes nothing of what is drawn.
    ASSERT_EQ(run({ "record", own_demo, "--basedir", "data", "-o", "b.rtrace" }).status, 0);
    EXPECT_EQ(folder.read("a.rtrace"), folder.read("b.rtrace"));
}

// ffmpeg gets the sound of the film's time; here it is a script that keeps it.
TEST_F(Recording, FilmsOfDemosAreHeard)
{
    make_data("data", true);
    ASSERT_EQ(run({ "record", own_demo, "--basedir", "data", "-o", "a.rtrace" }).status, 0);
    trace::TraceReader reader(folder.path() / "a.rtrace");
    const double first = find_flashes(reader).at(0);
    constexpr double before = 0.7, seconds = 1.5;
    write_ffmpeg("while [ $# -gt 1 ]; do [ \"$1\" = -i ] && [ \"$2\" != pipe:0 ] && cp \"$2\" heard.wav; shift; done\n"
                 "cat > \"$1\"\n");
    const ProgramResult made = film(
        "data", { "--from", std::to_string(first - before), "--seconds", std::to_string(seconds), "-o", "a.mp4" });
    ASSERT_EQ(made.status, 0) << made.errors;
    EXPECT_NE(made.output.find("with sound"), std::string::npos) << made.output;
    EXPECT_EQ(folder.read("a.mp4").size(), size_t(seconds * 24) * 16 * 16 * 4);
    const Heard heard = read_heard(folder.read("heard.wav"));
    EXPECT_NEAR(heard.seconds(), seconds, max_lag);
    const std::vector<double> clicks = find_clicks(heard);
    ASSERT_GE(clicks.size(), 1u);
    EXPECT_NEAR(clicks[0], before, max_lag);
}

TEST_F(Recording, FilmsWithoutSoundsAreMadeAllTheSame)
{
    make_data("data", false);
    write_ffmpeg("for last; do :; done\necho \"$*\" > arguments.txt\ncat > \"$last\"\n");
    const ProgramResult made = film("data", { "--seconds", "1", "-o", "a.mp4" });
    ASSERT_EQ(made.status, 0) << made.errors;
    EXPECT_NE(made.errors.find("the film has no sound: nothing is heard"), std::string::npos) << made.errors;
    EXPECT_NE(made.output.find("without sound"), std::string::npos) << made.output;
    EXPECT_EQ(folder.read("arguments.txt").find("aac"), std::string::npos);
    EXPECT_EQ(folder.read("a.mp4").size(), 24u * 16 * 16 * 4);
    const ProgramResult silent = film("data", { "--seconds", "1", "--no-sound", "-o", "b.mp4" });
    EXPECT_EQ(silent.status, 0) << silent.errors;
    EXPECT_EQ(silent.errors.find("no sound"), std::string::npos) << silent.errors;
}

// With the real ffmpeg, where there is one: both streams last as long as the film.
TEST_F(Recording, FfmpegMakesBothStreams)
{
    if (std::system("ffprobe -version > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "ffmpeg is not installed";
    ASSERT_EQ(film(game_data, { "--from", "11", "--seconds", "2", "-o", "a.mp4" }).status, 0);
    ASSERT_EQ(std::system(("cd " + folder.path().string()
                  + " && ffprobe -v error -show_entries stream=codec_type,duration -of csv=p=0 a.mp4 > streams")
                              .c_str()),
        0);
    EXPECT_EQ(folder.read("streams"), "video,2.000000\naudio,2.000000\n");
}

} // namespace vkpt::tests

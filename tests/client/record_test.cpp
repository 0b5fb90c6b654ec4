// SPDX-License-Identifier: GPL-2.0-or-later
// ref_record.so as an engine of each release calls it, and its trace played by `vkpt` to a module that tells what it is
// asked.
#include "common/trace/trace_reader.hpp"
#include "tests/client/run_program.hpp"
#include "tests/contract/mock_engine.hpp"
#include "tests/formats/samples.hpp"

#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

namespace vkpt::tests {
namespace {

using trace::CallKind;

std::string to_text(const std::vector<std::byte>& bytes)
{
    return { reinterpret_cast<const char*>(bytes.data()), bytes.size() };
}

constexpr const char* entities = R"({ "classname" "worldspawn" })";

// The module with the struct of API 8, and an engine around it with a small map, a model and a picture.
class RecordModule {
public:
    explicit RecordModule(const std::filesystem::path& trace)
        : engine("8.70 test")
        , library_(dlopen(RECORD_MODULE, RTLD_NOW | RTLD_LOCAL))
    {
        if (!library_)
            throw std::runtime_error(dlerror());
        setenv("VKPT_TRACE", trace.c_str(), 1);
        formats::Bsp bsp = samples::make_bsp();
        bsp.entity_text = entities;
        engine.files["maps/sample.bsp"] = engine.files["maps/other.bsp"] = to_text(formats::write_bsp(bsp));
        engine.files["models/thing.md2"] = to_text(formats::write_md2(samples::make_md2()));
        engine.files["models/broken.md2"] = "IDP2 and no more";
        engine.files["pics/num_0.pcx"] = to_text(formats::write_pcx(samples::make_indexed_image(16, 24)));
        using GetRefApi = engine::Exports8 (*)(engine::Imports);
        api = reinterpret_cast<GetRefApi>(dlsym(library_, "GetRefAPI"))(engine.imports());
    }
    ~RecordModule()
    {
        dlclose(library_);
        unsetenv("VKPT_TRACE");
    }
    RecordModule(const RecordModule&) = delete;
    RecordModule& operator=(const RecordModule&) = delete;

    void draw(float time, void* model, void* skin)
    {
        engine::Entity entity {};
        entity.model = model;
        entity.skin = skin;
        entity.origin[0] = 8 * time;
        engine::RefDef refdef {};
        refdef.width = 800;
        refdef.height = 600;
        refdef.fov_x = 90;
        refdef.fov_y = 73.74f;
        refdef.time = time;
        refdef.view_origin[2] = 46;
        refdef.entity_count = 1;
        refdef.entities = &entity;
        api.begin_frame(0);
        api.render_frame(&refdef);
        api.draw_pic_scaled(10, 20, "num_0", 2);
        api.draw_char_scaled(30, 40, 'A', 1);
        api.draw_fill(0, 590, 800, 10, 7);
        api.end_frame();
    }

    MockEngine engine;
    engine::Exports8 api {};

private:
    void* library_;
};

void record_sample(const std::filesystem::path& trace)
{
    RecordModule module(trace);
    ASSERT_TRUE(module.api.init());
    module.api.begin_frame(0);
    module.api.draw_char_scaled(1, 2, '5', 1); // the console's clock
    module.api.end_frame();
    module.api.begin_registration("sample");
    void* const world = module.api.register_model("maps/sample.bsp");
    void* const door = module.api.register_model("*1");
    void* const thing = module.api.register_model("models/thing.md2");
    EXPECT_NE(world, nullptr);
    EXPECT_NE(thing, nullptr);
    EXPECT_EQ(door == nullptr, samples::make_bsp().models.size() < 2);
    EXPECT_EQ(module.api.register_model("models/missing.md2"), nullptr);
    EXPECT_EQ(module.api.register_model("models/broken.md2"), nullptr);
    EXPECT_EQ(module.api.register_model("models/thing.md2"), thing) << "a name keeps its handle";
    EXPECT_LT(world, thing) << "handles ascend: the engine sorts by them";
    const float axis[3] = { 0, 0, 1 };
    module.api.set_sky("unit1_", 2, axis);
    module.api.end_registration();
    int width = 0, height = 0;
    module.api.draw_get_pic_size(&width, &height, "num_0");
    EXPECT_EQ(width, 16);
    EXPECT_EQ(height, 24);
    module.api.draw_get_pic_size(&width, &height, "nothing");
    EXPECT_EQ(width, -1);
    EXPECT_NE(module.api.draw_find_pic("num_0"), nullptr);
    EXPECT_EQ(module.api.draw_find_pic("nothing"), nullptr);
    for (int i = 0; i < 3; i++)
        module.draw(1 + 0.1f * float(i), thing, nullptr);
    EXPECT_FALSE(module.api.is_vsync_active());
    module.api.shutdown();
    EXPECT_EQ(module.engine.files_out, 0);
}

TEST(Record, WritesWhatTheEngineAsked)
{
    const ScratchFolder folder;
    const auto path = folder.path() / "a.rtrace";
    record_sample(path);
    trace::TraceReader reader(path);
    EXPECT_EQ(reader.cut_at(), 0u);
    ASSERT_EQ(reader.frame_count(), 3u);
    const trace::Frame& frame = reader.frame(1);
    ASSERT_EQ(frame.calls.size(), 6u);
    EXPECT_EQ(frame.calls[2].name, "num_0");
    EXPECT_EQ(frame.calls[2].reals[0], 2);
    EXPECT_EQ(frame.calls[3].numbers[2], 'A');
    ASSERT_EQ(frame.views[0].entities.size(), 1u);
    EXPECT_EQ(frame.views[0].entities[0].entity.origin[0], 8 * 1.1f);
    // The handle of the view is the one that was given out for the model.
    uint32_t thing = 0;
    for (const trace::LastingCall& lasting : reader.lasting_calls())
        if (lasting.call.name == "models/thing.md2")
            thing = uint32_t(lasting.call.numbers[0]);
    EXPECT_NE(thing, 0u);
    EXPECT_EQ(frame.views[0].entities[0].model, thing);
    std::vector<std::string> files;
    for (const trace::Call& call : reader.facts())
        if (call.kind == CallKind::file)
            files.push_back(call.name);
    for (const char* name : { "maps/sample.bsp", "models/thing.md2", "pics/num_0.pcx" })
        EXPECT_EQ(std::count(files.begin(), files.end(), name), 1) << name;
}

TEST(Record, NotesWhatStandsForAModel)
{
    const ScratchFolder folder;
    const auto path = folder.path() / "a.rtrace";
    {
        RecordModule module(path);
        for (const char* name : { "models/both.md2", "models/damaged.md2" })
            module.engine.files[name] = to_text(formats::write_md2(samples::make_md2()));
        for (const char* name : { "models/both.md3", "models/alone.md3" })
            module.engine.files[name] = to_text(formats::write_md3(samples::make_md3()));
        for (const char* name : { "models/arm.iqm", "models/both.iqm" })
            module.engine.files[name] = to_text(formats::write_iqm(samples::make_iqm()));
        module.engine.files["models/damaged.md3"] = "IDP3 and no more";
        ASSERT_TRUE(module.api.init());
        module.api.begin_registration("sample");
        void* both = module.api.register_model("models/both.md2");
        for (const char* name : { "models/both.md2", "models/alone.md2", "models/arm.md2", "models/damaged.md2" })
            EXPECT_NE(module.api.register_model(name), nullptr) << name;
        module.api.end_registration();
        module.draw(1, both, nullptr);
        module.api.shutdown();
    }
    std::set<std::string> files;
    trace::TraceReader reader(path);
    for (const trace::Call& call : reader.facts())
        if (call.kind == CallKind::file)
            files.insert(call.name);
    for (const char* name :
        { "models/both.md2", "models/both.md3", "models/alone.md3", "models/arm.iqm", "models/damaged.md2" })
        EXPECT_TRUE(files.contains(name)) << name;
    EXPECT_FALSE(files.contains("models/both.iqm")) << "the MD3 is shown";
}

// What comes before the first 3D view: whole frames of 2D show the engine's console and are left out, what is drawn in
// the view's own frame is not.
TEST(Record, KeepsAllOfTheFirstViewsFrame)
{
    const ScratchFolder folder;
    {
        RecordModule module(folder.path() / "a.rtrace");
        ASSERT_TRUE(module.api.init());
        const auto draw_console = [&] {
            module.api.begin_frame(0);
            module.api.draw_char_scaled(1, 2, '5', 1);
            module.api.end_frame();
        };
        draw_console();
        module.api.begin_frame(0);
        module.api.draw_tile_clear(0, 0, 800, 20, "backtile");
        engine::RefDef refdef {};
        module.api.render_frame(&refdef);
        module.api.end_frame();
        draw_console();
        module.api.shutdown();
    }
    trace::TraceReader reader(folder.path() / "a.rtrace");
    EXPECT_EQ(reader.totals().frames, 3u);
    ASSERT_EQ(reader.frame_count(), 1u);
    std::vector<CallKind> kinds;
    for (const trace::Call& call : reader.frame(0).calls)
        kinds.push_back(call.kind);
    EXPECT_EQ(kinds,
        (std::vector<CallKind> {
            CallKind::begin_frame, CallKind::draw_tiled, CallKind::render_view, CallKind::end_frame }));
    // begin and end of three frames, the screen and the settings, a tile, a view and the last console's character
    EXPECT_EQ(
        reader.totals().calls - uint32_t(reader.facts().size()), 6u + trace::recorded_settings.size() + 1 + 1 + 1);
}

TEST(Record, RefusesWithoutAFileAndEndsTheEngineOnAFullDisk)
{
    const ScratchFolder folder;
    {
        RecordModule module(folder.path() / "no folder" / "a.rtrace");
        EXPECT_FALSE(module.api.init());
        EXPECT_EQ(module.engine.lines_with("No such file").size(), 1u);
    }
    {
        RecordModule module("/dev/full");
        ASSERT_FALSE(module.api.init()) << "the header cannot be written";
        EXPECT_EQ(module.engine.lines_with("No space left").size(), 1u);
    }
    RecordModule module("");
    EXPECT_FALSE(module.api.init());
    EXPECT_EQ(module.engine.lines_with("VKPT_TRACE").size(), 1u);
}

class Replay : public testing::Test {
protected:
    Replay()
    {
        write_sample_map(folder, "sample", entities);
        record_sample(folder.path() / "a.rtrace");
        folder.write("baseq2/models/thing.md2", to_text(formats::write_md2(samples::make_md2())));
        folder.write("baseq2/pics/num_0.pcx", to_text(formats::write_pcx(samples::make_indexed_image(16, 24))));
    }
    ProgramResult run(const std::vector<std::string>& arguments) const
    {
        return run_program(VKPT_PROGRAM, arguments, folder.path(),
            { std::string("VKPT_MODULE=") + FAKE_MODULE, "XDG_CACHE_HOME=" + (folder.path() / "cache").string() });
    }
    static std::string calls_of(const ProgramResult& result)
    {
        std::istringstream lines(result.errors);
        std::string calls;
        for (std::string line; std::getline(lines, line);)
            if (line.starts_with("call "))
                calls += line.substr(5) + "\n";
        return calls;
    }

    ScratchFolder folder;
};

constexpr const char* registration = "init\nprepare_for_window\ninit_context false\nbegin_registration sample\n"
                                     "register_model maps/sample.bsp\nregister_model *1\n"
                                     "register_model models/thing.md2\nregister_model models/missing.md2\n"
                                     "register_model models/broken.md2\nregister_model models/thing.md2\n"
                                     "set_sky unit1_ 2 0 0 1\nend_registration\n";
constexpr const char* frame_at_full_size = "begin_frame 0\nrender_view 800 600 0 0 46 0 0 1\n"
                                           "draw_pic 10 20 num_0 2 -1\ndraw_character 30 40 65 1\n"
                                           "draw_fill 0 590 800 10 7\nend_frame\n";

TEST_F(Replay, AsksTheModuleWhatTheEngineAsked)
{
    const ProgramResult result
        = run({ "render", "a.rtrace", "--size", "800x600", "--frames", "2", "--verbose", "-o", "a.png" });
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(calls_of(result), std::string(registration) + frame_at_full_size + frame_at_full_size + "shutdown\n");
}

TEST_F(Replay, FitsAnotherSize)
{
    const ProgramResult result
        = run({ "render", "a.rtrace@2", "--size", "400x300", "--spp", "1", "--verbose", "-o", "a.png" });
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(calls_of(result),
        std::string(registration)
            + "begin_frame 0\nrender_view 400 300 0 0 46 0 0 1\ndraw_pic 5 10 num_0 1 -1\n"
              "draw_character 15 20 65 0.5\ndraw_fill 0 295 400 5 7\nend_frame\nshutdown\n");
}

// From one map to another and back, with a model that only one of them has.
TEST_F(Replay, FollowsTheEngineToOtherMaps)
{
    write_sample_map(folder, "other", entities);
    {
        RecordModule module(folder.path() / "maps.rtrace");
        ASSERT_TRUE(module.api.init());
        for (const std::string map : { "sample", "other", "sample" }) {
            module.api.begin_registration(map.c_str());
            void* const thing = map == "sample" ? module.api.register_model("models/thing.md2") : nullptr;
            module.api.register_model(("maps/" + map + ".bsp").c_str());
            module.api.end_registration();
            module.api.begin_frame(0); // the loading plaque
            module.api.draw_char_scaled(1, 2, 'L', 1);
            module.api.end_frame();
            module.draw(1, thing, nullptr);
            module.draw(1.1f, thing, nullptr);
        }
        module.api.shutdown();
    }
    const std::string start = "init\nprepare_for_window\ninit_context false\n",
                      sample = "begin_registration sample\nregister_model models/thing.md2\n"
                               "register_model maps/sample.bsp\nend_registration\n",
                      other = "begin_registration other\nregister_model maps/other.bsp\nend_registration\n",
                      two = std::string(frame_at_full_size) + frame_at_full_size;
    const auto replay = [&](const std::string& frame, const std::string& frames) {
        const ProgramResult result = run(
            { "render", "maps.rtrace@" + frame, "--size", "800x600", "--frames", frames, "--verbose", "-o", "a.png" });
        EXPECT_EQ(result.status, 0) << result.errors;
        return calls_of(result);
    };
    EXPECT_EQ(replay("0", "6"), start + sample + two + other + two + sample + two + "shutdown\n");
    EXPECT_EQ(replay("3", "2"), start + other + frame_at_full_size + sample + frame_at_full_size + "shutdown\n");
    const nlohmann::json info = nlohmann::json::parse(run({ "info", "maps.rtrace", "--json" }).output);
    ASSERT_EQ(info.at("maps").size(), 3u);
    EXPECT_EQ(info.at("maps").at(1).at("map"), "other");
    EXPECT_EQ(info.at("maps").at(1).at("frame"), 2);
    EXPECT_NEAR(info.at("seconds"), 0.3, 1e-6) << "each map has a clock of its own";
}

// Runs `vkpt record` with a program in the engine's place: what matters is around it.
class RecordCommand : public Replay {
protected:
    RecordCommand()
    {
        using namespace std::filesystem;
        folder.write("a.dm2", std::string("\x04\0\0\0demo\xff\xff\xff\xff", 12));
        folder.write("baseq2/sample.rtrace", folder.read("a.rtrace"));
        create_directory(folder.path() / "tmp");
    }
    void write_engine(const std::string& script)
    {
        folder.write("engine", "#!/bin/sh\n" + script);
        std::filesystem::permissions(folder.path() / "engine", std::filesystem::perms(0755));
    }
    std::vector<std::string> words() const
    {
        return { VKPT_PROGRAM, "record", "a.dm2", "-o", "b.rtrace", "--basedir", folder.path().string(), "--engine",
            (folder.path() / "engine").string() };
    }
};

// The engine refuses to run as root; the user that takes its place cannot look into root's folders.
TEST_F(RecordCommand, DataThatTheEnginesUserCannotReadIsCopied)
{
    write_engine("cp \"$2/baseq2/sample.rtrace\" \"$VKPT_TRACE\"\n"); // -datadir DIR
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0700));
    const std::vector<std::string> all = words();
    const ProgramResult result = run({ all.begin() + 1, all.end() });
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(folder.read("b.rtrace"), folder.read("a.rtrace"));
}

TEST_F(RecordCommand, LeavesNothingBehindHoweverItEnds)
{
    namespace fs = std::filesystem;
    write_engine("touch \"$HOME/started\"\nexec sleep 100000\n");
    fs::permissions(folder.path(), fs::perms(0755)); // so that the engine's user reaches its folder in tmp
    const auto has_started = [&] {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder.path() / "tmp"))
            if (fs::exists(entry.path() / "home/started"))
                return true;
        return false;
    };
    for (const int signal : { SIGINT, SIGTERM, SIGHUP, SIGKILL }) {
        const pid_t child = fork();
        if (child == 0) {
            std::vector<std::string> texts = words();
            std::vector<char*> arguments;
            for (std::string& text : texts)
                arguments.push_back(text.data());
            arguments.push_back(nullptr);
            setenv("TMPDIR", (folder.path() / "tmp").c_str(), 1);
            if (chdir(folder.path().c_str()) == 0)
                execv(VKPT_PROGRAM, arguments.data());
            _exit(127);
        }
        int status = 0;
        while (!has_started() && waitpid(child, &status, WNOHANG) == 0)
            usleep(10'000);
        ASSERT_TRUE(has_started());
        kill(child, signal);
        waitpid(child, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status));
        EXPECT_EQ(WTERMSIG(status), signal);
        while (!fs::is_empty(folder.path() / "tmp")) // the test's own limit ends it
            usleep(10'000);
        for (const std::string& name : folder.names())
            if (signal != SIGKILL) { // which nobody can listen to
                EXPECT_FALSE(name.ends_with(".part")) << name;
            }
    }
}

TEST_F(Replay, TellsOfOtherFiles)
{
    folder.write("baseq2/pics/num_0.pcx", to_text(formats::write_pcx(samples::make_indexed_image(8, 8))));
    const ProgramResult changed = run({ "render", "a.rtrace", "--spp", "1", "-o", "a.png" });
    EXPECT_EQ(changed.status, 0);
    EXPECT_NE(changed.errors.find("pics/num_0.pcx (another)"), std::string::npos) << changed.errors;
    std::filesystem::remove(folder.path() / "baseq2/maps/sample.bsp");
    const ProgramResult missing = run({ "render", "a.rtrace", "--spp", "1", "-o", "b.png" });
    EXPECT_EQ(missing.status, 1);
    EXPECT_NE(missing.errors.find("maps/sample.bsp"), std::string::npos) << missing.errors;
    EXPECT_NE(missing.errors.find("--basedir"), std::string::npos) << missing.errors;
}

TEST_F(Replay, BadScenesAreToldApart)
{
    EXPECT_EQ(run({ "render", "a.rtrace@x", "-o", "a.png" }).status, 2);
    EXPECT_EQ(run({ "render", "a.rtrace@3", "-o", "a.png" }).status, 2);
    EXPECT_EQ(run({ "render", "a.rtrace", "--frames", "4", "-o", "a.png" }).status, 2);
    EXPECT_EQ(run({ "render", "none.rtrace", "-o", "a.png" }).status, 1);
    const std::string whole = folder.read("a.rtrace");
    folder.write("cut.rtrace", whole.substr(0, 40));
    const ProgramResult cut = run({ "render", "cut.rtrace", "-o", "a.png" });
    EXPECT_EQ(cut.status, 1);
    EXPECT_NE(cut.errors.find("cut off at byte"), std::string::npos) << cut.errors;
    folder.write("damaged.rtrace", whole.substr(0, 60) + "oops" + whole.substr(64));
    const ProgramResult damaged = run({ "info", "damaged.rtrace" });
    EXPECT_EQ(damaged.status, 1);
    EXPECT_NE(damaged.errors.find("damaged"), std::string::npos) << damaged.errors;
}

TEST_F(Replay, InfoTellsWhatATraceHolds)
{
    const ProgramResult result = run({ "info", "a.rtrace", "--json" });
    ASSERT_EQ(result.status, 0) << result.errors;
    const nlohmann::json info = nlohmann::json::parse(result.output);
    EXPECT_EQ(info.at("schema"), 1);
    EXPECT_EQ(info.at("frames"), 3);
    EXPECT_EQ(info.at("whole"), true);
    EXPECT_EQ(info.at("maps").at(0).at("map"), "sample");
    EXPECT_EQ(info.at("facts").at("version"), "8.70 test");
    EXPECT_NE(run({ "info", "a.rtrace" }).output.find("3 in 0.2 s"), std::string::npos);
}

TEST_F(Replay, BenchMeasuresATrace)
{
    const ProgramResult result = run({ "bench", "a.rtrace", "--size", "800x600", "--json", "b.json" });
    ASSERT_EQ(result.status, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(folder.read("b.json"));
    EXPECT_EQ(json.at("frames"), 3);
    EXPECT_EQ(json.at("passes").at(0).at("name"), "rays");
    EXPECT_EQ(json.at("passes").at(0).at("median_ms"), 2);
    EXPECT_EQ(json.at("cpu").at(0).at("name"), "scene");
    EXPECT_EQ(json.at("rays_per_frame"), 8);
}

} // namespace
} // namespace vkpt::tests

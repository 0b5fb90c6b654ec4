// SPDX-License-Identifier: GPL-2.0-or-later
// What a demo has the client run: it may set any console variable, and the module writes files.
#include "common/read_text.hpp"
#include "tests/engine/engine_run.hpp"
#include "tests/engine/picture_statistics.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

namespace vkpt::tests {

namespace {

constexpr size_t messages_until_the_game = 12; // of our demo

std::string with_length(const std::string& message)
{
    const auto length = int32_t(message.size());
    std::string bytes(sizeof length, '\0');
    std::memcpy(bytes.data(), &length, sizeof length);
    return bytes + message;
}

// Our demo with console commands among its messages, as a server sends them.
std::string make_demo(const std::string& commands)
{
    constexpr char stuff_text = 11;
    const std::string demo = read_text(std::string(VKPT_TEST_BUILD_DIR) + "/game/baseq2/demos/" + own_demo);
    size_t at = 0;
    int32_t length = 0;
    for (size_t i = 0; i < messages_until_the_game && at + sizeof length <= demo.size(); i++) {
        std::memcpy(&length, demo.data() + at, sizeof length);
        at += sizeof length + size_t(length);
    }
    return demo.substr(0, at) + with_length(stuff_text + commands + '\0') + demo.substr(at);
}

// Everything in the writable game folder, links too.
std::set<std::string> list_files(const EngineRun& run)
{
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(run.result().game_folder))
        if (!entry.is_directory())
            names.insert(entry.path().lexically_relative(run.result().game_folder).string());
    return names;
}

EngineOptions play(const std::string& commands)
{
    EngineOptions options;
    options.width = 96;
    options.height = 64;
    options.validation = false;
    options.files["demos/evil.dm2"] = make_demo(commands);
    options.files["victim.cfg"] = "bind x quit\n";
    options.files["vkpt/bench/victim.json"] = "{ \"mine\": 1 }\n";
    options.arguments
        = { "+set", "timedemo", "1", "+set", "cl_predict", "0", "+set", "nextdemo", "quit", "+demomap", "evil.dm2" };
    options.cpu_seconds = 600;
    return options;
}

void expect_nothing_foreign_touched(const EngineRun& run)
{
    EXPECT_EQ(read_text(run.result().game_folder / "victim.cfg"), "bind x quit\n");
    EXPECT_EQ(read_text(run.result().game_folder / "vkpt/bench/victim.json"), "{ \"mine\": 1 }\n");
    const std::set<std::string> known { "autoexec.cfg", "config.cfg", "demos/evil.dm2", "qconsole.log", "test.cfg",
        "victim.cfg", "vkpt/bench/victim.json" };
    for (const std::string& name : list_files(run))
        EXPECT_TRUE(known.contains(name) || name.starts_with("vkpt/captures/")) << name << " was written";
}

} // namespace

TEST(Engine, ServersCannotChooseWhatIsWritten)
{
    std::string commands = "pt_times 1\nset pt_capture_every 1\n";
    for (const char* name : { "victim", "victim.cfg", "pak9.pak", "../pak9.pak", "maps/x" })
        for (const char* more : { "", " u" }) // the second one goes past CVAR_NOSET
            commands += std::string("set pt_bench_json ") + name + more + "\nset pt_capture_dir " + name + more
                + "\npt_times_print\n";
    const EngineRun run(play(commands));
    run.expect_clean();
    EXPECT_FALSE(run.lines_with("write protected").empty()) << "the engine knows them as protected";
    EXPECT_FALSE(run.lines_with("pt_capture_dir is empty").empty()) << "the commands have run";
    expect_nothing_foreign_touched(run);
    EXPECT_FALSE(std::filesystem::exists(run.result().game_folder / "vkpt/captures"));
}

// Started anew the module reads what the server has written, and keeps it among the captures.
TEST(Engine, RestartsHelpServersNoFurther)
{
    constexpr int frames = 150; // together more than 1 MiB
    std::string commands = "pt_times 1\nset pt_capture_every 1\nset pt_bench_json victim u\nset pt_capture_dir maps u\n"
                           "set pt_capture_mib 0 u\nvid_restart\n";
    for (int i = 0; i < frames; i++)
        commands += "wait;";
    // By itself the engine does not end at the end of a demo that the renderer was restarted in.
    const EngineRun run(play(commands + "\npt_times_print\nquit\n"));
    run.expect_clean();
    expect_nothing_foreign_touched(run);
    EXPECT_FALSE(run.lines_with("victim.json: something that the module did not write is there").empty())
        << run.result().console;
    EXPECT_FALSE(run.lines_with("may take 1 MiB").empty()) << run.result().console;
    uintmax_t bytes = 0;
    for (const auto& picture : list_pictures(run.result().game_folder / "vkpt/captures/maps"))
        bytes += std::filesystem::file_size(picture);
    EXPECT_GT(bytes, 0u);
    EXPECT_LE(bytes, 1u << 20);
}

} // namespace vkpt::tests

// SPDX-License-Identifier: GPL-2.0-or-later
// `vkpt view` as a user runs it: a window on a virtual display, keys pressed, pictures written. What it shows is told
// by the window's title and by what it saves.
#include "formats/image.hpp"
#include "tests/client/run_program.hpp"
#include "tests/runner/process_tree.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <functional>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

namespace vkpt::tests {
namespace {

constexpr const char* sample_entities = R"({ "classname" "worldspawn" "sky" "desert" }
{ "classname" "info_player_start" "origin" "-8 4 24" "angle" "90" })";

// Until the condition holds, or this program and its children have taken so much CPU time meanwhile.
bool wait_for(double cpu_seconds, const std::function<bool()>& condition)
{
    const double end = measure_cpu_seconds(getpid()) + cpu_seconds;
    while (!condition()) {
        if (measure_cpu_seconds(getpid()) > end)
            return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return true;
}

// A child that ends with its owner.
class Child {
public:
    Child() = default;
    explicit Child(pid_t process)
        : process_(process)
    {
    }
    Child(Child&& other) noexcept
        : process_(std::exchange(other.process_, -1))
    {
    }
    Child& operator=(Child&& other) noexcept
    {
        std::swap(process_, other.process_);
        return *this;
    }
    ~Child()
    {
        if (process_ <= 0)
            return;
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    // The exit status; -1: it still runs after so much CPU time, or a signal ended it.
    int wait(double cpu_seconds)
    {
        int status = 0;
        if (!wait_for(cpu_seconds, [&] { return waitpid(process_, &status, WNOHANG) == process_; }))
            return -1;
        process_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    pid_t process_ = -1;
};

class ViewWindow : public testing::Test {
protected:
    ViewWindow()
    {
        write_sample_map(folder, "sample", sample_entities);
        start_display();
    }

    // Its number comes from the server itself, so that tests that run at once do not meet.
    void start_display()
    {
        int number[2];
        ASSERT_EQ(pipe(number), 0);
        const pid_t child = fork();
        if (child == 0) {
            const int nothing = open("/dev/null", O_RDWR);
            dup2(nothing, 1);
            dup2(nothing, 2);
            const std::string descriptor = std::to_string(number[1]);
            execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", "1280x960x24", "-nolisten", "tcp",
                "-noreset", "-r", nullptr);
            _exit(127);
        }
        xvfb = Child(child);
        close(number[1]);
        char text[16] = {};
        const ssize_t length = read(number[0], text, sizeof text - 1);
        close(number[0]);
        ASSERT_GT(length, 0) << "Xvfb did not start (package xvfb)";
        display.assign(1, ':').append(text, std::strcspn(text, "\n"));
    }

    void start(const std::string& module, std::vector<std::string> arguments, const std::string& cache)
    {
        std::vector<std::string> words { VKPT_PROGRAM, "view" };
        words.insert(words.end(), arguments.begin(), arguments.end());
        const std::string log = (folder.path() / "log.txt").string();
        const pid_t child = fork();
        if (child == 0) {
            setenv("DISPLAY", display.c_str(), 1);
            setenv("SDL_VIDEODRIVER", "x11", 1);
            setenv("VKPT_MODULE", module.c_str(), 1);
            setenv("XDG_CACHE_HOME", cache.c_str(), 1);
            const int output = open(log.c_str(), O_CREAT | O_WRONLY, 0600);
            dup2(output, 1);
            dup2(output, 2);
            std::vector<char*> pointers;
            for (std::string& word : words)
                pointers.push_back(word.data());
            pointers.push_back(nullptr);
            if (chdir(folder.path().c_str()) == 0)
                execv(VKPT_PROGRAM, pointers.data());
            _exit(127);
        }
        program = Child(child);
    }

    std::string ask_display(const std::string& command) const
    {
        // A key that ends the program is not yet released then: xdotool may find no window and say so.
        const std::string line
            = "DISPLAY=" + display + " xdotool " + command + " 2>>'" + (folder.path() / "xdotool.txt").string() + "'";
        FILE* pipe = popen(line.c_str(), "r");
        std::string answer;
        for (char part[256]; pipe && fgets(part, sizeof part, pipe);)
            answer += part;
        if (pipe)
            pclose(pipe);
        return answer;
    }
    void press(const std::string& keys) const
    {
        ask_display("search --name '^vkpt view' windowfocus --sync key --delay 60 " + keys);
    }
    std::string title() const { return ask_display("search --name '^vkpt view' getwindowname"); }
    void expect_title(const std::string& part)
    {
        EXPECT_TRUE(wait_for(60, [&] { return title().find(part) != std::string::npos; }))
            << "\"" << part << "\" is not in \"" << title() << "\"\n"
            << messages();
    }
    // Of the program and of who presses its keys, for failures.
    std::string messages() const
    {
        return folder.read("log.txt") + (has_file("xdotool.txt") ? "xdotool: " + folder.read("xdotool.txt") : "");
    }
    bool has_file(const std::string& name) const { return std::filesystem::exists(folder.path() / name); }
    formats::Image load(const std::string& name) const
    {
        const std::string file = folder.read(name);
        return formats::read_common_image({ reinterpret_cast<const std::byte*>(file.data()), file.size() }, name);
    }
    // A picture can be saved as soon as there is one: the key is pressed until it is.
    bool save_picture(const std::string& name, double cpu_seconds) const
    {
        const double end = measure_cpu_seconds(getpid()) + cpu_seconds;
        for (int look = 0; !has_file(name); look++) {
            if (look % 10 == 0)
                press("o");
            if (measure_cpu_seconds(getpid()) > end)
                return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        return true;
    }

    ScratchFolder folder;
    std::string display;
    Child xvfb, program;
};

TEST_F(ViewWindow, KeysSwitchSplitSaveAndLeave)
{
    start(FAKE_MODULE, { "maps/sample.bsp", "--size", "320x200" }, (folder.path() / "cache").string());
    expect_title("A: subset_pps  R 8  asvgf");
    press("l");
    expect_title("A: uniform");
    press("shift+l r shift+n");
    expect_title("A: subset_pps  R 16  svgf");
    press("x l");
    expect_title("| B: uniform");
    press("b");
    expect_title("pt_bounces 2");
    press("p m space Tab Tab F1");
    ASSERT_TRUE(save_picture("vkpt-view-001.png", 60)) << messages();
    const formats::Image picture = load("vkpt-view-001.png");
    ASSERT_EQ(picture.width, 320);
    ASSERT_EQ(picture.height, 200);
    EXPECT_EQ(picture.at(3, 1), (formats::Rgba8 { 13, 113, 213, 255 })) << "the module's gradient";
    EXPECT_EQ(picture.at(160, 40), (formats::Rgba8 { 255, 255, 255, 255 })) << "the divider";
    press("shift+o");
    EXPECT_TRUE(wait_for(60, [&] { return has_file("vkpt-window-001.png"); }));
    EXPECT_GT(load("vkpt-window-001.png").width, 320) << "picture and panel";
    press("Escape"); // the help
    press("Escape");
    EXPECT_EQ(program.wait(60), 0) << messages();
}

TEST_F(ViewWindow, ModuleThatFailsEndsWithItsWords)
{
    start(FAKE_MODULE, { "maps/sample.bsp", "--size", "64x64", "--set", "fake_throw=render_view fatal" },
        (folder.path() / "cache").string());
    EXPECT_EQ(program.wait(60), 1);
    EXPECT_NE(folder.read("log.txt").find("the device is lost"), std::string::npos) << messages();
}

#ifdef REAL_MODULE
TEST_F(ViewWindow, RealModuleComparesAndInspects)
{
    start(REAL_MODULE, { "maps/sample.bsp", "--size", "64x48", "--b", "pt_bounces=0", "--set", "pt_validation=1" },
        VKPT_TEST_CACHE);
    ASSERT_TRUE(save_picture("vkpt-view-001.png", 300)) << messages();
    expect_title("pt_bounces 0");
    press("p m");
    press("2 v");
    expect_title("pt_debug_view albedo");
    EXPECT_TRUE(save_picture("vkpt-view-002.png", 60)) << messages();
    press("ctrl+q");
    EXPECT_EQ(program.wait(60), 0) << messages();
    EXPECT_EQ(folder.read("log.txt").find("vkpt validation:"), std::string::npos) << messages();
}
#endif

class ViewCommand : public testing::Test {
protected:
    ViewCommand() { write_sample_map(folder, "sample", sample_entities); }
    ProgramResult run(std::vector<std::string> arguments) const
    {
        arguments.insert(arguments.begin(), "view");
        return run_program(VKPT_PROGRAM, arguments, folder.path(),
            { std::string("VKPT_MODULE=") + FAKE_MODULE, "XDG_CACHE_HOME=" + (folder.path() / "cache").string(),
                "DISPLAY=:59999", "SDL_VIDEODRIVER=x11" });
    }
    ScratchFolder folder;
};

TEST_F(ViewCommand, WithoutADisplaySaysWhatToDo)
{
    const ProgramResult result = run({ "maps/sample.bsp" });
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.errors.find("display"), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("vkpt render"), std::string::npos) << result.errors;
}

TEST_F(ViewCommand, BadInputIsToldBeforeAWindowOpens)
{
    const ProgramResult missing = run({ "maps/nothing.bsp" });
    EXPECT_EQ(missing.status, 1);
    EXPECT_NE(missing.errors.find("no map maps/nothing.bsp"), std::string::npos) << missing.errors;
    EXPECT_EQ(run({ "maps/sample.bsp@1,2" }).status, 2);
    EXPECT_EQ(run({ "maps/sample.bsp", "--size", "0x9" }).status, 2);
    EXPECT_EQ(run({ "maps/sample.bsp", "--b", "pt_bounces" }).status, 2);
    const ProgramResult fixed = run({ "maps/sample.bsp", "--b", "pt_device=x" });
    EXPECT_EQ(fixed.status, 2);
    EXPECT_NE(fixed.errors.find("pt_device"), std::string::npos) << fixed.errors;
    const ProgramResult help = run({ "--help" });
    EXPECT_EQ(help.status, 0);
    EXPECT_NE(help.output.find("Examples:"), std::string::npos);
}

} // namespace
} // namespace vkpt::tests

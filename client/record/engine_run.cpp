// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/record/engine_run.hpp"

#include "client/host/companions.hpp"
#include "client/host/errors.hpp"
#include "common/read_text.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <grp.h>
#include <pwd.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace vkpt::client {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

namespace {

constexpr auto poll_interval = 20ms;
constexpr auto patience = 60s; // with an engine that records nothing more
constexpr auto grace = 2s; // between asking it to end and killing it

fs::path find_engine(const fs::path& wanted)
{
    std::vector<fs::path> places { wanted };
    if (wanted.empty()) {
        const char* named = std::getenv("VKPT_ENGINE");
        places = { named ? named : "", "/usr/lib/yamagi-quake2/quake2", "/usr/lib/games/quake2/quake2",
            "/usr/games/yquake2", "/usr/lib/yquake2/quake2" };
    }
    std::string looked;
    for (const fs::path& place : places) {
        if (place.empty())
            continue;
        if (fs::is_regular_file(place) && access(place.c_str(), X_OK) == 0)
            return fs::canonical(place);
        looked += "\n  " + place.string();
    }
    throw Failure("no Yamagi Quake II found; looked for" + looked
        + "\nInstall the package yamagi-quake2, or name the program with --engine PATH.");
}

// What the engine runs with.
constexpr const char *record_module = "ref_record.so", *clock_library = "recording_clock.so",
                     *sound_library = "recording_sound.so";

std::string last_lines(const std::string& text, int count)
{
    size_t at = text.find_last_not_of('\n');
    const size_t end = at == std::string::npos ? 0 : at + 1;
    for (at = end; count > 0 && at != std::string::npos && at > 0; count--)
        at = text.rfind('\n', at - 1);
    return text.substr(at == std::string::npos ? 0 : at, end - (at == std::string::npos ? 0 : at));
}

// The line that tells why the engine will not go on by itself; "": none.
std::string find_error(const std::string& console)
{
    for (const char* sign : { "ERROR: ", "ref_record: cannot", "ref_record: one run", "Retrying with" }) {
        const size_t at = console.find(sign);
        if (at == std::string::npos || (at > 0 && console[at - 1] != '\n'))
            continue;
        return console.substr(at, console.find('\n', at) - at);
    }
    return "";
}

bool become(unsigned user, unsigned group)
{
    return setgroups(0, nullptr) == 0 && setresgid(group, group, group) == 0 && setresuid(user, user, user) == 0;
}

int end_process(int process)
{
    int status = 0;
    kill(process, SIGTERM);
    for (auto waited = 0ms; waited < grace; waited += poll_interval) {
        if (waitpid(process, &status, WNOHANG) == process)
            return status;
        std::this_thread::sleep_for(poll_interval);
    }
    kill(process, SIGKILL);
    waitpid(process, &status, 0);
    return status;
}

// The engine takes no more than 50 words on its command line; the rest goes through a file that it reads first.
std::string make_settings(const EngineRunOptions& options)
{
    std::string text;
    const auto set
        = [&](std::string_view name, std::string_view value) { text += fmt::format("set {} \"{}\"\n", name, value); };
    set("allow_download", "0"); // it would ask itself for every missing file
    set("s_openal", "0");
    set("s_sdldriver", "dummy");
    set("vid_fullscreen", "0");
    set("cl_predict", "0"); // a demo has no commands of the player's to predict from
    set("busywait", "0"); // it waits for the clock
    set("nextdemo", "quit");
    set("record_demo", options.demo);
    for (const auto& [name, value] : options.settings)
        set(name, value);
    return text;
}

} // namespace

EngineRun::EngineRun(const EngineRunOptions& options)
    : temporary_folder_("vkpt-record-")
    , folder_(temporary_folder_.path())
    , data_(fs::absolute(options.data_folder))
    , engine_(find_engine(options.engine))
{
    choose_user();
    try {
        make_folder(options);
        watch(start(options), options);
    } catch (const fs::filesystem_error& error) {
        throw Failure(
            fmt::format("cannot prepare the engine's folder: {}; set $TMPDIR to use another place", error.what()));
    }
}

// The engine refuses to run as root: whoever called sudo plays, or nobody.
void EngineRun::choose_user()
{
    user_ = { getuid(), getgid() };
    changes_user_ = user_.id == 0;
    if (!changes_user_)
        return;
    const char *sudo_user = std::getenv("SUDO_UID"), *sudo_group = std::getenv("SUDO_GID");
    user_.id = sudo_user ? unsigned(std::strtoul(sudo_user, nullptr, 10)) : 0;
    user_.group = sudo_group ? unsigned(std::strtoul(sudo_group, nullptr, 10)) : 0;
    if (user_.id != 0)
        return;
    const passwd* nobody = getpwnam("nobody");
    if (!nobody)
        throw Failure("the engine refuses to run as root, and there is no user \"nobody\": record as an ordinary user");
    user_ = { nobody->pw_uid, nobody->pw_gid };
}

bool EngineRun::can_user_read(const fs::path& path) const
{
    if (!changes_user_)
        return true;
    const pid_t child = fork();
    if (child == 0)
        _exit(become(user_.id, user_.group) && access(path.c_str(), R_OK | X_OK) == 0 ? 0 : 1);
    int status = 1;
    waitpid(child, &status, 0);
    return status == 0;
}

// The engine opens its modules and games beside its own executable, after symbolic links: so a copy, and links around
// it.
void EngineRun::make_folder(const EngineRunOptions& options)
{
    fs::permissions(folder_, fs::perms(0755));
    if (!can_user_read(folder_))
        throw Failure(fmt::format("the engine refuses to run as root, and user {} cannot reach {}; set $TMPDIR to "
                                  "another place",
            user_.id, folder_.string()));
    home_ = folder_ / "home";
    trace_ = home_ / "out.rtrace";
    sound_ = home_ / "out.sound";
    fs::copy_file(engine_, folder_ / "quake2");
    fs::permissions(folder_ / "quake2", fs::perms(0755));
    for (const char* file : { record_module, clock_library, sound_library })
        fs::copy_file(find_companion(file, "Build the target vkpt, or reinstall."), folder_ / file);
    for (const std::string& game : { std::string("baseq2"), options.game }) {
        if (game.empty() || fs::exists(folder_ / game))
            continue;
        fs::create_directory(folder_ / game);
        const fs::path own = engine_.parent_path() / game / "game.so", stock = engine_.parent_path() / "baseq2/game.so";
        if (!fs::exists(data_ / game / "game.so"))
            fs::create_symlink(fs::exists(own) ? own : stock, folder_ / game / "game.so");
    }
    if (!can_user_read(data_ / "baseq2")) {
        const fs::path copy = folder_ / "data";
        fs::create_directory(copy);
        for (const std::string& game : { std::string("baseq2"), options.game })
            if (!game.empty())
                fs::copy(data_ / game, copy / game, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
        data_ = copy;
    }
    write_files(options);
}

void EngineRun::write_files(const EngineRunOptions& options) const
{
    const fs::path game = home_ / ".yq2" / (options.game.empty() ? "baseq2" : options.game);
    fs::create_directories(game / "demos");
    fs::create_directories(home_ / ".local/share"); // 8.70 gives up without
    std::ofstream(game / "autoexec.cfg") << make_settings(options);
    if (!options.demo_file.empty())
        std::ofstream(game / "demos" / options.demo, std::ios::binary)
            .write(reinterpret_cast<const char*>(options.demo_file.data()), std::streamsize(options.demo_file.size()));
    if (!changes_user_)
        return;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_))
        if (lchown(entry.path().c_str(), user_.id, user_.group) != 0)
            throw Failure(fmt::format("cannot hand {} to user {}", entry.path().string(), user_.id));
}

int EngineRun::start(const EngineRunOptions& options) const
{
    std::vector<std::string> words { "./quake2", "-datadir", data_.string(), "+set", "vid_renderer", "record", "+set",
        "logfile", "2" };
    if (!options.game.empty())
        words.insert(words.end(), { "+set", "game", options.game });
    words.insert(words.end(), { "+demomap", options.demo });
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);

    const pid_t process = fork();
    if (process < 0)
        throw Failure(fmt::format("cannot start the engine: {}", std::strerror(errno)));
    if (process != 0)
        return process;
    const int input = open("/dev/null", O_RDONLY);
    const int output = open((home_ / "output.txt").c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
    dup2(input, STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    for (const char* name : { "XDG_DATA_HOME", "XDG_CONFIG_HOME", "XDG_CACHE_HOME", "DISPLAY", "WAYLAND_DISPLAY" })
        unsetenv(name);
    setenv("HOME", home_.c_str(), 1);
    setenv("SDL_VIDEODRIVER", "dummy", 1);
    setenv("SDL_VIDEO_DRIVER", "dummy", 1); // SDL3's name for it
    setenv("SDL_AUDIODRIVER", "dummy", 1);
    setenv("VKPT_TRACE", trace_.c_str(), 1);
    setenv("VKPT_SOUND", sound_.c_str(), 1);
    const std::string clock = folder_ / clock_library, sound = folder_ / sound_library;
    const std::string libraries = options.with_sound ? fmt::format("{}:{}", clock, sound) : clock;
    setenv("LD_PRELOAD", libraries.c_str(), 1);
    if ((changes_user_ && !become(user_.id, user_.group)) || chdir(folder_.c_str()) != 0)
        _exit(127);
    prctl(PR_SET_PDEATHSIG, SIGKILL); // after the change of the user, which resets it
    execv(arguments[0], arguments.data());
    _exit(127);
}

void EngineRun::watch(int process, const EngineRunOptions& options) const
{
    const fs::path console = home_ / ".yq2" / (options.game.empty() ? "baseq2" : options.game) / "qconsole.log";
    auto last_change = std::chrono::steady_clock::now();
    uintmax_t last_size = 0;
    int status = 0;
    while (waitpid(process, &status, WNOHANG) == 0) {
        std::this_thread::sleep_for(poll_interval);
        std::error_code ignored;
        const uintmax_t size = fs::exists(trace_, ignored) ? fs::file_size(trace_, ignored) : 0;
        const auto now = std::chrono::steady_clock::now();
        if (size != last_size) {
            last_size = size;
            last_change = now;
            options.on_progress(trace_);
        }
        const std::string error = find_error(read_text(console));
        if (!error.empty() || now - last_change > patience) {
            end_process(process);
            fail(error.empty() ? "nothing was recorded for a minute" : error);
        }
    }
    if (const std::string error = find_error(read_text(console)); !error.empty())
        fail(error);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        fail(WIFEXITED(status) ? fmt::format("exit status {}", WEXITSTATUS(status))
                               : fmt::format("ended by signal {}", WTERMSIG(status)));
}

void EngineRun::fail(const std::string& reason) const
{
    throw Failure(fmt::format("{} did not play the demo to its end: {}\nThe last lines of its output:\n{}",
        engine_.string(), reason, last_lines(read_text(home_ / "output.txt"), 8)));
}

} // namespace vkpt::client

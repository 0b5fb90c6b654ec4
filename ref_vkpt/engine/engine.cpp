// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/engine/engine.hpp"

#include "ref_vkpt/engine/exports.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <map>
#include <strings.h>

namespace vkpt::engine {

namespace {

Imports imports;

// The engine takes a va_list only.
void forward_print(int level, const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    imports.print(level, format, arguments);
    va_end(arguments);
}

void print_line(int level, std::string_view line)
{
    if (imports.print)
        forward_print(level, "%.*s\n", int(line.size()), line.data());
}

// On the stack as a plain array: the engine does not return, so a std::string would leak.
[[noreturn]] void raise(int level, std::string_view text)
{
    char buffer[1024];
    std::snprintf(buffer, sizeof buffer, "%.*s", int(text.size()), text.data());
    imports.error(level, "%s", buffer);
    // The engine's function never returns; if it does, there is nothing sane left to do.
    std::fprintf(stderr, "%s\n", buffer);
    std::abort();
}

// Command names do not mind case, as in the engine.
struct NameLess {
    bool operator()(const std::string& a, const std::string& b) const { return strcasecmp(a.c_str(), b.c_str()) < 0; }
};
std::map<std::string, void (*)(), NameLess> commands;

// The engine's callbacks carry no context, but the command's own name is its argument 0.
void dispatch_command()
{
    void (*function)() = nullptr;
    {
        const auto found = commands.find(std::string(argument(0)));
        if (found != commands.end())
            function = found->second;
    }
    if (function)
        run_command(function);
}

} // namespace

void attach(const Imports& engine_imports) { imports = engine_imports; }

void print(std::string_view line) { print_line(PRINT_ALL, line); }
void print_developer(std::string_view line) { print_line(PRINT_DEVELOPER, line); }

void drop_level(std::string_view text) { raise(ERR_DROP, text); }
void stop_engine(std::string_view text) { raise(ERR_FATAL, text); }

void add_command(const char* name, void (*function)())
{
    commands[name] = function;
    imports.add_command(name, dispatch_command);
}

void remove_command(const char* name)
{
    commands.erase(name);
    imports.remove_command(name);
}

int argument_count() { return imports.argument_count(); }

std::string_view argument(int index)
{
    const char* text = index >= 0 && index < argument_count() ? imports.argument(index) : nullptr;
    return text ? text : "";
}

void run_later(const std::string& text) { imports.execute_text(EXEC_APPEND, text.c_str()); }
void run_next(const std::string& text) { imports.execute_text(EXEC_INSERT, text.c_str()); }

FileData::~FileData()
{
    if (buffer_)
        imports.free_file(buffer_);
}

// As much as the pixels of the largest image, 8192 x 8192; the engine takes whatever memory an archive's directory
// asks for.
constexpr int max_file_bytes = 256 << 20;

std::optional<FileData> load_file(const std::string& path)
{
    if (const int told = imports.load_file(path.c_str(), nullptr); told > max_file_bytes) {
        print("vkpt: {} is not read: it has {} bytes, the limit is {}", path, told, max_file_bytes);
        return std::nullopt;
    }
    void* buffer = nullptr;
    const int size = imports.load_file(path.c_str(), &buffer);
    if (size < 0)
        return std::nullopt;
    return FileData(buffer, buffer ? size_t(size) : 0);
}

bool file_exists(const std::string& path) { return imports.load_file(path.c_str(), nullptr) >= 0; }

std::string game_directory()
{
    const char* directory = imports.game_directory();
    return directory ? directory : ".";
}

Cvar* get_cvar(const char* name, const char* default_text, int flags)
{
    return imports.get_cvar(name, default_text, flags);
}

void set_cvar(const char* name, const std::string& text) { imports.set_cvar(name, text.c_str()); }
void set_cvar(const char* name, float number) { imports.set_cvar_number(name, number); }

std::optional<VideoSize> mode_size(int mode)
{
    VideoSize size;
    if (mode < 0 || !is_true(imports.mode_info(&size.width, &size.height, mode)))
        return std::nullopt;
    return size;
}

std::optional<VideoSize> desktop_size()
{
    VideoSize size;
    if (!is_true(imports.desktop_mode(&size.width, &size.height)))
        return std::nullopt;
    return size;
}

std::optional<VideoSize> init_graphics(int fullscreen, VideoSize wanted)
{
    if (!is_true(imports.init_graphics(fullscreen, &wanted.width, &wanted.height)))
        return std::nullopt;
    return wanted;
}

void init_video_menu() { imports.init_video_menu(); }
void request_restart(Restart kind) { imports.request_restart(int(kind)); }

void write_screenshot(VideoSize size, int bytes_per_pixel, const void* pixels)
{
    imports.write_screenshot(size.width, size.height, bytes_per_pixel, pixels);
}

void* symbol(const char* name) { return dlsym(RTLD_DEFAULT, name); }

int sdl_major()
{
    // Some systems have both: SDL2's own interface may itself stand on SDL3. A name that only SDL2 has tells them
    // apart.
    void* sdl3 = dlopen("libSDL3.so.0", RTLD_LAZY | RTLD_NOLOAD);
    if (!sdl3)
        return 2;
    dlclose(sdl3);
    return symbol("SDL_GetWindowDisplayIndex") ? 2 : 3;
}

} // namespace vkpt::engine

// SPDX-License-Identifier: GPL-2.0-or-later
// The engine as the rest of the module sees it: a thin layer over Imports. On the engine's thread only, between
// GetRefAPI and the return of Shutdown.
#pragma once

#include "formats/byte_reader.hpp"
#include "ref_vkpt/engine/contract.hpp"
#include "ref_vkpt/engine/errors.hpp"

#include <fmt/format.h>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace vkpt::engine {

// Keeps the engine's functions; GetRefAPI calls it before anything else runs.
void attach(const Imports& imports);

// ---- console

// One line to the console; the newline is added.
void print(std::string_view line);
// The same, shown only with `developer 1`.
void print_developer(std::string_view line);

template <class... Arguments>
void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) requires(sizeof...(Arguments) > 0)
{
    print(std::string_view(fmt::format(format, std::forward<Arguments>(arguments)...)));
}

template <class... Arguments>
void print_developer(fmt::format_string<Arguments...> format, Arguments&&... arguments) requires(
    sizeof...(Arguments) > 0)
{
    print_developer(std::string_view(fmt::format(format, std::forward<Arguments>(arguments)...)));
}

// ---- errors
//
// The engine leaves both by longjmp or exit: destructors of the C++ frames in between do not run. So only
// engine/exports.cpp calls these, where nothing with a destructor is alive. Everybody else throws (errors.hpp).

[[noreturn]] void drop_level(std::string_view text);
[[noreturn]] void stop_engine(std::string_view text);

// ---- commands

// `name` must live as long as the command. The function may throw like any renderer code.
void add_command(const char* name, void (*function)());
void remove_command(const char* name);
// Arguments of the command that runs; 0 is its name. Out of range: "".
int argument_count();
std::string_view argument(int index);
// Appends console text; it runs in the next engine frame.
void run_later(const std::string& text);
// The same, before what waits there.
void run_next(const std::string& text);

// ---- files

// A file's bytes in the engine's memory, given back to it at the end of life.
class FileData {
public:
    FileData(void* buffer, size_t size)
        : buffer_(buffer)
        , size_(size)
    {
    }
    FileData(FileData&& other) noexcept
        : buffer_(std::exchange(other.buffer_, nullptr))
        , size_(std::exchange(other.size_, 0))
    {
    }
    FileData& operator=(FileData&& other) noexcept
    {
        std::swap(buffer_, other.buffer_);
        std::swap(size_, other.size_);
        return *this;
    }
    ~FileData();

    formats::Bytes bytes() const { return { static_cast<const std::byte*>(buffer_), size_ }; }
    size_t size() const { return size_; }

private:
    void* buffer_;
    size_t size_;
};

// Paths are the game's own ("maps/base1.bsp"), searched in archives and folders in the engine's order. Nothing: no such
// file.
std::optional<FileData> load_file(const std::string& path);
bool file_exists(const std::string& path);
// The folder that generated files belong in.
std::string game_directory();

// ---- cvars (cvars.hpp has the module's own, typed)

// Never nullptr unless the engine refuses the name or text.
Cvar* get_cvar(const char* name, const char* default_text, int flags);
void set_cvar(const char* name, const std::string& text);
void set_cvar(const char* name, float number);

// ---- video

struct VideoSize {
    int width = 0, height = 0;
};

// r_mode's table; nothing for -1 (custom), -2 (desktop) and unknown numbers.
std::optional<VideoSize> mode_size(int mode);
std::optional<VideoSize> desktop_size();
// Has the engine (re)create its window, in which it calls PrepareForWindow and InitContext. The size it gave, or
// nothing.
std::optional<VideoSize> init_graphics(int fullscreen, VideoSize wanted);
void init_video_menu();
void request_restart(Restart kind);
// Top row first, 3 or 4 bytes a pixel; the engine chooses name and format.
void write_screenshot(VideoSize size, int bytes_per_pixel, const void* pixels);

// ---- process

// A symbol of whatever the engine has loaded (SDL), nullptr: none.
void* symbol(const char* name);
// Which SDL the engine brought: 2 or 3.
int sdl_major();

} // namespace vkpt::engine
